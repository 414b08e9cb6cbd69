#include "study/replay_rows.h"

#include <algorithm>
#include <cmath>

namespace palp::study {
namespace {

constexpr double kBelievedSlack = 1e-6;  // [-], above what a row's digits cut off

}  // namespace

Result<void> replay_rows(Block& block, std::span<const TrialRow> rows, const std::string& code) {
  for (const TrialRow& row : rows) {
    const std::string where = "trial " + std::to_string(row.ask.number + 1);
    if (block.done()) return fail(where + " comes after the last one of the schedule");
    const TrialAsk ask = block.next();
    const bool same =
        row.ask.kind == ask.kind && row.ask.number == ask.number && row.ask.track == ask.track &&
        row.ask.stronger == ask.stronger &&
        std::abs(row.ask.level - ask.level) <= 1e-8 * std::max(1.0, std::abs(ask.level)) &&
        row.condition == code;
    if (!same) {
      return fail(where + " is not the one that the schedule and the answers before it ask for");
    }
    block.told(row.yes());
    const Marginal believed = block.believed(ask.track);
    if (std::abs(row.believed_mean - believed.mean) > kBelievedSlack ||
        std::abs(row.believed_sd - believed.sd) > kBelievedSlack) {
      return fail(where + ": the posterior does not follow from the answers");
    }
  }
  return {};
}

}  // namespace palp::study
