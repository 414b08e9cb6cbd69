// Input: a script for two Links and the network between them, a byte for the deed and bytes for its
// details: spans of time, what happens to the next datagrams, datagrams of a stranger, telegrams of
// a lying peer, sessions that begin and end. The laws are looked at after every tick.
#include <map>
#include <set>

#include "common/core/check.h"
#include "tests/common/link/link_couple.h"
#include "tests/fuzz/fuzz.h"

namespace palp::link {
namespace {

using fuzz::ByteSource;
using std::chrono::milliseconds;

constexpr int kTicksMax = 500;

/// Watches one end: what it hands over and counts.
class Probe {
 public:
  Probe(Side& side, const Lane& in) : side_{side}, in_{in} {}

  void before_tick(TimePoint now) {
    session_id_ = side_.link.health(now).session_id;
    side_.samples.clear();
  }

  void after_tick(TimePoint now) {
    const LinkHealth health = side_.link.health(now);
    counter_laws(health);
    sample_laws(now);
    PALP_CHECK(side_.last.accepted == health.accepted - before_.accepted, "accepted: as counted");
    PALP_CHECK(health.gap >= Duration{0} && health.round_trip >= Duration{0} &&
                   health.round_trip_min >= Duration{0} && health.jitter >= Duration{0},
               "spans are not negative");
    PALP_CHECK(health.session_id != 0 || health.state == LinkState::Down, "no session, no link");
    PALP_CHECK(side_.last.peer_heard || side_.samples.empty(), "samples come from who was heard");
    before_ = health;
  }

 private:
  void counter_laws(const LinkHealth& health) const {
    constexpr std::array kCounters{&LinkHealth::sent,
                                   &LinkHealth::accepted,
                                   &LinkHealth::late,
                                   &LinkHealth::repaired,
                                   &LinkHealth::reordered,
                                   &LinkHealth::stale,
                                   &LinkHealth::old_epoch,
                                   &LinkHealth::unsent,
                                   &LinkHealth::malformed,
                                   &LinkHealth::foreign,
                                   &LinkHealth::replayed,
                                   &LinkHealth::too_old,
                                   &LinkHealth::forged};
    for (const auto counter : kCounters) {
      PALP_CHECK(health.*counter >= before_.*counter, "counters never fall");
    }
    PALP_CHECK(in_.popped() == health.accepted + health.late + health.stale + health.malformed +
                                   health.foreign + health.replayed + health.too_old +
                                   health.forged,
               "each datagram has one outcome");
  }

  void sample_laws(TimePoint now) {
    std::set<std::uint64_t>& known = handed_over_[session_id_];
    const std::uint64_t newest_before = known.empty() ? 0 : *known.rbegin();
    const bool first = known.empty();
    std::uint64_t previous = 0;
    for (const Incoming& incoming : side_.samples) {
      PALP_CHECK(session_id_ != 0, "without a session nothing is handed over");
      PALP_CHECK(known.insert(incoming.number).second, "a sample is handed over at most once");
      PALP_CHECK(previous <= incoming.number && incoming.number <= message::kNumberMax,
                 "sorted by number");
      PALP_CHECK(!incoming.fresh || first || incoming.number > newest_before, "fresh is newer");
      PALP_CHECK(!(incoming.fresh && incoming.repaired), "a copy is not fresh");
      PALP_CHECK(incoming.arrived_at <= now, "nothing arrives from the future");
      PALP_CHECK(std::isfinite(incoming.sample.position) &&
                     std::isfinite(incoming.sample.velocity) &&
                     std::isfinite(incoming.sample.force),
                 "samples are numbers");
      previous = incoming.number;
    }
  }

  Side& side_;
  const Lane& in_;
  std::uint64_t session_id_{};
  LinkHealth before_;
  std::map<std::uint64_t, std::set<std::uint64_t>> handed_over_;  ///< numbers, by session
};

/// What the network does to the next datagrams of one direction; remembers the last ones.
class Mischief {
 public:
  explicit Mischief(Lane& lane) : lane_{lane} {
    lane.outcome = [this](std::uint64_t, const Bytes& bytes) { return act(bytes); };
  }

  void plan(ByteSource& input) {
    deed_ = input.below(8);
    for_datagrams_ = 1 + input.below(16);
    place_ = input.take<std::uint16_t>();
    change_ = input.take<std::uint8_t>();
  }
  void inject(const Bytes& bytes, TimePoint now) {
    const std::size_t kept = std::exchange(for_datagrams_, 0);
    lane_.push(bytes, now);
    for_datagrams_ = kept;
  }
  [[nodiscard]] const Bytes& last() const { return last_; }

 private:
  std::vector<Release> act(const Bytes& bytes) {
    last_ = bytes;
    if (for_datagrams_ == 0) return {{delay_, bytes}};
    --for_datagrams_;
    Bytes changed = bytes;
    const std::size_t at = bytes.empty() ? 0 : place_ % bytes.size();
    switch (deed_) {
      case 0:
        return {};
      case 1:
        return {{delay_, bytes}, {delay_ + milliseconds{change_}, bytes}};
      case 2:
        if (!changed.empty()) changed[at] ^= static_cast<std::byte>(change_);
        break;
      case 3:
        changed.resize(at);
        break;
      case 4:
        changed.resize(bytes.size() + place_ % 2048U, static_cast<std::byte>(change_));
        break;
      case 5:
        return {{delay_ + milliseconds{change_}, bytes}};
      case 6:
        delay_ = milliseconds{change_};
        break;
      default:
        if (at >= 8 && at < 16) changed[at] = static_cast<std::byte>(change_);  // its number
        break;
    }
    return {{delay_, changed}};
  }

  Lane& lane_;
  Bytes last_;
  std::size_t deed_{};
  std::size_t for_datagrams_{};
  std::size_t place_{};
  std::uint8_t change_{};
  Duration delay_{};
};

class Play {
 public:
  explicit Play(ByteSource input) : input_{input} { couple_.connect(session_id_); }

  void run() {
    while (!input_.empty() && ticks_ < kTicksMax) deed();
    tick(32);  // what still waits
  }

 private:
  void tick(std::size_t count) {
    for (; count > 0; --count, ++ticks_) {
      surgeon_.before_tick(couple_.now);
      patient_.before_tick(couple_.now);
      const TimePoint now = couple_.now;
      couple_.tick();
      surgeon_.after_tick(now);
      patient_.after_tick(now);
    }
  }

  void deed() {
    const bool up = input_.below(2) == 0;
    Mischief& way = up ? up_ : down_;
    Side& sender = up ? couple_.surgeon : couple_.patient;
    switch (input_.below(12)) {
      case 0:
        return way.plan(input_);
      case 1:
        return way.inject(stranger(input_.below(256)), couple_.now);
      case 2:
        return way.inject(way.last(), couple_.now);
      case 3:
        return way.inject(lie(up), couple_.now);
      case 4:
        return speak(sender.telegram);
      case 5:
        sender.sending = !sender.sending;
        return;
      case 6:
        couple_.now += milliseconds{input_.take<std::uint16_t>()};
        return tick(1);
      case 7:
        return couple_.connect(++session_id_);
      case 8:
        return renew(sender, up);
      case 9:
        (void)sender.link.adopt({}, couple_.now);
        return;
      default:
        return tick(1 + input_.below(32));
    }
  }

  Bytes stranger(std::size_t size) {
    const auto bytes = input_.take_bytes(size);
    return {bytes.begin(), bytes.end()};
  }

  /// A well-formed telegram of someone who knows the connection.
  Bytes lie(bool up) {
    WireTelegram telegram;
    telegram.sent_at_ns = input_.magnitude();
    if (input_.below(4) != 0) {
      telegram.echo_ns = input_.magnitude();
      telegram.hold_us = static_cast<std::uint32_t>(input_.magnitude());
      telegram.newest_number = input_.magnitude();
      telegram.before_newest = input_.take<std::uint32_t>();
    }
    telegram.telegram.site.epoch = input_.take<std::uint8_t>();
    telegram.telegram.site.state = static_cast<SiteState>(input_.below(kSiteStateCount));
    telegram.older_count = static_cast<std::uint8_t>(input_.below(3));
    Bytes plain(message::kTelegramSizeMax);
    plain.resize(
        WireCodec{}.encode(telegram, std::span<std::byte, message::kTelegramSizeMax>{plain}));
    const auto id = static_cast<std::uint32_t>(2 * session_id_);
    const Header header{.type = PacketType::Data,
                        .key = 0,
                        .length = 0,
                        .connection = up ? id + 1 : id,
                        .number = std::min(input_.magnitude(), message::kNumberMax)};
    Bytes bytes(kHeaderSize + plain.size());
    bytes.resize(PlainProtection{}.seal(header, plain, bytes));
    return bytes;
  }

  void speak(Telegram& telegram) {
    telegram.site.epoch = input_.take<std::uint8_t>();
    telegram.site.depth.number = input_.take<std::uint8_t>();
    telegram.port.position = input_.take<std::uint8_t>() * 0.05;  // [m]; some are refused
    switch (input_.below(4)) {
      case 0:
        telegram.port.payload = std::monostate{};
        return;
      case 1:
        telegram.port.payload = WavePayload{};
        return;
      case 2:
        telegram.port.payload = TdpaPayload{};
        return;
      default:
        telegram.port.payload = ModelPayload{};
    }
  }

  /// Another transport and protection for the session there is.
  void renew(Side& side, bool surgeon) {
    const std::uint64_t session_id = side.link.health(couple_.now).session_id;
    if (session_id == 0) return;
    const auto id = static_cast<std::uint32_t>(2 * session_id);
    auto transport = surgeon ? couple_.pipe.surgeon_end() : couple_.pipe.patient_end();
    (void)side.link.adopt(
        Couple::link_update(
            std::move(transport), surgeon ? id + 1 : id, surgeon ? id : id + 1, session_id),
        couple_.now);
  }

  ByteSource input_;
  Couple couple_;
  std::uint64_t session_id_{1};
  Mischief up_{*couple_.pipe.up};
  Mischief down_{*couple_.pipe.down};
  Probe surgeon_{couple_.surgeon, *couple_.pipe.down};
  Probe patient_{couple_.patient, *couple_.pipe.up};
  std::size_t ticks_{};
};

}  // namespace
}  // namespace palp::link

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palp::link::Play{palp::fuzz::ByteSource{palp::fuzz::as_bytes(data, size)}}.run();
  return 0;
}
