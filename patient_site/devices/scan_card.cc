#include "patient_site/devices/scan_card.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace palp::patient {
namespace {

using io::PortFault;

constexpr std::uint16_t kCardVendor = 0x09DB;
constexpr Duration kCardReopenPause = std::chrono::milliseconds{500};
constexpr Duration kMemoryPatience = std::chrono::milliseconds{200};
constexpr Duration kMemoryWait = std::chrono::milliseconds{20};
constexpr std::size_t kPacketBytes = 64;
constexpr int kPacketsMax = 64;     // of one interface and cycle: the kernel keeps no more
constexpr double kNearFull = 0.99;  // [-], of the scale
constexpr Duration kPacketHalf = std::chrono::microseconds{500};
constexpr std::size_t kOutOfOrderMax = 3;  // in a row, and the count begins with the next
constexpr std::uint8_t kStopScan = 0x12;

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8U));
}

double float_at(std::span<const std::uint8_t> bytes) noexcept {
  const std::uint32_t bits = word_at(bytes, 0) | (std::uint32_t{word_at(bytes, 2)} << 16U);
  return static_cast<double>(std::bit_cast<float>(bits));
}

}  // namespace

std::string_view to_string(CardState state) noexcept {
  switch (state) {
    case CardState::Absent:
      return "absent";
    case CardState::Starting:
      return "starting";
    case CardState::Ready:
      return "ready";
    case CardState::Fault:
      return "fault";
  }
  return "?";
}

io::HidAddress ScanCard::address(const CardModel& model, int interface_number) {
  return {.vendor = kCardVendor,
          .product = model.product,
          .interface_number = interface_number,
          .usage_page = 0,
          .serial = {}};
}

CardReading ScanCard::cycle(const Clock& clock, const DeviceAsks& asks) {
  const TimePoint began = clock.now();
  const DeviceAsks before = std::exchange(asks_, asks);
  load_.heed({.asked = before.tares != asks.tares,
              .ready = now_.state == CardState::Ready,
              .may_touch = asks.may_touch});
  now_.tare = load_.news();
  if (before.restarts != asks.restarts && now_.state == CardState::Fault) {
    held_ = {};
    load_.resume();
    now_.state = CardState::Starting;
    now_.why = {};
    same_ = 0;
  }
  if (now_.state == CardState::Absent) reach(clock);
  if (now_.state == CardState::Absent) return now_;
  sum_ = 0;
  count_ = 0;
  full_ = false;
  if (!drain()) {
    vanish(io::to_string(PortFault::Lost), began);
    return now_;
  }
  const TimePoint now = clock.now();
  if (count_ > 0) {
    heard_at_ = now;
    finish(now);
  } else if (now - heard_at_ > installation_.silence) {
    vanish("it fell silent", now);
  }
  return now_;
}

void ScanCard::stop() {
  if (now_.state == CardState::Absent) return;
  (void)ports_[0]->write(std::array<std::uint8_t, 1>{kStopScan});
}

void ScanCard::reach(const Clock& clock) {
  if (tried_ && clock.now() < reopen_at_) return;
  tried_ = true;
  reopen_at_ = clock.now() + kCardReopenPause;
  PortFault fault{};
  for (io::ReportPort* const port : ports_) {
    if (fault == PortFault::None) fault = port->open();
  }
  if (fault != PortFault::None) {
    now_.why = io::to_string(fault);
  } else if (!read_calibration(clock)) {
    now_.why = "its calibration cannot be read";
  } else if (!start_scan()) {
    now_.why = "it does not begin to sample";
  } else {
    now_.state = CardState::Starting;
    now_.why = {};
    index_known_ = false;
    out_of_order_ = 0;
    same_ = 0;
    load_.resume();
    heard_at_ = clock.now() + kMemoryPatience;
    if (!held_.empty()) fail(held_);  // no cable frees it of its fault
    return;
  }
  close_all();
}

bool ScanCard::start_scan() {
  return std::ranges::all_of(
      scan_requests(model_, installation_.channel, installation_.range),
      [this](const auto& one) { return ports_[0]->write(one) == PortFault::None; });
}

bool ScanCard::read_calibration(const Clock& clock) {
  // A scan that a dead host left running would mix into the answers.
  (void)ports_[0]->write(std::array<std::uint8_t, 1>{kStopScan});
  if (!model_.own_calibration) return true;
  const CardRange& range = card_ranges().at(installation_.range);
  const std::uint16_t channel = installation_.channel;
  std::array<std::uint8_t, 4> ground{};
  std::array<std::uint8_t, 4> plus{};
  std::array<std::uint8_t, 4> minus{};
  std::array<std::uint8_t, 4> pair{};
  std::array<std::uint8_t, 2> minus_raw{};
  const auto at = [&](unsigned base, unsigned size) {
    return static_cast<std::uint16_t>(base + size * channel);
  };
  if (!read_memory(clock, kGroundReferenceAt, ground) || !read_memory(clock, range.plus_at, plus) ||
      !read_memory(clock, range.minus_at, minus) ||
      !read_memory(clock, at(range.pairs_at, 4), pair) ||
      !read_memory(clock, at(range.minus_raw_at, 2), minus_raw)) {
    return false;
  }
  CardReferences references{.ground_x = static_cast<double>(word_at(pair, 0)),
                            .ground_y = target_of(float_at(ground), range),
                            .plus_x = static_cast<double>(word_at(pair, 2)),
                            .plus_y = target_of(float_at(plus), range),
                            .minus_x = {},
                            .minus_y = target_of(float_at(minus), range)};
  // A memory of version 1.0 has no negative values: it is blank there.
  const std::uint16_t raw = word_at(minus_raw, 0);
  if (raw != 0 && raw != 0xFFFF && float_at(minus) < 0) references.minus_x = raw;
  const auto line = line_through(references);
  if (line) line_ = *line;
  return line && line->slope > 0.5 && line->slope < 2;
}

bool ScanCard::read_memory(const Clock& clock,
                           std::uint16_t address,
                           std::span<std::uint8_t> bytes) {
  const auto count = static_cast<std::uint8_t>(bytes.size());
  const std::array<std::uint8_t, 5> request{0x30,
                                            static_cast<std::uint8_t>(address & 0xFFU),
                                            static_cast<std::uint8_t>(address >> 8U),
                                            0,
                                            count};
  if (ports_[0]->write(request) != PortFault::None) return false;
  const TimePoint end = clock.now() + kMemoryPatience;
  std::array<std::uint8_t, kPacketBytes> reply{};
  for (int tries = 0; tries < 10 && clock.now() <= end; ++tries) {
    std::size_t length{};
    if (ports_[0]->read(reply, length, kMemoryWait) != PortFault::None) return false;
    if (length < bytes.size() + 1 || reply[0] != 0x30) continue;
    std::copy_n(reply.begin() + 1, bytes.size(), bytes.begin());
    return true;
  }
  return false;
}

bool ScanCard::drain() {
  packets_.clear();
  std::array<std::uint8_t, kPacketBytes + 1> bytes{};
  for (std::size_t i = 1; i < ports_.size(); ++i) {
    for (int n = 0; n < kPacketsMax; ++n) {
      std::size_t length{};
      if (ports_[i]->read(bytes, length, Duration{0}) != PortFault::None) return false;
      if (length == 0) break;
      if (length != kPacketBytes) {
        ++now_.broken;
        continue;
      }
      Packet packet;
      packet.index = word_at(bytes, kPacketBytes - 2);
      for (std::size_t s = 0; s < packet.samples.size(); ++s) {
        packet.samples[s] = word_at(bytes, 2 * s);
      }
      packets_.push_back(packet);
    }
  }
  if (!index_known_ && !packets_.empty()) {
    index_ = std::ranges::min_element(packets_, {}, &Packet::index)->index;
    index_known_ = true;
  }
  std::ranges::sort(packets_, {}, [this](const Packet& one) {
    return static_cast<std::int16_t>(one.index - index_);  // also over its end at 65535
  });
  for (const Packet& packet : packets_) take(packet);
  return true;
}

void ScanCard::take(const Packet& packet) {
  // Those of a scan that somebody began before, and of whom the kernel kept some: it starts anew.
  if (out_of_order_ >= kOutOfOrderMax) index_ = packet.index;
  const auto ahead = static_cast<std::int16_t>(packet.index - index_);
  if (ahead < -static_cast<int>(model_.interfaces) || (ahead < 0 && now_.lost == 0)) {
    ++now_.broken;
    ++out_of_order_;
    return;
  }
  out_of_order_ = 0;
  if (ahead < 0) {
    --now_.lost;  // late: its interface had been read already when it came
  } else {
    now_.lost += static_cast<std::uint64_t>(ahead);
    index_ = static_cast<std::uint16_t>(packet.index + 1);
  }
  ++now_.packets;
  const double most = kNearFull * model_.full_scales.at(installation_.range);
  for (const std::uint16_t raw : packet.samples) {
    same_ = raw == std::exchange(last_raw_, raw) ? same_ + 1 : 0;
    const double volts = volts_of_sample(model_, installation_.range, line_, raw);
    full_ = full_ || std::abs(volts) >= most || at_end(model_, installation_.range, raw);
    sum_ += volts;
    ++count_;
  }
}

void ScanCard::finish(TimePoint now) {
  ++now_.number;
  now_.sampled_at = now - kPacketHalf;
  now_.volts = sum_ / count_;
  const bool stuck = model_.same_samples > 0 && same_ >= model_.same_samples && !full_;
  const LoadCheck::Verdict verdict =
      load_.take(now_.volts * installation_.newtons_per_volt, now_.sampled_at);
  now_.saturated = full_ || verdict == LoadCheck::Verdict::Saturated;
  now_.zero = load_.zero();
  now_.tare = load_.news();
  now_.force = now_.volts * installation_.newtons_per_volt - load_.zero();
  if (now_.state == CardState::Fault) return;
  if (stuck || verdict == LoadCheck::Verdict::Stuck) return fail("the reading is stuck");
  if (verdict == LoadCheck::Verdict::NotFinite) return fail("a reading is no number");
  if (verdict == LoadCheck::Verdict::Touched) {
    return fail("the tare was refused: something touches the sensor");
  }
  if (verdict == LoadCheck::Verdict::Overloaded) {
    return fail("the reading is at the end of its range");
  }
  if (now_.state == CardState::Starting && load_.tared()) {
    now_.state = CardState::Ready;
    ++now_.starts;
  }
}

void ScanCard::vanish(std::string_view why, TimePoint now) {
  stop();
  close_all();
  now_.state = CardState::Absent;
  now_.why = why;
  reopen_at_ = now + kCardReopenPause;
}

void ScanCard::fail(std::string_view why) {
  now_.state = CardState::Fault;
  now_.why = held_ = why;
}

void ScanCard::close_all() {
  for (io::ReportPort* const port : ports_) port->close();
}

}  // namespace palp::patient
