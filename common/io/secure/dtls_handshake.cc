#include "common/io/secure/dtls_handshake.h"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include <openssl/hmac.h>
#include <openssl/rand.h>

#include "common/io/secure/dtls_bio.h"
#include "common/io/secure/openssl_context.h"
#include "common/io/secure/openssl_handles.h"
#include "common/io/secure/site_certificate.h"
#include "common/link/codec_control.h"
#include "common/link/transport.h"

namespace palp::io {
namespace {

using link::PlaneKeys;
using link::Role;
using link::SessionKeys;

constexpr unsigned kRepeatFirst = 200'000;  // [us]; RFC 6347 allows less than its second
constexpr unsigned kRepeatMax = 400'000;    // [us]
constexpr Duration kCookieLife = std::chrono::minutes{1};
constexpr std::size_t kCookieSize = 16;  // [bytes]; short, so that no answer outgrows its question
constexpr std::size_t kRecordHeader = 13;
constexpr std::size_t kMessageHeader = 12;
constexpr std::size_t kRandomAt = kRecordHeader + kMessageHeader + 2;
constexpr long kUdpOverIpv6 = 48;  // [bytes]

DatagramBox& box_of(BIO* bio) { return *static_cast<DatagramBox*>(BIO_get_data(bio)); }

int read_datagram(BIO* bio, char* out, int size) {
  DatagramBox& box = box_of(bio);
  BIO_clear_retry_flags(bio);
  if (box.in.empty()) {
    BIO_set_retry_read(bio);
    return -1;
  }
  const std::size_t taken = std::min(box.in.front().size(), static_cast<std::size_t>(size));
  std::copy_n(reinterpret_cast<const char*>(box.in.front().data()), taken, out);
  box.in.pop_front();
  return static_cast<int>(taken);
}

int write_datagram(BIO* bio, const char* data, int size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  box_of(bio).out.emplace_back(bytes, bytes + size);
  return size;
}

long control(BIO* /*bio*/, int command, long /*number*/, void* /*pointer*/) {
  switch (command) {
    case BIO_CTRL_FLUSH:
    case BIO_CTRL_DGRAM_SET_PEER:
      return 1;
    case BIO_CTRL_DGRAM_QUERY_MTU:
    case BIO_CTRL_DGRAM_GET_MTU:
    case BIO_CTRL_DGRAM_GET_FALLBACK_MTU:
      return link::kDatagramSizeMax;
    case BIO_CTRL_DGRAM_GET_MTU_OVERHEAD:
      return kUdpOverIpv6;
    default:
      return 0;
  }
}

Openssl<BIO_METHOD> make_method() {
  Openssl<BIO_METHOD> method{
      BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "palp datagrams")};
  if (method == nullptr || BIO_meth_set_read(method.get(), read_datagram) != 1 ||
      BIO_meth_set_write(method.get(), write_datagram) != 1 ||
      BIO_meth_set_ctrl(method.get(), control) != 1) {
    throw std::runtime_error{"cannot prepare DTLS: " + openssl_complaint()};
  }
  return method;
}

unsigned repeat_after(SSL* /*ssl*/, unsigned last) {
  return last == 0 ? kRepeatFirst : std::min(kRepeatMax, last + last / 2);
}

/// RFC 5705. @returns false: the library would not.
bool export_keys(SSL* ssl, std::string_view label, std::span<std::byte> keys) {
  constexpr std::array<unsigned char, 1> kVersion{link::kProtocolVersion};
  return SSL_export_keying_material(ssl,
                                    reinterpret_cast<unsigned char*>(keys.data()),
                                    keys.size(),
                                    label.data(),
                                    label.size(),
                                    kVersion.data(),
                                    kVersion.size(),
                                    1) == 1;
}

}  // namespace

bool looks_like_dtls(std::span<const std::byte> datagram) noexcept {
  return !datagram.empty() && datagram[0] >= std::byte{20} && datagram[0] <= std::byte{63};
}

std::optional<ClientRandom> client_random(std::span<const std::byte> datagram) noexcept {
  constexpr std::byte kHandshake{22};
  constexpr std::byte kClientHello{1};
  ClientRandom random{};
  if (datagram.size() < kRandomAt + random.size() || datagram[0] != kHandshake ||
      datagram[3] != std::byte{0} || datagram[4] != std::byte{0} ||  // epoch
      datagram[kRecordHeader] != kClientHello) {
    return std::nullopt;
  }
  std::ranges::copy(datagram.subspan(kRandomAt, random.size()), random.begin());
  return random;
}

bool shows_cookie(std::span<const std::byte> datagram) noexcept {
  constexpr std::size_t kSessionAt = kRandomAt + std::tuple_size_v<ClientRandom>;
  if (!client_random(datagram) || datagram.size() <= kSessionAt) return false;
  const std::size_t cookie_at = kSessionAt + 1 + std::to_integer<std::size_t>(datagram[kSessionAt]);
  return datagram.size() > cookie_at && datagram[cookie_at] != std::byte{0};
}

/// Secrets of this process that mark an address; the second is the former one.
struct DtlsListener::Cookies {
  using Secret = std::array<unsigned char, 32>;
  using Cookie = std::array<unsigned char, kCookieSize>;

  void renew(TimePoint now) {
    if (renewed_at && now - *renewed_at < kCookieLife) return;
    former = renewed_at ? present : fresh();
    present = fresh();
    renewed_at = now;
  }
  static Secret fresh() {
    Secret secret{};
    if (RAND_bytes(secret.data(), secret.size()) != 1) {
      throw std::runtime_error{"cannot draw a cookie secret: " + openssl_complaint()};
    }
    return secret;
  }
  [[nodiscard]] Cookie made_with(const Secret& secret) const {
    std::array<unsigned char, EVP_MAX_MD_SIZE> mac{};
    const std::string text = peer.to_string();
    HMAC(EVP_sha256(),
         secret.data(),
         static_cast<int>(secret.size()),
         reinterpret_cast<const unsigned char*>(text.data()),
         text.size(),
         mac.data(),
         nullptr);
    Cookie cookie{};
    std::copy_n(mac.begin(), cookie.size(), cookie.begin());
    return cookie;
  }
  static int generate(SSL* ssl, unsigned char* out, unsigned* size) {
    const auto* cookies = static_cast<const Cookies*>(SSL_get_app_data(ssl));
    const Cookie cookie = cookies->made_with(cookies->present);
    std::copy(cookie.begin(), cookie.end(), out);
    *size = kCookieSize;
    return 1;
  }
  static int verify(SSL* ssl, const unsigned char* given, unsigned size) {
    const auto* cookies = static_cast<const Cookies*>(SSL_get_app_data(ssl));
    if (cookies == nullptr || size != kCookieSize) return 0;
    for (const Secret& secret : {cookies->present, cookies->former}) {
      const Cookie cookie = cookies->made_with(secret);
      if (CRYPTO_memcmp(cookie.data(), given, kCookieSize) == 0) return 1;
    }
    return 0;
  }

  Secret present{};
  Secret former{};
  std::optional<TimePoint> renewed_at;
  Endpoint peer;  ///< of the datagram at hand
};

struct DtlsHandshake::Parts {
  explicit Parts(const Credentials& credentials)
      : method{make_method()}, ssl{SSL_new(credentials.context().ssl.get())} {
    BIO* bio = BIO_new(method.get());
    if (ssl == nullptr || bio == nullptr) {
      BIO_free(bio);
      throw std::runtime_error{"cannot prepare DTLS: " + openssl_complaint()};
    }
    BIO_set_data(bio, &box);
    BIO_set_init(bio, 1);
    SSL_set_bio(ssl.get(), bio, bio);
    SSL_set_mtu(ssl.get(), static_cast<long>(link::kDatagramSizeMax));
    DTLS_set_timer_cb(ssl.get(), repeat_after);
    certificates = credentials.context().pre_shared_key.empty();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  DatagramBox box;
  Openssl<BIO_METHOD> method;
  Openssl<SSL> ssl;  ///< goes before what it reads from
  bool certificates{};
};

DtlsHandshake::DtlsHandshake(const Credentials& credentials)
    : DtlsHandshake{std::make_unique<Parts>(credentials), Role::Surgeon} {
  SSL_set_connect_state(parts_->ssl.get());
  go_on();
}

DtlsHandshake::DtlsHandshake(std::unique_ptr<Parts> parts, Role role)
    : parts_{std::move(parts)}, role_{role} {}

DtlsHandshake::~DtlsHandshake() = default;
DtlsHandshake::DtlsHandshake(DtlsHandshake&&) noexcept = default;
DtlsHandshake& DtlsHandshake::operator=(DtlsHandshake&&) noexcept = default;

void DtlsHandshake::hear(std::span<const std::byte> datagram) {
  if (state_ == State::Failed) return;
  parts_->box.in.emplace_back(datagram.begin(), datagram.end());
  if (state_ == State::Done) {
    // Only for the sake of a last flight that got lost: OpenSSL repeats it.
    std::array<char, 64> ignored{};
    (void)SSL_read(parts_->ssl.get(), ignored.data(), static_cast<int>(ignored.size()));
    ERR_clear_error();
  } else {
    go_on();
  }
  parts_->box.in.clear();
}

void DtlsHandshake::tick() {
  if (state_ != State::Running) return;
  ERR_clear_error();
  if (DTLSv1_handle_timeout(parts_->ssl.get()) < 0) {
    state_ = State::Failed;
    failure_ = failure_of_silence(parts_->certificates);
    ERR_clear_error();
  }
}

void DtlsHandshake::go_on() {
  ERR_clear_error();
  SSL* ssl = parts_->ssl.get();
  const int done = SSL_do_handshake(ssl);
  if (done == 1) {
    finish();
    return;
  }
  const int why = SSL_get_error(ssl, done);
  if (why == SSL_ERROR_WANT_READ || why == SSL_ERROR_WANT_WRITE) return;
  state_ = State::Failed;
  const long verdict = SSL_get_verify_result(ssl);
  failure_ = verdict == X509_V_OK ? failure_of_handshake(ERR_peek_last_error())
                                  : failure_of_certificate(verdict);
  ERR_clear_error();
}

/// What OpenSSL does not insist on, and the keys.
void DtlsHandshake::finish() {
  SSL* ssl = parts_->ssl.get();
  DtlsResult result;
  result.peer_name = "a pre-shared key";
  state_ = State::Failed;
  if (SSL_get_extms_support(ssl) != 1) {  // RFC 7627: else exported keys may not be unique
    failure_ = {"the peer offers no extended master secret", false};
    return;
  }
  const unsigned char* name = nullptr;  // a peer that knows no names chooses none
  unsigned name_size = 0;
  SSL_get0_alpn_selected(ssl, &name, &name_size);
  if (std::string_view{reinterpret_cast<const char*>(name), name_size} != protocol_name()) {
    failure_ = failure_of_version();
    return;
  }
  if (parts_->certificates) {
    const Openssl<X509> peer{SSL_get1_peer_certificate(ssl)};
    result.peer_fingerprint = fingerprint_of(peer.get());
    if (result.peer_fingerprint.empty() || SSL_get_verify_result(ssl) != X509_V_OK) {
      failure_ = {"the peer has shown no certificate", false};
      return;
    }
    result.peer_name = site_name(peer.get());
  }
  std::array<std::byte, SessionKeys::kExportedSize> exported{};
  std::array<std::byte, PlaneKeys::kExportedSize> media{};
  if (!export_keys(ssl, "EXPORTER-palp-session", exported) ||
      !export_keys(ssl, "EXPORTER-palp-media", media)) {
    failure_ = {"no keys could be exported: " + openssl_complaint(), false};
    return;
  }
  result.keys = SessionKeys::from_exported(exported, role_);
  result.media = PlaneKeys::from_exported(media, role_);
  OPENSSL_cleanse(exported.data(), exported.size());
  OPENSSL_cleanse(media.data(), media.size());
  result_ = std::move(result);
  state_ = State::Done;
}

std::optional<DtlsResult> DtlsHandshake::take_result() { return std::exchange(result_, {}); }

std::vector<DtlsDatagram> DtlsHandshake::take_datagrams() {
  return std::exchange(parts_->box.out, {});
}

DtlsListener::DtlsListener(const Credentials& credentials)
    : credentials_{credentials}, cookies_{std::make_unique<Cookies>()} {
  SSL_CTX* context = credentials.context().ssl.get();
  SSL_CTX_set_cookie_generate_cb(context, Cookies::generate);
  SSL_CTX_set_cookie_verify_cb(context, Cookies::verify);
}

DtlsListener::~DtlsListener() = default;

DtlsListener::Answer DtlsListener::hear(std::span<const std::byte> datagram,
                                        const Endpoint& from,
                                        TimePoint now) {
  Answer answer;
  cookies_->renew(now);
  cookies_->peer = from;
  ERR_clear_error();
  if (waiting_ == nullptr) {
    waiting_ = std::make_unique<DtlsHandshake::Parts>(credentials_);
    SSL_set_app_data(waiting_->ssl.get(), cookies_.get());
    SSL_set_options(waiting_->ssl.get(), SSL_OP_COOKIE_EXCHANGE);
    SSL_set_accept_state(waiting_->ssl.get());
  }
  waiting_->box.in.emplace_back(datagram.begin(), datagram.end());
  const Openssl<BIO_ADDR> address{BIO_ADDR_new()};
  const int proven = DTLSv1_listen(waiting_->ssl.get(), address.get());
  waiting_->box.in.clear();
  ERR_clear_error();
  if (proven == 1) {
    answer.handshake = DtlsHandshake{std::move(waiting_), Role::Patient};
    answer.handshake->go_on();
    answer.datagrams = answer.handshake->take_datagrams();
  } else {
    answer.datagrams = std::exchange(waiting_->box.out, {});
  }
  return answer;
}

}  // namespace palp::io
