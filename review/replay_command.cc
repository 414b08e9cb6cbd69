#include "review/replay_command.h"

#include <algorithm>

#include "common/config/document.h"
#include "common/config/number.h"
#include "common/core/number_text.h"
#include "common/core/place_text.h"
#include "common/core/printable.h"
#include "common/message/map_text.h"
#include "common/record/session_reader.h"
#include "judge/depth_statement.h"
#include "patient_site/settings.h"
#include "patient_site/tissue_record.h"
#include "review/site_data.h"
#include "review/text.h"
#include "surgeon_site/settings.h"

namespace palp::review {
namespace {

constexpr double kSensorStaleMax = 60;  ///< [s], a file may say anything

/// What a run's files say of themselves.
struct RunFacts {
  link::Role site{};
  std::string settings;  ///< of the first file
  std::string coupling;
  std::optional<double> travel_max;      ///< [m]
  std::optional<Duration> sensor_stale;  ///< nothing: as the settings have it
};

/// Of one file, without reading it to its end.
struct FileFacts {
  std::string site;
  std::string number;
  std::string run;
  std::string settings;
  std::string travel_max;
  std::string sensor_stale;
  std::string coupling;
};

Result<FileFacts> facts_of_file(const record::FileBytes& file) {
  record::SessionReader reader{file};
  (void)reader.next();
  const auto entry = [&](const char* key) { return reader.metadata("palp", key).value_or(""); };
  FileFacts facts{.site = entry("site"),
                  .number = entry("file_number"),
                  .run = entry("run_began_utc"),
                  .settings = text_of(reader, "config.textproto").value_or(""),
                  .travel_max = entry(patient::kTravelMaxKey),
                  .sensor_stale = entry(patient::kSensorStaleKey),
                  .coupling = entry("coupling")};
  if (facts.site != "surgeon" && facts.site != "patient") {
    return fail("the file is no site's session file");
  }
  return facts;
}

/// They must follow each other.
Result<RunFacts> facts_of_run(const RunBytes& files) {
  RunFacts run;
  std::string began;
  for (std::size_t i = 0; i < files.size(); ++i) {
    auto facts = facts_of_file(files[i]);
    if (!facts) return tl::unexpected(facts.error());
    const std::string wanted = std::to_string(i + 1);
    if (!facts->number.empty() && facts->number != wanted) {
      return fail("the file is number " + printable(facts->number) + " of its run where number " +
                  wanted + " is due: a run is done again from its first file on, all in order");
    }
    if (i > 0 && facts->run != began) return fail("the files are of different runs of the site");
    if (i > 0) continue;
    began = facts->run;
    run.site = facts->site == "surgeon" ? link::Role::Surgeon : link::Role::Patient;
    run.settings = facts->settings;
    run.coupling = facts->coupling;
    run.travel_max = config::parse_number(facts->travel_max);
    if (const auto stale = config::parse_number(facts->sensor_stale)) {
      run.sensor_stale = from_seconds(std::clamp(*stale * 1e-9, 0.0, kSensorStaleMax));
    }
  }
  if (run.settings.empty()) return fail("the file holds no settings (config.textproto)");
  return run;
}

Result<void> apply(config::Document& document, const RunFacts& run, const ReplayAsk& ask) {
  if (auto merged = document.merge(run.settings, "config.textproto"); !merged) return merged;
  if (!ask.coupling.empty()) {
    if (auto set = document.set("coupling.name", ask.coupling, "--coupling"); !set) return set;
  }
  if (!ask.estimator.empty()) {
    if (auto set = document.set("estimator.kind", ask.estimator, "--estimator"); !set) return set;
  }
  for (const std::string& one : ask.set) {
    if (auto set = document.set(one); !set) return set;
  }
  return {};
}

std::string said_of(const std::optional<DepthEstimate>& estimate) {
  if (!estimate) return "nothing";
  const judge::DepthStatement statement = judge::statement_of(*estimate);
  return statement.says;
}

std::string lack_line(const std::string& lack) { return lack.empty() ? "" : "; the file " + lack; }

std::string describe(const WhatIf& result, const ReplayAsk& ask) {
  std::string text = std::to_string(result.ticks) +
                     " ticks given to other parts; hand, stage and " +
                     "tissue did what the file says, so this is what would have been said, not " +
                     "what would have happened" + lack_line(result.lack) + '\n';
  if (!ask.set.empty()) {
    text += "target of the stage: " + number_text("", result.target_rms * 1e3, 3, " mm rms, ") +
            number_text("", result.target_max * 1e3, 3, " mm at most") +
            " from the session's, while both were engaged (" + std::to_string(result.engaged) +
            " ticks)\n" + "motion gate: acted in " + std::to_string(result.gate_acted) +
            " ticks, would have in " + std::to_string(result.gate_would) + '\n' +
            "state: another one in " + std::to_string(result.other_state) + " ticks\n";
  }
  for (const OtherEstimate& one : result.estimates) {
    const DepthEstimate& stroke = one.logged ? *one.logged : *one.other;
    text += "stroke " + std::to_string(stroke.number) + " at " + place_text(stroke.place) +
            ": the session " + said_of(one.logged) + "; now " + said_of(one.other) + '\n';
  }
  if (result.map_logged) {
    text += "all places together, the session: " + map_sentence(*result.map_logged) + '\n' +
            "all places together, now: " +
            (result.map_other ? map_sentence(*result.map_other) : "nothing") + '\n';
  }
  return text;
}

ReplayAnswer answer_of(const ReplayReport& report) {
  ReplayAnswer answer;
  answer.same = report.difference.empty();
  answer.text = answer.same
                    ? std::to_string(report.ticks) + " ticks, " + std::to_string(report.records) +
                          " records and " + std::to_string(report.estimates) +
                          " estimates done again: every bit is the same" + lack_line(report.lack) +
                          '\n'
                    : "first difference: " + report.difference + '\n';
  return answer;
}

Result<ReplayAnswer> surgeon_again(const RunBytes& files,
                                   const RunFacts& run,
                                   const ReplayAsk& ask) {
  if (ask.another()) {
    return fail("what other parts would have said is asked of the patient's file");
  }
  config::Document document = config::surgeon_document();
  if (auto applied = apply(document, run, ask); !applied) return tl::unexpected(applied.error());
  const auto settings = surgeon::make_settings(document);
  if (!settings) return tl::unexpected(settings.error());
  const auto report = replay_surgeon(files, settings->node, settings->coupling);
  if (!report) return tl::unexpected(report.error());
  return answer_of(*report);
}

Result<ReplayAnswer> patient_again(const RunBytes& files,
                                   const RunFacts& run,
                                   const ReplayAsk& ask) {
  config::Document document = config::patient_document();
  if (auto applied = apply(document, run, ask); !applied) return tl::unexpected(applied.error());
  if (auto checked = document.check(); !checked) return tl::unexpected(checked.error());
  const auto settings = patient::make_settings(document);
  if (!settings) return tl::unexpected(settings.error());
  if (settings->coupling.name != run.coupling) {
    // Its halves speak to each other in words of their own, through the hand and the tissue.
    return fail("the session's telegrams are of " + printable(run.coupling) +
                ", which no half of " + settings->coupling.name +
                " understands; the lab plays the recorded hand under it: " +
                "palp-review scenario SURGEON PATIENT --out again.textproto && " +
                "palp-lab run again.textproto --coupling " + settings->coupling.name);
  }
  PatientParts parts{settings->node, settings->coupling, settings->estimator};
  if (run.travel_max) parts.config.gate.travel_max = *run.travel_max;
  if (run.sensor_stale) parts.config.sensor_stale = *run.sensor_stale;
  if (ask.another()) {
    const auto result = what_if_patient(files, parts);
    if (!result) return tl::unexpected(result.error());
    return ReplayAnswer{.same = true, .text = describe(*result, ask)};
  }
  const auto report = replay_patient(files, parts);
  if (!report) return tl::unexpected(report.error());
  return answer_of(*report);
}

}  // namespace

Result<ReplayAnswer> replay_command(const RunBytes& files, const ReplayAsk& ask) {
  const auto run = facts_of_run(files);
  if (!run) return tl::unexpected(run.error());
  return run->site == link::Role::Surgeon ? surgeon_again(files, *run, ask)
                                          : patient_again(files, *run, ask);
}

}  // namespace palp::review
