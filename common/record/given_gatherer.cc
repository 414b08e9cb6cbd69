#include "common/record/given_gatherer.h"

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
        constexpr bool kOfTick =
            !std::is_same_v<One, ContactSample> && !std::is_same_v<One, DepthEstimate>;
        if constexpr (kOfTick) {
          return one.at;
        } else {
          return std::nullopt;
        }
      },
      record);
}

/// Place in the order in which a site tells what a tick was given; 0: nothing of it.
int rank_of(const Record& record) noexcept {
  if (std::holds_alternative<Arrived>(record)) return 1;
  if (std::holds_alternative<HandReading>(record)) return 2;
  if (std::holds_alternative<StageReading>(record)) return 2;
  if (std::holds_alternative<ForceReading>(record)) return 3;
  return std::holds_alternative<LinkHeard>(record) ? 4 : 0;
}

}  // namespace

bool GivenGatherer::readings() const noexcept {
  if (site_ == link::Role::Surgeon) return part<HandReading>() != nullptr;
  return part<StageReading>() != nullptr && part<ForceReading>() != nullptr;
}

bool GivenGatherer::stands_in_the_way_of(const Record& record) const {
  const auto at = tick_of(record);
  if (size_ == 0 || !at) return false;
  if (*at != *tick_of(held_.front())) return true;
  const int rank = rank_of(record);
  return (rank > 0 && rank <= rank_of(held_[size_ - 1])) ||
         (std::holds_alternative<LinkHeard>(record) && !readings());
}

bool GivenGatherer::take(const Record& record) noexcept {
  const bool surgeon = site_ == link::Role::Surgeon;
  const bool reading = surgeon ? std::holds_alternative<HandReading>(record)
                               : std::holds_alternative<StageReading>(record) ||
                                     std::holds_alternative<ForceReading>(record);
  const bool heard = std::holds_alternative<LinkHeard>(record) && readings();
  if (!reading && !heard && !std::holds_alternative<Arrived>(record)) return false;
  held_[size_++] = record;
  return true;
}

template <class Given>
void GivenGatherer::add_rest(Given& given) const noexcept {
  given.heard = *part<LinkHeard>();
  given.at = given.heard.at;
  if (const auto* sample = part<Arrived>()) {
    given.sampled = true;
    given.arrived = *sample;
  }
}

SurgeonGiven GivenGatherer::surgeon() const noexcept {
  SurgeonGiven given;
  given.hand = *part<HandReading>();
  add_rest(given);
  return given;
}

PatientGiven GivenGatherer::patient() const noexcept {
  PatientGiven given;
  given.stage = *part<StageReading>();
  given.force = *part<ForceReading>();
  add_rest(given);
  return given;
}

}  // namespace palp::record
