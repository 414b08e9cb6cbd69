#include "common/io/secure/session_server.h"

#include <array>
#include <cerrno>
#include <deque>
#include <exception>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/io/net/source_watch.h"
#include "common/io/process/system_text.h"
#include "common/io/realtime/realtime.h"
#include "common/io/realtime/steady_clock.h"
#include "common/io/secure/dtls_session.h"
#include "common/io/secure/relay_member.h"

namespace palp::io {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;

constexpr Duration kRound = std::chrono::milliseconds{5};  ///< between two looks at everything
/// Datagrams of strangers looked at in a round. A flood beyond it is left to the kernel to drop: a
/// FIFO thread that never sleeps would be stopped, and rt with it.
constexpr int kStrangersPerRoundMax = 512;
constexpr int kEarlyMax = 4096;
constexpr std::size_t kNewsMax = 64;
constexpr int kClassSelector3 = 24 << 2;  ///< TOS byte of DSCP CS3, RFC 2474

Endpoint from_asio(const udp::endpoint& endpoint) { return {endpoint.data(), endpoint.size()}; }

Endpoint found(const HostAndPort& place) {
  const Result<Endpoint> endpoint = resolve(place);
  if (!endpoint) throw std::runtime_error{endpoint.error().text};
  return *endpoint;
}

}  // namespace

/// All that the io thread owns. What is public is for the maker, the rest for the thread alone.
class SessionServer::Io {
 public:
  Io(const SessionServerConfig& config, LinkUpdateDesk& desk);
  void start();
  void close(const std::string& why);
  void abandon() { context_.stop(); }

  [[nodiscard]] Endpoint local() const { return local_; }
  [[nodiscard]] std::optional<SessionNews> news();
  [[nodiscard]] link::SessionCounters noise() { return noise_.get(); }
  [[nodiscard]] SocketCounts counts() { return desk_.inbox().counts.get(); }

 private:
  struct Early {
    Endpoint from;
    std::vector<std::byte> bytes;
  };

  void run_round();
  void wait_for_strangers();
  void hear_strangers();
  void hear(std::span<const std::byte> datagram, const Endpoint& from);
  /// `from`: where the datagram came from that is answered; none: nothing came.
  void carry_out(SessionEndpointOutput output, const Endpoint& from);
  void meet(const link::Established& session, SessionEndpointOutput& output, const Endpoint& peer);
  void carry_on(std::unique_ptr<link::Transport> transport,
                std::unique_ptr<link::PacketProtection> protection);
  void move(const Endpoint& peer, const Endpoint& former);
  void follow_machine();
  /// `former`: the address that the peer had until now, or none.
  [[nodiscard]] Result<std::unique_ptr<link::Transport>> way_to(const Endpoint& peer,
                                                                const Endpoint& former);
  void offer_waiting();
  void keep_seat();
  void send(std::span<const std::byte> datagram, const Endpoint& to);
  void leave();
  [[nodiscard]] std::string refusal_opening();
  void tell(SessionNews::Kind kind, const Endpoint& peer, std::string sentence, bool final = false);

  SessionServerConfig config_;
  LinkUpdateDesk& desk_;
  std::unique_ptr<SessionEndpoint> session_endpoint_;
  SpscQueue<SessionNews> news_{kNewsMax};  ///< writer: io, reader: the maker
  Mailbox<link::SessionCounters> noise_;   ///< writer: io, reader: the maker
  asio::io_context context_{1};
  udp::socket listening_{context_};
  asio::steady_timer round_{context_};
  SteadyClock clock_;
  Endpoint local_;
  Endpoint callee_;                       ///< surgeon: whom to call; patient: none
  Endpoint connected_;                    ///< rt has or will get a socket to there
  SourceWatch source_;                    ///< of that socket
  std::optional<RelayMember> relay_;      ///< where both sites meet, if they do
  link::Established present_;             ///< rt has or will get this session; id 0: none
  PeerIdentity met_;                      ///< of the newest session
  std::deque<link::LinkUpdate> waiting_;  ///< for room on the desk
  std::deque<Early> early_;               ///< taken by a data socket before it was connected
  std::array<std::byte, link::kDatagramSizeMax + 1> buffer_{};
  int strangers_{};  ///< heard in this round
  bool listens_{};   ///< a wait is under way
  std::jthread thread_;
};

SessionServer::Io::Io(const SessionServerConfig& config, LinkUpdateDesk& desk)
    : config_{config},
      desk_{desk},
      relay_{RelayMember::at(config.relay, config.room, config.session.role)} {
  const bool anywhere = relay_ && config.address.host.empty();
  const Endpoint place = anywhere ? relay_->relay().caller() : found(config.address);
  Endpoint wish = place;
  if (config.session.role == link::Role::Surgeon) {
    if (place.port() == 0) {
      throw std::runtime_error{"cannot call " + config.address.to_string() +
                               ": the port must be 1 to 65535"};
    }
    callee_ = place;
    wish = place.caller();
  }
  // Bound without leave to share: an owner of this port is noticed, and none can come after us.
  boost::system::error_code refusal;
  listening_.open(wish.family() == AF_INET6 ? udp::v6() : udp::v4(), refusal);
  if (refusal || ::bind(listening_.native_handle(), wish.address(), wish.size()) != 0) {
    throw std::runtime_error{"cannot listen on " + config.address.to_string() + ": " +
                             system_text(refusal ? refusal.value() : errno)};
  }
  listening_.non_blocking(true);
  mark_datagrams(listening_.native_handle(), wish.family(), kClassSelector3);
  local_ = from_asio(listening_.local_endpoint());
  session_endpoint_ = make_session_endpoint(
      {.session = config_.session, .callee = callee_, .rekey_after = config_.rekey_after},
      config_.credentials);
}

void SessionServer::Io::start() {
  thread_ = std::jthread{[this] {
    name_this_thread("palp-io");
    (void)request_realtime(config_.priority, false, read_realtime_limits());
    round_.expires_after(Duration{0});
    run_round();
    context_.run();
  }};
}

void SessionServer::Io::close(const std::string& why) {
  if (!thread_.joinable()) return;
  asio::post(context_, [this, why] {
    carry_out(session_endpoint_->close(why), {});
    context_.stop();
  });
  thread_.join();
}

std::optional<SessionNews> SessionServer::Io::news() {
  SessionNews news;
  return news_.try_dequeue(news) ? std::optional{std::move(news)} : std::nullopt;
}

void SessionServer::Io::run_round() {
  desk_.destroy_retired();
  SideDatagram aside;
  for (std::size_t i = 0; i < SideInbox::kCapacity; ++i) {
    if (desk_.inbox().datagrams.try_dequeue(aside)) hear(aside.datagram(), aside.from);
  }
  carry_out(session_endpoint_->tick(clock_.now(), desk_.link()), callee_);
  for (std::deque<Early> early = std::exchange(early_, {}); !early.empty(); early.pop_front()) {
    hear(early.front().bytes, early.front().from);
  }
  follow_machine();
  keep_seat();
  if (config_.media != nullptr) config_.media->serve(listening_.native_handle(), local_);
  offer_waiting();
  noise_.put(session_endpoint_->counters());
  strangers_ = 0;
  wait_for_strangers();
  round_.expires_at(round_.expiry() + kRound);
  if (round_.expiry() < asio::steady_timer::clock_type::now()) round_.expires_after(kRound);
  round_.async_wait([this](const boost::system::error_code& refusal) {
    if (!refusal) run_round();
  });
}

void SessionServer::Io::wait_for_strangers() {
  if (std::exchange(listens_, true)) return;
  listening_.async_wait(udp::socket::wait_read, [this](const boost::system::error_code& refusal) {
    listens_ = false;
    if (!refusal) hear_strangers();
  });
}

void SessionServer::Io::hear_strangers() {
  while (strangers_ < kStrangersPerRoundMax) {
    udp::endpoint from;
    boost::system::error_code refusal;
    const std::size_t size = listening_.receive_from(asio::buffer(buffer_), from, 0, refusal);
    if (refusal == asio::error::would_block) {
      wait_for_strangers();
      return;
    }
    ++strangers_;
    if (refusal) return;  // the next round tries again
    hear(std::span{buffer_}.first(size), from_asio(from));
  }
}

void SessionServer::Io::hear(std::span<const std::byte> datagram, const Endpoint& from) {
  const TimePoint now = clock_.now();
  if (relay_ && !datagram.empty() && datagram[0] == RelayMessage::kFirstByte) {
    if (const auto answer = relay_->hear(datagram, from, now)) send(*answer, from);
    return;
  }
  if (MediaDoor::take(config_.media, datagram, from, now)) return;
  SessionEndpointOutput output = session_endpoint_->hear(datagram, from, now);
  if (output.detours) (void)desk_.inbox().detours.try_emplace(datagram, from, now);
  carry_out(std::move(output), from);
}

void SessionServer::Io::carry_out(SessionEndpointOutput output, const Endpoint& from) {
  if (output.event) {
    if (const auto* session = std::get_if<link::Established>(&*output.event)) {
      meet(*session, output, from);
    } else if (const auto* refused = std::get_if<link::Refused>(&*output.event)) {
      const auto why = refusal_text(*refused, output.unanswered, relay_);
      if (why) tell(SessionNews::Kind::Refused, from, refusal_opening() + *why, refused->final);
    } else if (const auto* closed = std::get_if<link::Closed>(&*output.event)) {
      tell(SessionNews::Kind::Closed, connected_, "the session is over: " + closed->text);
      leave();
    }
  }
  if (output.protection != nullptr) carry_on(nullptr, std::move(output.protection));
  if (output.moved_to) move(*output.moved_to, output.moved_from);
  for (const Letter& letter : output.letters) send(letter.bytes, letter.to);
  offer_waiting();
}

void SessionServer::Io::send(std::span<const std::byte> datagram, const Endpoint& to) {
  // Nothing to do about a refusal: what matters is repeated.
  (void)::sendto(listening_.native_handle(),
                 datagram.data(),
                 datagram.size(),
                 MSG_DONTWAIT | MSG_NOSIGNAL,
                 to.address(),
                 to.size());
}

/// A session that works is not disturbed with what the relay says.
void SessionServer::Io::keep_seat() {
  if (!relay_) return;
  using enum RelayMember::SessionIs;
  const bool in_session = present_.session_id != 0;
  const auto session = !in_session ? None : desk_.link().state == LinkState::Live ? Live : Silent;
  if (const auto message = relay_->tick(clock_.now(), session)) send(*message, relay_->relay());
  const auto news = relay_->take_news();
  if (!news || in_session) return;
  tell(news->good ? SessionNews::Kind::Moved : SessionNews::Kind::Refused,
       relay_->relay(),
       (news->good ? "" : "no session: ") + news->sentence);
}

void SessionServer::Io::offer_waiting() {
  while (!waiting_.empty() && desk_.offer(std::move(waiting_.front()))) waiting_.pop_front();
}

void SessionServer::Io::meet(const link::Established& session,
                             SessionEndpointOutput& output,
                             const Endpoint& peer) {
  link::LinkUpdate next{.transport = nullptr,
                        .protection = std::move(output.protection),
                        .send_connection = session.send_connection,
                        .receive_connection = session.receive_connection,
                        .session_id = session.session_id,
                        .peer_devices = session.peer_devices};
  if (!(peer == connected_)) {
    Result<std::unique_ptr<link::Transport>> way = way_to(peer, {});
    if (!way) {
      tell(SessionNews::Kind::Refused, peer, "no session: " + way.error().text);
      leave();
      return;
    }
    next.transport = std::move(*way);
    connected_ = peer;
  }
  present_ = session;
  met_ = identity_of(session, *session_endpoint_);
  waiting_.push_back(std::move(next));
  if (config_.media != nullptr) config_.media->begin({session.session_id, output.media, peer});
  tell(SessionNews::Kind::Established,
       peer,
       session_sentence(config_.session.role, peer, session, session_endpoint_->proof()));
}

/// A surgeon in a session calls for new keys only; the session has those it has.
std::string SessionServer::Io::refusal_opening() {
  const LinkState link = desk_.link().state;
  const bool works = link == LinkState::Live || link == LinkState::Hold;
  return works && config_.session.role == link::Role::Surgeon ? "no new keys: " : "no session: ";
}

/// The present session goes on with what is not null.
void SessionServer::Io::carry_on(std::unique_ptr<link::Transport> transport,
                                 std::unique_ptr<link::PacketProtection> protection) {
  if (present_.session_id == 0) return;
  waiting_.push_back({.transport = std::move(transport),
                      .protection = std::move(protection),
                      .send_connection = present_.send_connection,
                      .receive_connection = present_.receive_connection,
                      .session_id = present_.session_id,
                      .continues = true});
}

/// The present session goes on with another address of the peer.
void SessionServer::Io::move(const Endpoint& peer, const Endpoint& former) {
  if (present_.session_id == 0 || peer == connected_) return;
  Result<std::unique_ptr<link::Transport>> way = way_to(peer, former);
  if (!way) return;  // its next datagram begins anew
  carry_on(std::move(*way), nullptr);
  connected_ = peer;
  tell(SessionNews::Kind::Moved, peer, "the peer's address is now " + peer.to_string());
}

/// The surgeon's session goes on from another address of its own; only the patient follows.
void SessionServer::Io::follow_machine() {
  if (!callee_.valid() || !connected_.valid() || !source_.has_changed(clock_.now())) return;
  Result<std::unique_ptr<link::Transport>> way = way_to(connected_, {});
  if (!way) return;  // the next look tries again
  carry_on(std::move(*way), nullptr);
  tell(SessionNews::Kind::Moved, connected_, "this site's own address has changed");
}

Result<std::unique_ptr<link::Transport>> SessionServer::Io::way_to(const Endpoint& peer,
                                                                   const Endpoint& former) {
  // Only as long as it takes: meanwhile any process of this user could share the port.
  share_port(listening_.native_handle(), true);
  Result<std::unique_ptr<UdpSocket>> socket =
      UdpSocket::connect(local_, peer, desk_.inbox(), config_.socket);
  share_port(listening_.native_handle(), false);
  if (!socket) return fail(socket.error().text);
  (*socket)->follow(former);
  source_.begin((*socket)->local(), peer);
  session_endpoint_->set_own_address((*socket)->local());
  // Before it was connected it took what strangers sent: that is ours to hear.
  for (int i = 0; i < kEarlyMax; ++i) {
    const auto stranger = (*socket)->take_early(buffer_);
    if (!stranger) break;
    const std::size_t size = std::min(stranger->size, buffer_.size());
    if (size > 0 && buffer_[0] != kDataFirstByte) {
      early_.push_back({stranger->from, {buffer_.begin(), buffer_.begin() + size}});
    }
  }
  if (config_.wrap_transport) return config_.wrap_transport(std::move(*socket));
  return std::move(*socket);
}

void SessionServer::Io::leave() {
  connected_ = {};
  present_ = {};
  if (config_.media != nullptr) config_.media->begin({});
  waiting_.push_back({});
}

void SessionServer::Io::tell(SessionNews::Kind kind,
                             const Endpoint& peer,
                             std::string sentence,
                             bool final) {
  (void)news_.try_enqueue({kind, final, clock_.now(), peer, std::move(sentence), met_});
}

SessionServer::SessionServer(const SessionServerConfig& config, LinkUpdateDesk& desk)
    : io_{std::make_unique<Io>(config, desk)} {
  io_->start();
}

SessionServer::~SessionServer() {
  try {
    close("the program ends");
  } catch (const std::exception&) {
    io_->abandon();  // out of memory: no farewell
  }
}

Endpoint SessionServer::local() const { return io_->local(); }

std::optional<SessionNews> SessionServer::news() { return io_->news(); }

SocketCounts SessionServer::socket_counts() const { return io_->counts(); }

link::SessionCounters SessionServer::noise() const { return io_->noise(); }

void SessionServer::close(const std::string& why) { io_->close(why); }

}  // namespace palp::io
