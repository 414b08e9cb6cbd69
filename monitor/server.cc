#include "monitor/server.h"

#include <algorithm>
#include <list>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "common/io/realtime/background_loop.h"
#include "common/io/realtime/steady_clock.h"
#include "monitor/live_source.h"
#include "monitor/page_files.h"

namespace palp::monitor {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;

constexpr Duration kRound = std::chrono::milliseconds{10};
/// A queue that grows in a press is noticed so much and a slow round trip (pilot.h) later: within
/// the 200 ms in which a hand is let go of.
constexpr Duration kPingEvery = std::chrono::milliseconds{100};
constexpr auto kRequestTime = std::chrono::seconds{10};
constexpr auto kIdleTime = std::chrono::seconds{20};
constexpr std::size_t kConnectionsMax = 64;  ///< clients, and who has not shown a token yet
constexpr int kUnsentMax = 64 * 1024;  ///< [bytes], that the system keeps: nothing in it gives way
constexpr int kPortTries = 10;         ///< for one that is free at both addresses
constexpr std::size_t kMessageMax = std::size_t{16} * 1024;  ///< [bytes], of a client
constexpr std::uint32_t kHeaderMax = 8 * 1024;               ///< [bytes]
constexpr std::uint64_t kBodyMax = 1024;                     ///< [bytes], nobody asks with one
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// What a connection needs of all others.
struct Shared {
  Access access;
  Desk desk;
  io::SteadyClock clock{};
};

/// One connection, from its request to its end. It lives until nothing of it is under way.
class Connection {
 public:
  Connection(Shared& shared, tcp::socket socket) : shared_{shared}, stream_{std::move(socket)} {}
  ~Connection() { close(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start();
  void close();
  /// Sends what waits for it.
  void pump();
  void ping(TimePoint now);
  [[nodiscard]] bool over() const noexcept { return closed_ && under_way_ == 0; }
  [[nodiscard]] bool is_client() const noexcept { return client_ != 0; }
  [[nodiscard]] std::uint32_t client() const noexcept { return client_; }

 private:
  /// A handler that counts as under way, and is not run after the end.
  template <class Handler>
  auto counted(Handler handler) {
    ++under_way_;
    return [this, handler](beast::error_code error, auto... rest) {
      --under_way_;
      if (closed_) return;
      if (error) return close();
      handler(rest...);
    };
  }

  void answer();
  void reply(http::status status, std::string_view media_type, std::string_view text);
  void refuse(http::status status, std::string_view sentence) {
    reply(status, "text/plain; charset=utf-8", sentence);
  }
  void upgrade();
  void become_client();
  void read();
  void hear();
  void heard_pong(std::string_view payload);

  Shared& shared_;
  beast::tcp_stream stream_;  ///< moved into the socket below by an upgrade
  std::optional<websocket::stream<beast::tcp_stream>> socket_;
  beast::flat_buffer in_;
  std::optional<http::request_parser<http::string_body>> parser_{std::in_place};
  http::response<http::string_body> response_;
  Right right_{};
  std::uint32_t client_{};  ///< its number at the desk; 0: none yet
  int under_way_{};
  bool writing_{};
  bool pinging_{};      ///< a ping is being written
  bool awaits_pong_{};  ///< and then answered
  TimePoint pinged_at_{};
  std::uint64_t pings_{};
  bool closed_{};
};

void Connection::start() {
  parser_->header_limit(kHeaderMax);
  parser_->body_limit(kBodyMax);
  stream_.expires_after(kRequestTime);
  http::async_read(stream_, in_, *parser_, counted([this](std::size_t) { answer(); }));
}

void Connection::close() {
  if (closed_) return;
  closed_ = true;
  if (is_client()) shared_.desk.leave(client_, shared_.clock.now());
  beast::error_code ignored;
  (void)beast::get_lowest_layer(socket_ ? socket_->next_layer() : stream_).socket().close(ignored);
}

void Connection::answer() {
  const auto& request = parser_->get();
  const std::string_view host = view_of(request[http::field::host]);
  const std::string_view origin = view_of(request[http::field::origin]);
  if (!Access::host_allowed(host)) {
    return refuse(http::status::forbidden, "this site answers to its loopback names only\n");
  }
  if (!shared_.access.origin_allowed(origin, host)) {
    return refuse(http::status::forbidden, "pages from elsewhere may not ask here\n");
  }
  if (websocket::is_upgrade(request)) return upgrade();
  if (request.method() != http::verb::get) {
    return refuse(http::status::method_not_allowed, "only GET is known here\n");
  }
  const std::string_view target = view_of(request.target());
  const PageFile file = page_file(target.substr(0, target.find('?')));
  if (file.media_type.empty()) return refuse(http::status::not_found, "there is no such page\n");
  reply(http::status::ok, file.media_type, file.text);
}

void Connection::reply(http::status status, std::string_view media_type, std::string_view text) {
  response_ = {status, 11};
  response_.set(http::field::content_type, media_type);
  response_.set("Content-Security-Policy", kPolicy);
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("Referrer-Policy", "no-referrer");
  response_.set("Cross-Origin-Resource-Policy", "same-origin");
  response_.set("Cross-Origin-Opener-Policy", "same-origin");
  response_.set(http::field::cache_control, "no-store");
  response_.body() = text;
  response_.keep_alive(false);
  response_.prepare_payload();
  stream_.expires_after(kRequestTime);
  http::async_write(stream_, response_, counted([this](std::size_t) {
                      beast::error_code ignored;
                      (void)stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      close();
                    }));
}

void Connection::upgrade() {
  const auto& request = parser_->get();
  const TimePoint now = shared_.clock.now();
  right_ = shared_.access.right_of(token_in(view_of(request.target())), now);
  if (right_ == Right::None) {
    if (shared_.access.weary(now)) return close();
    return refuse(http::status::unauthorized, "nothing is shown without this run's token\n");
  }
  if (shared_.desk.clients() >= Desk::kClientsMax) {
    return refuse(http::status::service_unavailable, "too many clients look already\n");
  }
  const std::string_view offered = view_of(request[http::field::sec_websocket_protocol]);
  const std::string chosen{subprotocol_of(offered)};
  if (chosen.empty() && !offered.empty()) {
    return refuse(http::status::bad_request, "foxglove.sdk.v1 is spoken here\n");
  }
  stream_.expires_never();
  socket_.emplace(std::move(stream_));
  socket_->set_option(websocket::stream_base::timeout{kRequestTime, kIdleTime, true});
  socket_->set_option(websocket::stream_base::decorator{[chosen](websocket::response_type& to) {
    if (!chosen.empty()) to.set(http::field::sec_websocket_protocol, chosen);
  }});
  websocket::permessage_deflate plain;
  plain.server_enable = false;
  socket_->set_option(plain);
  socket_->read_message_max(kMessageMax);
  socket_->auto_fragment(false);
  beast::error_code ignored;
  tcp::socket& below = beast::get_lowest_layer(*socket_).socket();
  (void)below.set_option(tcp::no_delay{true}, ignored);
  (void)below.set_option(tcp::socket::send_buffer_size{kUnsentMax}, ignored);
  ++under_way_;
  socket_->async_accept(request, [this](beast::error_code error) {
    --under_way_;
    if (closed_) return;
    error ? close() : become_client();
  });
}

void Connection::become_client() {
  parser_.reset();
  client_ = shared_.desk.join(right_, shared_.clock.now());
  if (client_ == 0) return close();
  socket_->control_callback([this](websocket::frame_type kind, beast::string_view payload) {
    if (kind == websocket::frame_type::pong) heard_pong(view_of(payload));
  });
  pump();
  read();
}

void Connection::read() {
  socket_->async_read(in_, counted([this](std::size_t) { hear(); }));
}

void Connection::hear() {
  const std::string_view said{static_cast<const char*>(in_.data().data()), in_.size()};
  const TimePoint now = shared_.clock.now();
  const bool stays = socket_->got_text() ? shared_.desk.hear_text(client_, said, now)
                                         : shared_.desk.hear_bytes(client_, said, now);
  in_.consume(in_.size());
  if (!stays) return close();
  pump();
  if (!closed_) read();
}

void Connection::pump() {
  if (!is_client() || closed_) return;
  Outbox& outbox = shared_.desk.outbox(client_);
  // Also while a write waits: a client that reads nothing never ends it.
  if (outbox.hopeless()) return close();
  if (writing_ || outbox.empty()) return;
  const Frame& frame = outbox.begin_first();
  writing_ = true;
  socket_->text(frame.text);
  socket_->async_write(asio::buffer(frame.body), counted([this](std::size_t) {
                         writing_ = false;
                         shared_.desk.outbox(client_).pop();
                         pump();
                       }));
}

/// One at a time: what has had no answer counts by its age, however long the way has become.
void Connection::ping(TimePoint now) {
  if (!is_client() || closed_) return;
  const Duration age = now - pinged_at_;
  if (awaits_pong_) return shared_.desk.awaits_pong(client_, age, now);
  if (pinging_ || age < kPingEvery) return;
  pinging_ = awaits_pong_ = true;
  pinged_at_ = now;
  const std::string number = std::to_string(++pings_);
  ++under_way_;
  socket_->async_ping(websocket::ping_data{number.c_str()}, [this](beast::error_code error) {
    --under_way_;
    pinging_ = false;
    if (!closed_ && error) close();
  });
}

void Connection::heard_pong(std::string_view payload) {
  if (!is_client() || !awaits_pong_ || payload != std::to_string(pings_)) return;
  awaits_pong_ = false;
  const TimePoint now = shared_.clock.now();
  shared_.desk.heard_pong(client_, now - pinged_at_, now);
}

}  // namespace

/// All that the monitor's thread owns.
class Server::Io {
 public:
  Io(const ServerConfig& config, Controls controls, Feed& feed)
      : source_{feed, controls.camera},
        shared_{Access{config.tokens, config.origins}, Desk{config.desk, controls}} {
    listen(config.port);
  }
  /// A round: what is new goes out, then whatever clients say for a while.
  void work(TimePoint now);
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  void wake() {
    asio::post(context_, [this] {
      source_.publish_camera(shared_.desk);
      for (Connection& one : connections_) one.pump();
    });
  }

 private:
  struct Listener {
    tcp::acceptor acceptor;
    bool accepting{};
  };

  void listen(std::uint16_t port);
  /// At `port_`, which it sets where that is 0. @returns why not.
  beast::error_code open(const asio::ip::address& address);
  void accept(Listener& listener);
  void take(tcp::socket socket);

  LiveSource source_;
  Shared shared_;
  asio::io_context context_{1};
  /// A round has its length also while nothing is asked of any socket.
  asio::executor_work_guard<asio::io_context::executor_type> guard_{context_.get_executor()};
  std::list<Listener> listeners_;
  std::uint16_t port_{};
  std::list<Connection> connections_;  ///< the oldest first
};

/// At both addresses or not at all: a browser may take "localhost" for either, and whoever held the
/// port of the other would be shown the key. Only a machine without IPv6 has one.
void Server::Io::listen(std::uint16_t port) {
  namespace errc = boost::system::errc;
  const asio::ip::address both[]{asio::ip::address_v4::loopback(),
                                 asio::ip::address_v6::loopback()};
  const auto refuse = [this](const char* address, beast::error_code error) {
    throw std::runtime_error{std::string{"the monitor cannot listen on "} + address + ":" +
                             std::to_string(port_) + ": " + error.message()};
  };
  for (int tries = 1;; ++tries) {
    listeners_.clear();
    port_ = port;
    if (const auto error = open(both[0])) refuse("127.0.0.1", error);
    const auto error = open(both[1]);
    if (!error || error == errc::address_family_not_supported ||
        error == errc::address_not_available) {
      return;
    }
    if (port != 0 || tries == kPortTries) refuse("[::1]", error);
  }
}

beast::error_code Server::Io::open(const asio::ip::address& address) {
  try {
    listeners_.push_back({tcp::acceptor{context_, tcp::endpoint{address, port_}}});
    port_ = listeners_.back().acceptor.local_endpoint().port();
  } catch (const boost::system::system_error& error) {
    return error.code();
  }
  return {};
}

/// After an error the next round asks again: what has run out stays so for a while.
void Server::Io::accept(Listener& listener) {
  if (std::exchange(listener.accepting, true)) return;
  listener.acceptor.async_accept([this, &listener](beast::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    listener.accepting = false;
    if (error) return;
    take(std::move(socket));
    accept(listener);
  });
}

/// Where there are too many, the oldest that has shown no token makes room: a stranger's thousand
/// connections keep nobody out.
void Server::Io::take(tcp::socket socket) {
  const auto open = [](const Connection& one) { return !one.over(); };
  if (std::ranges::count_if(connections_, open) >= static_cast<std::ptrdiff_t>(kConnectionsMax)) {
    const auto oldest = std::ranges::find_if(
        connections_, [](const Connection& one) { return !one.is_client() && !one.over(); });
    if (oldest == connections_.end()) return;
    oldest->close();
  }
  connections_.emplace_back(shared_, std::move(socket)).start();
}

void Server::Io::work(TimePoint now) {
  source_.publish_all(shared_.desk);
  for (Connection& one : connections_) {
    one.pump();
    one.ping(now);
  }
  for (Listener& one : listeners_) accept(one);
  context_.run_for(kRound);
  connections_.remove_if([](const Connection& one) { return one.over(); });
}

Server::Server(const ServerConfig& config, Controls controls, Feed& feed)
    : io_{std::make_unique<Io>(config, controls, feed)},
      loop_{std::make_unique<io::BackgroundLoop>(
          "palp-monitor", Duration{0}, [io = io_.get()](TimePoint now) { io->work(now); })} {}

Server::~Server() = default;

std::uint16_t Server::port() const noexcept { return io_->port(); }

void Server::wake() { io_->wake(); }

std::optional<std::string> Server::failure() const { return loop_->failure(); }

}  // namespace palp::monitor
