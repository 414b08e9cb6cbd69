#include "patient_site/devices/card_thread.h"

#include <algorithm>
#include <utility>

namespace palp::patient {
namespace {

constexpr Duration kCardPeriod = std::chrono::milliseconds{1};
constexpr Duration kNoCardSpin{0};

ScanCard::Ports borrowed(const CardThread::Ports& owned) {
  ScanCard::Ports ports(owned.size());
  std::ranges::transform(owned, ports.begin(), [](const auto& port) { return port.get(); });
  return ports;
}

}  // namespace

CardThread::CardThread(const CardInstallation& installation, Ports ports, int priority)
    : ports_{std::move(ports)},
      card_{installation, borrowed(ports_)},
      thread_{
          "palp-device",
          {.period = kCardPeriod, .spin = kNoCardSpin, .priority = priority, .lock_memory = false},
          [this](TimePoint) { cycle(); }} {}

CardThread::~CardThread() {
  thread_.stop();
  card_.stop();
}

void CardThread::cycle() {
  const CardReading reading = card_.cycle(clock_, requests_.newest());
  to_rt_.put(reading);
  to_main_.put(reading);
}

std::optional<ForceSample> CardForce::sample(TimePoint now) noexcept {
  const CardReading& card = card_.reading();
  if (card.state != CardState::Ready || card.number == number_) return std::nullopt;
  number_ = card.number;
  return ForceSample{.sampled_at = std::min(now, card.sampled_at),
                     .force = card.force,
                     .saturated = card.saturated};
}

}  // namespace palp::patient
