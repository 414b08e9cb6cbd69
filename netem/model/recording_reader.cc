#include "netem/model/recording_reader.h"

#include <algorithm>

namespace palp::netem {

std::size_t RecordingReader::outcomes(const Recording& recording,
                                      std::uint64_t index,
                                      TimePoint at,
                                      const Arrival& arrival,
                                      std::span<CopyOutcome> into) noexcept {
  const auto& rows = recording.rows;
  if (lost_) {
    // By halves: the number may be a million, and this is no place to count up to it.
    const auto found = std::partition_point(
        rows.begin(), rows.end(), [&](const Recording::Row& row) { return row.index < index; });
    at_ = static_cast<std::size_t>(found - rows.begin());
    lost_ = false;
  }
  while (at_ < rows.size() && rows[at_].index < index) ++at_;
  std::size_t count = 0;
  std::size_t room = arrival.room;
  for (; at_ < rows.size() && rows[at_].index == index && count < into.size(); ++at_, ++count) {
    const Recording::Row& row = rows[at_];
    into[count] = {.verdict = static_cast<Verdict>(row.verdict),
                   .tos = arrival.tos,
                   .flipped_bit = row.flipped_bit,
                   .length = static_cast<std::uint32_t>(arrival.length),
                   .delay = row.delay,
                   .release = at + row.delay};
    if (into[count].verdict != Verdict::Delivered) continue;
    if (room == 0) into[count].verdict = Verdict::OverLimit;
    if (room > 0) --room;
  }
  if (count == 0) {
    into[count++] = {.verdict = room > 0 ? Verdict::Delivered : Verdict::OverLimit,
                     .tos = arrival.tos,
                     .length = static_cast<std::uint32_t>(arrival.length),
                     .release = at};
  }
  return count;
}

}  // namespace palp::netem
