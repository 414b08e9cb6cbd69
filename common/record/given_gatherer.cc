#include "common/record/given_gatherer.h"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <variant>

namespace palp::record {
namespace {

/// nullopt: of no tick, and in nobody's way.
std::optional<TimePoint> tick_of(const Record& record) {
  return std::visit(
      [](const auto& one) -> std::optional<TimePoint> {
        using One = std::remove_cvref_t<decltype(one)>;
        if constexpr (std::is_same_v<One, DepthEstimate> || std::is_same_v<One, MapEstimate> ||
                      std::is_same_v<One, MapCell>) {
          return std::nullopt;
        } else {
          return one.at;
        }
      },
      record);
}

constexpr int kSampleRank = 1;
constexpr std::size_t kSamplesMax = 2;  ///< of a message

/// Place in the order in which a site tells of a tick; 0: it is in no tick's message. Only samples
/// may be several.
int rank_of(const Record& record) noexcept {
  if (std::holds_alternative<Arrived>(record)) return kSampleRank;
  if (std::holds_alternative<SiteTick>(record)) return 2;
  if (std::holds_alternative<HandReading>(record)) return 3;
  if (std::holds_alternative<StageReading>(record)) return 3;
  if (std::holds_alternative<ForceReading>(record)) return 4;
  return std::holds_alternative<LinkHeard>(record) ? 5 : 0;
}

}  // namespace

bool GivenGatherer::readings() const noexcept {
  if (part<SiteTick>() == nullptr) return false;
  if (site_ == link::Role::Surgeon) return part<HandReading>() != nullptr;
  return part<StageReading>() != nullptr && part<ForceReading>() != nullptr;
}

bool GivenGatherer::stands_in_the_way_of(const Record& record) const {
  const auto at = tick_of(record);
  if (size_ == 0 || !at) return false;
  if (*at != *tick_of(held_.front())) return true;
  const int rank = rank_of(record);
  const int before = rank_of(held_[size_ - 1]);
  return (rank > 0 && (rank < before || (rank == before && rank != kSampleRank))) ||
         (std::holds_alternative<LinkHeard>(record) && !readings());
}

std::size_t GivenGatherer::samples() const noexcept {
  const auto parts = held();
  return static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), [](const Record& one) {
    return std::holds_alternative<Arrived>(one);
  }));
}

std::optional<Record> GivenGatherer::crowded_out_by(const Record& record) noexcept {
  if (!std::holds_alternative<Arrived>(record) || samples() < kSamplesMax) return std::nullopt;
  const Record first = held_[0];  // nothing else comes before samples
  std::copy(held_.begin() + 1, held_.begin() + static_cast<std::ptrdiff_t>(size_), held_.begin());
  --size_;
  return first;
}

bool GivenGatherer::take(const Record& record) noexcept {
  const bool surgeon = site_ == link::Role::Surgeon;
  const bool reading = surgeon ? std::holds_alternative<HandReading>(record)
                               : std::holds_alternative<StageReading>(record) ||
                                     std::holds_alternative<ForceReading>(record);
  const bool heard = std::holds_alternative<LinkHeard>(record) && readings();
  const bool other =
      std::holds_alternative<SiteTick>(record) || std::holds_alternative<Arrived>(record);
  if (!reading && !heard && !other) return false;
  held_[size_++] = record;
  return true;
}

template <class FileTick>
void GivenGatherer::add_rest(FileTick& made) const noexcept {
  made.tick = *part<SiteTick>();
  made.at = made.tick.at;
  made.gathered = true;
  made.given.heard = *part<LinkHeard>();
  made.given.at = made.at;
  for (const Record& record : held()) {
    const auto* sample = std::get_if<Arrived>(&record);
    if (sample == nullptr) continue;
    made.given.earlier = made.given.arrived;
    made.given.arrived = *sample;
    ++made.given.samples;
  }
}

SurgeonFileTick GivenGatherer::surgeon() const noexcept {
  SurgeonFileTick made;
  made.given.hand = *part<HandReading>();
  add_rest(made);
  return made;
}

PatientFileTick GivenGatherer::patient() const noexcept {
  PatientFileTick made;
  made.given.stage = *part<StageReading>();
  made.given.force = *part<ForceReading>();
  add_rest(made);
  return made;
}

}  // namespace palp::record
