#include "study/replay_rows.h"

#include <algorithm>
#include <cmath>

namespace palp::study {

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
  }
  return {};
}

}  // namespace palp::study
