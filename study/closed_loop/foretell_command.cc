#include "study/closed_loop/foretell_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/conventions.h"
#include "common/core/formatted.h"
#include "common/core/random.h"
#include "common/core/whole_file.h"
#include "study/simulated_observer.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;
using config::Json;

constexpr std::size_t kResamples = 200;
constexpr double kLapseRate = 0.02;  // [-]
constexpr std::uint64_t kBankStream = 0x62616e6b;
constexpr std::uint64_t kPlainStream = 0x706c6e;
constexpr std::size_t kRankedLevels = 8;  // of a ranking of balls
constexpr double kStandard = 1.96;        // [-], standard deviations of a 95 % interval
constexpr double kAllowed = 2.58;         // [-], likewise of 99 %

std::vector<double> bank_levels(const Study& study) {
  if (study.ball && !study.task.ranks) return study.levels;  // each has a tissue of its own
  if (study.ball) return even_levels(study.levels.front(), study.levels.back(), kRankedLevels);
  if (study.task.delays) return {5, 20, 35, 50, 70, 100, 140, 200};
  if (study.task.yes_no) return {0, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2};
  if (study.task.two_sided) {
    return {-1.2, -0.9, -0.6, -0.4, -0.2, 0, 0.2, 0.4, 0.6, 0.9, 1.2};
  }
  return {0.01, 0.1, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2};
}

/// A value with the interval that its resamples show.
Estimate estimate_of(double value, std::vector<double> resamples) {
  std::ranges::sort(resamples);
  const auto at = [&](double share) {
    return resamples[static_cast<std::size_t>(share * static_cast<double>(resamples.size() - 1))];
  };
  return {value, at(0.025), at(0.975)};
}

void foretell_from(const CueBank& bank,
                   const Judgement& judgement,
                   int taps,
                   std::uint64_t seed,
                   ForetoldRow& row) {
  std::array<std::vector<double>, 4> resamples;
  const auto all = [&](const CueBank& one) {
    const Foretold by_bank = banked(one, judgement, taps);
    const FeltLine line = judgement.feedback == Feedback::Depth ? FeltLine{} : line_of(one);
    const Foretold by_form = closed_form(line, one.task, judgement, taps);
    return std::array{by_bank.jnd, by_form.jnd, by_bank.pse, by_form.pse};
  };
  for (std::size_t i = 0; i < kResamples; ++i) {
    const auto values = all(resampled(bank, seed, kBankStream + 1 + i));
    for (std::size_t k = 0; k < values.size(); ++k) resamples[k].push_back(values[k]);
  }
  const auto values = all(bank);
  if (judgement.feedback != Feedback::Depth) row.line = line_of(bank);
  for (const double level : bank.levels) {
    row.banked_shares.push_back({level, banked_share(bank, judgement, taps, level)});
  }
  row.banked_jnd = estimate_of(values[0], resamples[0]);
  row.closed_jnd = estimate_of(values[1], resamples[1]);
  row.banked_pse = estimate_of(values[2], resamples[2]);
  row.closed_pse = estimate_of(values[3], resamples[3]);
}

/// One observer's answers, trial by trial in whole sessions.
std::vector<Answers> feel_track(const Study& study,
                                const AnswerTable& table,
                                const FeltSession& session,
                                const Judgement& judgement,
                                const TrialPlace& place) {
  Method method = study.method;
  method.stop = {.trials_min = study.trials, .trials_max = study.trials};
  if (study.task.yes_no) method.constant_from = 1;
  Track track{table, method, study.seed, trial_stream(place, 0)};
  std::vector<Answers> out;
  for (std::size_t trial = 0; trial < study.trials; ++trial) {
    const std::uint64_t stream = trial_stream(place, trial);
    const std::size_t stronger = random_bits(study.seed, stream, 1) % choices(study.task);
    const bool nothing = study.task.yes_no && stronger == 0;
    const std::size_t level = nothing ? 0 : track.next();
    const TrialAsk ask{.level = table.levels()[level], .stronger = stronger};
    const FeltSetting setting = setting_of(ask,
                                           study.task,
                                           session.taps(),
                                           judgement.depth_sd,
                                           random_bits(study.seed, stream, 0) >> 16);
    const FeltTrial felt = feel_trial(session, setting, study.task);
    const std::size_t answer = chosen(felt.intervals, study.task, judgement, study.seed, stream);
    const bool yes = answer == (study.task.two_sided ? 1 : stronger);
    if (!nothing) track.told(level, yes);
    out.push_back({ask.level, yes ? std::size_t{1} : 0, 1});
  }
  return out;
}

Estimate exponential(const Marginal& ln) {
  return {std::exp(ln.median), std::exp(ln.low), std::exp(ln.high)};
}

/// Share of "yes" at the levels that were asked, by the bank.
double foretold_share(const CueBank& bank,
                      const Judgement& judgement,
                      int taps,
                      const std::vector<Answers>& asked) {
  double sum = 0;
  double count = 0;
  for (const Answers& one : asked) {
    const auto trials = static_cast<double>(one.trials);
    const double share = banked_share(bank, judgement, taps, one.level);
    sum += trials * (kLapseRate * chance(bank.task) + (1 - kLapseRate) * share);
    count += trials;
  }
  return sum / count;
}

void show_whole(const Study& study,
                const CueBank& bank,
                const FeltSession& session,
                const Judgement& judgement,
                const std::vector<std::vector<Answers>>& answers,
                ForetoldRow& row) {
  const AnswerTable table{study.task, {}, {.jnd_max = 4, .jnd_count = 241}, study.levels};
  AnswerPosterior posterior{table};
  std::vector<Answers> asked;
  for (const double level : table.levels()) asked.push_back({.level = level});
  double yes = 0;
  for (const auto& of : answers) {
    for (const Answers& one : of) {
      const std::size_t level = table.nearest(one.level);
      posterior.told(level, one.yes > 0);
      ++asked[level].trials;
      yes += static_cast<double>(one.yes);
      ++row.trials;
    }
  }
  const auto n = static_cast<double>(row.trials);
  row.yes = yes / n;
  row.yes_foretold = foretold_share(bank, judgement, session.judged(), asked);
  // Chance in the answers, and in the sessions from which was foretold.
  double variance = row.yes_foretold * (1 - row.yes_foretold) / n;
  for (std::size_t i = 0; i < kResamples; ++i) {
    const CueBank one = resampled(bank, study.seed, kBankStream + 1 + i);
    const double off = foretold_share(one, judgement, session.judged(), asked) - row.yes_foretold;
    variance += off * off / kResamples;
  }
  row.yes_sd = std::sqrt(variance);
  row.whole_jnd = exponential(posterior.ln_jnd());
  const Marginal pse = posterior.pse();
  row.whole_pse = {pse.median, pse.low, pse.high};
}

/// Two values with intervals agree.
bool agree(const Estimate& a, const Estimate& b) noexcept {
  const double sd = std::hypot(a.high - a.low, b.high - b.low) / (2 * kStandard);
  return std::abs(a.value - b.value) <= kAllowed * sd;
}

Estimate logarithm(const Estimate& of) noexcept {
  return {std::log(of.value), std::log(of.low), std::log(of.high)};
}

std::string shown(const Estimate& of) {
  if (!std::isfinite(of.value)) return "         none        ";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%6.3f %6.3f..%-6.3f", of.value, of.low, of.high);
  return text.data();
}

Json estimate_json(const Estimate& of) {
  return {{"value", of.value}, {"low", of.low}, {"high", of.high}};
}

std::string row_text(const ForetoldRow& row, bool two_sided) {
  std::array<char, 320> line{};
  std::snprintf(line.data(),
                line.size(),
                "%-22s %5.2f %+6.2f  %s %s %s",
                row.condition.c_str(),
                row.line.gain,
                row.line.offset,
                shown(row.closed_jnd).c_str(),
                shown(row.banked_jnd).c_str(),
                row.trials > 0 ? shown(row.whole_jnd).c_str() : "");
  std::string text{line.data()};
  if (row.depth) text += formatted("  %4.1f mm", *row.depth / kMillimetre);
  if (two_sided) {
    text += " |" + shown(row.closed_pse) + shown(row.banked_pse) +
            (row.trials > 0 ? shown(row.whole_pse) : "");
  }
  if (row.trials > 0) {
    std::snprintf(line.data(),
                  line.size(),
                  "  %5.1f %5.1f +-%.1f  %s",
                  100 * row.yes,
                  100 * row.yes_foretold,
                  100 * kStandard * row.yes_sd,
                  row.holds(two_sided) ? "holds" : "MISSED");
    text += line.data();
  }
  return text + "\n";
}

Json row_json(const ForetoldRow& row, const Task& task) {
  const bool two_sided = task.two_sided;
  Json out{{"condition", row.condition},
           {"gain", row.line.gain},
           {"offset", row.line.offset},
           {"scatter", row.line.scatter}};
  const std::string suffix = level_suffix(task);
  out["closed_jnd_" + suffix] = estimate_json(row.closed_jnd);
  out["banked_jnd_" + suffix] = estimate_json(row.banked_jnd);
  out["banked_shares"] = Json::array();
  for (const Answered& one : row.banked_shares) {
    out["banked_shares"].push_back(Json{{"level_" + suffix, one.level}, {"share", one.share}});
  }
  if (row.depth) out["banked_depth_mm"] = *row.depth / kMillimetre;
  if (two_sided) {
    out["closed_pse_ln"] = estimate_json(row.closed_pse);
    out["banked_pse_ln"] = estimate_json(row.banked_pse);
  }
  if (row.trials > 0) {
    out["trials"] = row.trials;
    out["whole_jnd_" + suffix] = estimate_json(row.whole_jnd);
    if (two_sided) out["whole_pse_ln"] = estimate_json(row.whole_pse);
    out["yes_share"] = row.yes;
    out["yes_foretold_share"] = row.yes_foretold;
    out["yes_sd"] = row.yes_sd;
    out["holds"] = row.holds(two_sided);
  }
  return out;
}

}  // namespace

bool ForetoldRow::holds(bool two_sided) const noexcept {
  if (std::abs(yes - yes_foretold) > kAllowed * yes_sd) return false;
  if (told) return true;
  if (std::isfinite(banked_jnd.high)) {
    const Estimate seen = logarithm(whole_jnd);
    if (!agree(seen, logarithm(banked_jnd)) || !agree(seen, logarithm(closed_jnd))) return false;
  }
  const bool foretold = std::isfinite(banked_pse.low) && std::isfinite(banked_pse.high);
  return !two_sided || !foretold || (agree(whole_pse, banked_pse) && agree(whole_pse, closed_pse));
}

Result<ForetoldRow> foretell(const Study& study,
                             std::size_t condition,
                             const ForetellFlags& flags,
                             const ForEachIndex& for_each_index) {
  const auto curves = LevelCurves::make(study);
  if (!curves) return tl::unexpected(curves.error());
  auto session = FeltSession::make(study.conditions[condition], *curves);
  if (!session) return tl::unexpected(session.error());
  Judgement judgement = judgement_for(*session, study.task, flags.weber, kLapseRate);
  judgement.reads_exactly = flags.reads_exactly;
  if (study.task.yes_no) {
    judgement.plain =
        felt_plain(*session, judgement, random_bits(study.seed, kPlainStream, condition));
    judgement.criterion = kCriterion;
  }
  ForetoldRow row{.condition = study.conditions[condition].name,
                  .told = session->feedback() == Feedback::Depth || study.task.delays};
  const CueBank bank = bank_of(*session,
                               judgement,
                               study.task,
                               bank_levels(study),
                               flags.sessions,
                               random_bits(study.seed, kBankStream, condition),
                               for_each_index);
  foretell_from(bank, judgement, session->judged(), study.seed, row);
  row.depth = depth_found(study, row.banked_jnd.value);
  const AnswerTable table = table_of(study);
  std::vector<std::vector<Answers>> answers(flags.observers);
  for_each_index(answers.size(), [&](std::size_t i) {
    answers[i] = feel_track(study, table, *session, judgement, {i, condition});
  });
  if (!answers.empty()) show_whole(study, bank, *session, judgement, answers, row);
  return row;
}

void declare_foretell(config::CommandLine& line, ForetellFlags& flags) {
  line.argument("STUDY", flags.file, "text file: message Study of proto/config.proto");
  line.required();
  line.number("--weber",
              flags.weber,
              {.min = 0.05, .max = 1},
              "Weber fraction of the observer with the own finger");
  line.whole("--sessions",
             flags.sessions,
             {.min = 2, .max = 1000},
             "of each level, from which is foretold");
  line.whole("--observers",
             flags.observers,
             {.min = 0, .max = 1000},
             "who feel each trial of a condition as a session of its own; 0: the forecast alone");
  line.toggle("--reads-exactly",
              flags.reads_exactly,
              "a force that is drawn is judged with the noise of reading it, and of the own place, "
              "alone");
  line.report(flags.report, "palp.study_forecast/1");
  line.footer(
      "JND and PSE of each condition as logarithms with 95 % intervals: from how felt stiffness\n"
      "follows true stiffness (closed form), from some felt sessions (bank), and as observers "
      "show\n"
      "them in whole sessions; with balls, down to which depth one is found. Exit code 1: what "
      "they show is not what was foretold.");
}

ExitStatus run_foretell(const ForetellFlags& flags, const ForEachIndex& for_each_index) {
  const auto file = read_whole_file(flags.file);
  if (!file) return config::refusal("palp-study", file.error());
  const auto study = parse_study(*file, flags.file);
  if (!study) return config::refusal("palp-study", study.error());
  if (study->task.places > 0) {
    return {ExitCode::BadInput,
            "palp-study: " + flags.file +
                ": a search has no forecast: palp-study run --observer felt sends observers"};
  }
  const bool two_sided = study->task.two_sided;
  std::string text =
      "condition               gain offset  JND, closed form     JND, bank            JND, "
      "sessions";
  if (two_sided) text += "        | PSE, closed form   PSE, bank            PSE, sessions";
  if (!study->depths.empty()) text += "        found";
  text += "       yes %  foretold\n";
  Json report{{"schema", "palp.study_forecast/1"},
              {"study", study->name},
              {"task", task_name(*study)},
              {"weber", flags.weber},
              {"sessions", flags.sessions},
              {"observers", flags.observers}};
  report["conditions"] = Json::array();
  bool held = true;
  for (std::size_t i = 0; i < study->conditions.size(); ++i) {
    const auto row = foretell(*study, i, flags, for_each_index);
    if (!row) return config::refusal("palp-study", row.error());
    text += row_text(*row, two_sided);
    report["conditions"].push_back(row_json(*row, study->task));
    held = held && (row->trials == 0 || row->holds(two_sided));
  }
  if (!flags.report.empty()) {
    const auto written = config::write_whole_file(flags.report, report.dump(2) + "\n");
    if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  }
  if (held) return {ExitCode::Done, text};
  (void)std::fputs(text.c_str(), stdout);
  return {ExitCode::Missed, "palp-study: observers do not show what was foretold"};
}

}  // namespace palp::study
