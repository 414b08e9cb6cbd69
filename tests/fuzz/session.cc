// Input: a script for a surgeon's and a patient's Session and the network between them. A stranger
// knows every id that was ever on the wire. At the end the network is honest for ten seconds:
// then the two must have met, unless one of them left or refused for good.
#include "common/link/session.h"

#include <array>
#include <deque>
#include <memory>
#include <set>

#include "common/core/check.h"
#include "common/link/packet_protection.h"
#include "tests/common/link/test_pipe.h"
#include "tests/fuzz/fuzz.h"

namespace palp::link {
namespace {

using fuzz::ByteSource;
using std::chrono::milliseconds;

constexpr int kTicksMax = 500;

SessionConfig config_of(Role role) {
  SessionConfig config;
  config.role = role;
  config.settings_hash = 77;
  config.coupling = "direct";
  config.git = "abc";
  return config;
}

/// What a stranger on the path has read.
class Eavesdropper {
 public:
  void hear(const ControlBytes& datagram) {
    constexpr std::size_t kKept = 16;
    datagrams_.push_front({datagram.view().begin(), datagram.view().end()});
    if (datagrams_.size() > kKept) datagrams_.pop_back();
    const auto content = datagram.view().subspan(kHeaderSize);
    if (const auto hello = decode_hello(content)) {
      for (const std::uint64_t id : {hello->session_id, hello->peer_session_id}) {
        ids_.push_front(id);
        if (ids_.size() > kKept) ids_.pop_back();
      }
    }
  }
  [[nodiscard]] Bytes datagram(std::size_t index) const {
    return datagrams_.empty() ? Bytes{} : datagrams_[index % datagrams_.size()];
  }
  [[nodiscard]] std::uint64_t id(std::size_t index) const {
    return ids_.empty() ? index : ids_[index % ids_.size()];
  }

 private:
  std::deque<Bytes> datagrams_;
  std::deque<std::uint64_t> ids_;
};

/// A Session, the state its Link is said to be in, and the laws it has to keep.
class Party {
 public:
  Party(Role role, std::uint64_t entropy, Lane& out, Eavesdropper& path)
      : session_{config_of(role), entropy}, role_{role}, out_{out}, path_{path} {}

  void hear(std::span<const std::byte> datagram, TimePoint now) {
    const std::uint64_t before = session_.session_id();
    const bool working = link_works();
    const SessionOutput output = session_.on_datagram(datagram, now);
    PALP_CHECK(output.datagrams.size() <= 1, "a datagram is answered by one at most");
    const bool left = output.event && std::holds_alternative<Closed>(*output.event);
    PALP_CHECK(!working || left || session_.session_id() == before,
               "a session that works is not taken over");
    take(output, now);
  }

  void tick(TimePoint now) {
    const SessionOutput output = session_.tick(now, state_, link_session_);
    told_working_ = state_ == LinkState::Live || state_ == LinkState::Hold;
    take(output, now);
  }

  void leave(TimePoint now) {
    take(session_.close("the input says so"), now);
    PALP_CHECK(!session_.established(), "who left has no session");
    stopped_ = true;
  }

  void link_is(LinkState state) { state_ = session_.established() ? state : LinkState::Down; }
  [[nodiscard]] bool stopped() const { return stopped_; }
  [[nodiscard]] std::uint64_t session_id() const { return session_.session_id(); }

 private:
  [[nodiscard]] bool link_works() const {
    return told_working_ && session_.established() && link_session_ == session_.session_id();
  }

  void take(const SessionOutput& output, TimePoint now) {
    PALP_CHECK(!stopped_ || (output.datagrams.empty() && !output.event), "who stopped is silent");
    PALP_CHECK(session_.established() == (session_.session_id() != 0), "a session has an id");
    const SessionCounters& counters = session_.counters();
    PALP_CHECK(counters.malformed >= before_.malformed && counters.foreign >= before_.foreign,
               "counters never fall");
    before_ = counters;
    for (const ControlBytes& datagram : output.datagrams) {
      datagram_laws(datagram.view());
      path_.hear(datagram);
      out_.push(datagram.view(), now);
    }
    if (output.event) take(*output.event);
  }

  void datagram_laws(std::span<const std::byte> datagram) {
    const auto header = parse_header(datagram);
    PALP_CHECK(header.has_value(), "what is said is well formed");
    PALP_CHECK(header->connection == 0 && header->number == next_number_++,
               "as on the wire's page");
    const auto content = datagram.subspan(kHeaderSize);
    if (header->type == PacketType::Control) {
      const auto hello = decode_hello(content);
      PALP_CHECK(hello && hello->role == role_, "a Hello says who speaks");
    } else {
      PALP_CHECK(header->type == PacketType::Close && decode_bye(content), "else it is a Bye");
    }
  }

  void take(const SessionEvent& event) {
    if (const auto* established = std::get_if<Established>(&event)) {
      PALP_CHECK(established->session_id == session_.session_id(), "the session that was told of");
      PALP_CHECK(sessions_.insert(established->session_id).second, "an id serves one session");
      PALP_CHECK(established->send_connection != 0 && established->receive_connection != 0,
                 "connections have ids");
      link_session_ = established->session_id;
      state_ = LinkState::Down;
      told_working_ = false;
    } else if (const auto* refused = std::get_if<Refused>(&event)) {
      PALP_CHECK(!refused->text.empty(), "a refusal says why");
      stopped_ = stopped_ || refused->final;
    } else {
      PALP_CHECK(!std::get<Closed>(event).text.empty(), "an end says why");
      link_session_ = 0;
      state_ = LinkState::Down;
      told_working_ = false;
    }
  }

  Session session_;
  Role role_;
  Lane& out_;
  Eavesdropper& path_;
  LinkState state_{LinkState::Down};
  std::uint64_t link_session_{};
  bool told_working_{};  ///< at the last tick, of the session that is there
  bool stopped_{};
  std::uint64_t next_number_{};
  SessionCounters before_;
  std::set<std::uint64_t> sessions_;
};

class Play {
 public:
  explicit Play(ByteSource input) : input_{input} {}

  void run() {
    while (!input_.empty() && ticks_ < kTicksMax) deed();
    heal();
  }

 private:
  void tick(std::size_t count, Duration step = milliseconds{20}) {
    for (; count > 0; --count, ++ticks_, now_ += step) {
      while (const auto datagram = up_.pop(now_)) patient_->hear(datagram->second, now_);
      patient_->tick(now_);
      while (const auto datagram = down_.pop(now_)) surgeon_->hear(datagram->second, now_);
      surgeon_->tick(now_);
    }
  }

  void deed() {
    const bool to_patient = input_.below(2) == 0;
    Lane& way = to_patient ? up_ : down_;
    Party& party = to_patient ? *patient_ : *surgeon_;
    switch (input_.below(12)) {
      case 0:
        return way.push(changed(path_.datagram(input_.below(16))), now_);
      case 1:
        return way.push(stranger(input_.below(256)), now_);
      case 2:
        return way.push(path_.datagram(input_.below(16)), now_);
      case 3:
        return way.push(framed(PacketType::Control, encode(strange_hello())), now_);
      case 4:
        return way.push(framed(PacketType::Close, encode(strange_bye())), now_);
      case 5:
        return party.link_is(static_cast<LinkState>(input_.below(kLinkStateCount)));
      case 6:
        return restart(to_patient);
      case 7:
        way.outcome =
            input_.below(2) == 0 ? after(milliseconds{input_.take<std::uint8_t>()}) : kCut;
        return;
      case 8:
        if (input_.below(8) == 0) party.leave(now_);
        return;
      case 9:
        return tick(1, milliseconds{input_.take<std::uint16_t>()});
      default:
        return tick(1 + input_.below(64));
    }
  }

  Bytes stranger(std::size_t size) {
    const auto bytes = input_.take_bytes(size);
    return {bytes.begin(), bytes.end()};
  }

  Bytes changed(Bytes bytes) {
    const std::size_t at = input_.take<std::uint8_t>();
    const auto change = static_cast<std::byte>(input_.take<std::uint8_t>());
    if (at < bytes.size()) bytes[at] ^= change;
    return bytes;
  }

  Hello strange_hello() {
    Hello hello;
    hello.role = input_.below(2) == 0 ? Role::Surgeon : Role::Patient;
    hello.session_id = path_.id(input_.take<std::uint8_t>()) ^ input_.below(2);
    hello.peer_session_id = path_.id(input_.take<std::uint8_t>()) ^ input_.below(2);
    hello.connection_id = input_.take<std::uint8_t>();
    hello.settings_hash = 77 + input_.below(8) / 7;
    hello.coupling = input_.below(8) == 7 ? "wave" : "direct";
    return hello;
  }

  Bye strange_bye() {
    Bye bye;
    bye.session_id = path_.id(input_.take<std::uint8_t>());
    bye.peer_session_id = path_.id(input_.take<std::uint8_t>());
    bye.reason = static_cast<ByeReason>(input_.below(kByeReasonCount));
    return bye;
  }

  static Bytes framed(PacketType type, const ControlBytes& message) {
    Bytes bytes(kHeaderSize + message.size);
    bytes.resize(PlainProtection{}.seal({.type = type}, message.view(), bytes));
    return bytes;
  }

  void restart(bool patient) {
    const Role role = patient ? Role::Patient : Role::Surgeon;
    auto& party = patient ? patient_ : surgeon_;
    party = std::make_unique<Party>(role, ++entropy_, patient ? down_ : up_, path_);
  }

  void heal() {
    while (up_.pop(TimePoint::max())) continue;
    while (down_.pop(TimePoint::max())) continue;
    up_.outcome = after(milliseconds{10});
    down_.outcome = after(milliseconds{10});
    surgeon_->link_is(LinkState::Down);
    patient_->link_is(LinkState::Down);
    tick(500);
    if (surgeon_->stopped() || patient_->stopped()) return;
    PALP_CHECK(surgeon_->session_id() != 0 && surgeon_->session_id() == patient_->session_id(),
               "honest sites meet, whatever was before");
  }

  ByteSource input_;
  TimePoint now_{};
  Eavesdropper path_;
  Lane up_;
  Lane down_;
  std::uint64_t entropy_{2};
  std::unique_ptr<Party> surgeon_{std::make_unique<Party>(Role::Surgeon, 1, up_, path_)};
  std::unique_ptr<Party> patient_{std::make_unique<Party>(Role::Patient, 2, down_, path_)};
  std::size_t ticks_{};
};

}  // namespace
}  // namespace palp::link

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palp::link::Play{palp::fuzz::ByteSource{palp::fuzz::as_bytes(data, size)}}.run();
  return 0;
}
