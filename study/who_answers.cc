#include "study/who_answers.h"

#include <algorithm>

#include "common/config/json.h"
#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/printable.h"

namespace palp::study {
namespace {

using config::Json;
using config::number_text;

std::string path_of(const DataSet& data) { return data.code("observer.json"); }

std::string text_of(const WhoAnswers& who) {
  Json out{{"schema", "palp.study_observer/1"}, {"kind", who.kind}};
  if (!who.observer.empty()) {
    out["observer"] = who.observer;
    out["weber"] = who.people.weber;
    out["spread"] = who.people.spread;
    out["lapse"] = who.people.lapse;
  }
  return out.dump(2) + "\n";
}

/// "simulated, felt, weber 0.15, spread 0.25, lapse 0.02".
std::string said(std::string_view text) {
  const Json json = Json::parse(text);
  std::string out{json.at_or_null("kind").text().value_or("nobody who is known")};
  if (const auto observer = json.at_or_null("observer").text())
    out += ", " + std::string{*observer};
  for (const char* trait : {"weber", "spread", "lapse"}) {
    if (const auto value = json.at_or_null(trait).number()) {
      out += std::string{", "} + trait + ' ' + number_text(*value);
    }
  }
  return printable(out);
}

/// Compares, and writes only where this run is `alone`.
Result<void> bind(const PlannedStudy& planned, const WhoAnswers& who, bool alone) {
  const auto rows = read_rows(planned);
  if (!rows) return tl::unexpected(rows.error());
  const std::string wanted = text_of(who);
  const auto refused = [&](const std::string& by) {
    return fail(planned.data.folder + " holds answers by " + by + ", these would be by " +
                said(wanted) + ": plan another folder for them");
  };
  for (const std::string& kind : kinds_of(*rows)) {
    if (kind != who.kind) return refused(kind);
  }
  const auto before = read_if_there(path_of(planned.data));
  if (!before) return tl::unexpected(before.error());
  if (*before && **before == wanted) return {};
  // A folder is there before its first trial is asked: somebody may be at it.
  if (!rows->empty() || !alone) return refused(*before ? said(**before) : "nobody who is known");
  return config::write_whole_file(path_of(planned.data), wanted);
}

}  // namespace

std::vector<std::string> kinds_of(const std::vector<ParticipantRows>& rows) {
  std::vector<std::string> out;
  for (const ParticipantRows& of : rows) {
    for (const TrialRow& row : of.rows) {
      if (std::ranges::find(out, row.kind) == out.end()) out.push_back(row.kind);
    }
  }
  std::ranges::sort(out);
  return out;
}

Result<std::string> bound_kind(const DataSet& data) {
  const auto text = read_if_there(path_of(data));
  if (!text) return tl::unexpected(text.error());
  if (!*text) return std::string{};
  return std::string{Json::parse(**text).at_or_null("kind").text().value_or("nobody")};
}

Result<RunLock> bind_folder(const PlannedStudy& planned, const WhoAnswers& who) {
  auto lock = RunLock::open(planned.data.code("run.lock"));
  if (!lock) return lock;
  if (lock->alone()) {
    if (auto bound = bind(planned, who, true); !bound) return tl::unexpected(bound.error());
  }
  if (auto shared = lock->beside_others(); !shared) return tl::unexpected(shared.error());
  // Somebody else may have bound it between the two locks.
  if (auto bound = bind(planned, who, false); !bound) return tl::unexpected(bound.error());
  return lock;
}

}  // namespace palp::study
