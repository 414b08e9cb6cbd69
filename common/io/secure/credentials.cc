#include "common/io/secure/credentials.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include <openssl/crypto.h>
#include <openssl/pem.h>
#include <openssl/x509err.h>

#include "common/core/whole_file.h"
#include "common/io/process/system_text.h"
#include "common/io/secure/dtls_failure.h"
#include "common/io/secure/openssl_context.h"
#include "common/io/secure/openssl_handles.h"
#include "common/io/secure/site_certificate.h"

namespace palp::io {
namespace {

using link::Role;

constexpr char kBenchIdentity[] = "palp-bench";
constexpr std::size_t kPreSharedKeySize = 32;  // [bytes]
constexpr int kDaysToRenew = 14;
constexpr char kCertificateFile[] = "certificate.pem";
constexpr char kKeyFile[] = "key.pem";
constexpr char kPeersFile[] = "peers.txt";
constexpr char kRevokedFile[] = "revoked.pem";
/// In the place of a list, for a service whose folder always holds all files.
constexpr char kNothingRevoked[] = "nothing is revoked";
constexpr char kSharedKeyFile[] = "pre_shared_key.txt";
/// Forward secret, authenticated encryption, 256 bits: nothing else is offered or accepted.
constexpr char kCertificateSuites[] = "ECDHE-ECDSA-AES256-GCM-SHA384:ECDHE-RSA-AES256-GCM-SHA384";
/// The only forward secret suite of OpenSSL 3.0 with a pre-shared key and authenticated encryption.
constexpr char kPreSharedSuites[] = "ECDHE-PSK-CHACHA20-POLY1305";

/// OpenSSL keeps private keys in memory of its own, which is neither swapped nor dumped. Where the
/// system has no locked memory to give, they lie among the rest as without it.
void keep_private_keys_apart() {
  constexpr std::size_t kHeap = std::size_t{64} << 10U;  // [bytes], many times a site's key
  constexpr std::size_t kSmallest = 32;                  // [bytes]
  if (CRYPTO_secure_malloc_initialized() == 0) (void)CRYPTO_secure_malloc_init(kHeap, kSmallest);
}

/// After OpenSSL's own checks: what only a site's certificate says, and whose it is. The errors are
/// told apart in dtls_handshake.cc.
int check_peer(int passed, X509_STORE_CTX* store) {
  if (passed != 1 || X509_STORE_CTX_get_error_depth(store) != 0) return passed;
  const auto* ssl = static_cast<const SSL*>(
      X509_STORE_CTX_get_ex_data(store, SSL_get_ex_data_X509_STORE_CTX_idx()));
  const auto* context =
      static_cast<const Credentials::Context*>(SSL_CTX_get_app_data(SSL_get_SSL_CTX(ssl)));
  X509* certificate = X509_STORE_CTX_get_current_cert(store);
  const CertificateFlaw flaw = flaw_of(certificate, context->peer);
  if (flaw == CertificateFlaw::None &&
      (!context->peer_names || context->peer_names->contains(site_name(certificate)))) {
    return 1;
  }
  X509_STORE_CTX_set_error(store,
                           flaw == CertificateFlaw::None   ? X509_V_ERR_HOSTNAME_MISMATCH
                           : flaw == CertificateFlaw::Role ? X509_V_ERR_APPLICATION_VERIFICATION
                                                           : X509_V_ERR_INVALID_PURPOSE);
  return 0;
}

const Credentials::Context& context_of(SSL* ssl) {
  return *static_cast<const Credentials::Context*>(SSL_CTX_get_app_data(SSL_get_SSL_CTX(ssl)));
}

/// A key that has a passphrase is refused: OpenSSL would ask the terminal for it.
int no_passphrase(char* /*out*/, int /*size*/, int /*writes*/, void* /*data*/) { return -1; }

unsigned give_key(SSL* ssl, unsigned char* out, unsigned size_max) {
  const std::vector<unsigned char>& key = context_of(ssl).pre_shared_key;
  if (key.size() > size_max) return 0;
  std::copy(key.begin(), key.end(), out);
  return static_cast<unsigned>(key.size());
}

unsigned client_key(SSL* ssl,
                    const char* /*hint*/,
                    char* identity,
                    unsigned identity_max,
                    unsigned char* out,
                    unsigned size_max) {
  if (identity_max < sizeof kBenchIdentity) return 0;
  std::memcpy(identity, kBenchIdentity, sizeof kBenchIdentity);
  return give_key(ssl, out, size_max);
}

unsigned server_key(SSL* ssl, const char* identity, unsigned char* out, unsigned size_max) {
  return std::strcmp(identity, kBenchIdentity) == 0 ? give_key(ssl, out, size_max) : 0;
}

/// As RFC 7301 has it: the name behind its length.
std::vector<unsigned char> version_offered() {
  const std::string name = protocol_name();
  std::vector<unsigned char> offered{static_cast<unsigned char>(name.size())};
  offered.insert(offered.end(), name.begin(), name.end());
  return offered;
}

/// A surgeon that offers other versions only gets an alert that says so.
int choose_version(SSL* /*ssl*/,
                   const unsigned char** out,
                   unsigned char* size,
                   const unsigned char* theirs,
                   unsigned theirs_size,
                   void* /*data*/) {
  const std::vector<unsigned char> ours = version_offered();
  unsigned char* chosen = nullptr;
  if (SSL_select_next_proto(
          &chosen, size, theirs, theirs_size, ours.data(), static_cast<unsigned>(ours.size())) !=
      OPENSSL_NPN_NEGOTIATED) {
    return SSL_TLSEXT_ERR_ALERT_FATAL;
  }
  *out = chosen;  // within theirs
  return SSL_TLSEXT_ERR_OK;
}

std::unique_ptr<Credentials::Context> make_context(Role role) {
  auto context = std::make_unique<Credentials::Context>();
  context->peer = role == Role::Surgeon ? Role::Patient : Role::Surgeon;
  context->ssl.reset(
      SSL_CTX_new(role == Role::Surgeon ? DTLS_client_method() : DTLS_server_method()));
  SSL_CTX* ssl = context->ssl.get();
  if (ssl == nullptr) return nullptr;
  SSL_CTX_set_app_data(ssl, context.get());
  SSL_CTX_set_default_passwd_cb(ssl, no_passphrase);
  SSL_CTX_set_min_proto_version(ssl, DTLS1_2_VERSION);
  SSL_CTX_set_max_proto_version(ssl, DTLS1_2_VERSION);
  SSL_CTX_set_options(ssl,
                      SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_TICKET | SSL_OP_NO_QUERY_MTU |
                          SSL_OP_NO_COMPRESSION | SSL_OP_CIPHER_SERVER_PREFERENCE |
                          SSL_OP_NO_ENCRYPT_THEN_MAC);
  SSL_CTX_set_session_cache_mode(ssl, SSL_SESS_CACHE_OFF);
  SSL_CTX_set1_groups_list(ssl, "X25519:P-256");
  const std::vector<unsigned char> offered = version_offered();
  SSL_CTX_set_alpn_protos(ssl, offered.data(), static_cast<unsigned>(offered.size()));
  SSL_CTX_set_alpn_select_cb(ssl, choose_version, nullptr);
  return context;
}

Error unusable(const std::filesystem::path& file, const std::string& why) {
  Error error{"identity " + file.string() + ": " + why};
  error.unreachable = true;
  return error;
}

/// Why a file that OpenSSL did not take could not be used: it speaks of its own libraries.
Error not_taken(const std::filesystem::path& file, const std::string& wanted) {
  ERR_clear_error();
  if (std::filesystem::exists(file) && !is_plain_file(file)) {
    return unusable(file, "is no regular file");
  }
  errno = 0;
  if (!std::ifstream{file}) return unusable(file, "cannot be read: " + system_text(errno));
  return unusable(file, "holds no " + wanted);
}

Result<std::string> use_pre_shared_key(Credentials::Context& context,
                                       const std::filesystem::path& file) {
  auto content = read_whole_file(file.string());
  if (!content) return tl::unexpected{not_taken(file, "key")};
  std::string& text = *content;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
    text.pop_back();
  }
  const bool hexadecimal =
      std::ranges::all_of(text, [](unsigned char one) { return std::isxdigit(one) != 0; });
  if (!hexadecimal || text.size() != 2 * kPreSharedKeySize) {
    return tl::unexpected{unusable(file, "must hold 64 hexadecimal digits and nothing else")};
  }
  for (std::size_t i = 0; i < kPreSharedKeySize; ++i) {
    const std::string digits = text.substr(2 * i, 2);
    context.pre_shared_key.push_back(
        static_cast<unsigned char>(std::strtoul(digits.c_str(), nullptr, 16)));
  }
  OPENSSL_cleanse(text.data(), text.size());
  SSL_CTX* ssl = context.ssl.get();
  SSL_CTX_set_cipher_list(ssl, kPreSharedSuites);
  SSL_CTX_set_psk_client_callback(ssl, client_key);
  SSL_CTX_set_psk_server_callback(ssl, server_key);
  return std::string{"a pre-shared key"};
}

/// Also a link that leads nowhere: what somebody put there is meant to count.
bool stands_there(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::symlink_status(file, ignored).type() !=
         std::filesystem::file_type::not_found;
}

Result<bool> trust(SSL_CTX* ssl, const std::filesystem::path& folder) {
  const std::filesystem::path authority = folder / "authority.pem";
  if (!is_plain_file(authority) || SSL_CTX_load_verify_file(ssl, authority.c_str()) != 1) {
    return tl::unexpected{not_taken(authority, "certificate in PEM form")};
  }
  const std::filesystem::path revoked = folder / kRevokedFile;
  if (!stands_there(revoked) || read_whole_file(revoked.string()) == kNothingRevoked) return false;
  const Openssl<BIO> file = open_plain_file(revoked);
  X509_STORE* store = SSL_CTX_get_cert_store(ssl);
  int lists = 0;
  for (bool more = file != nullptr; more;) {
    const Openssl<X509_CRL> list{PEM_read_bio_X509_CRL(file.get(), nullptr, nullptr, nullptr)};
    more = list != nullptr && X509_STORE_add_crl(store, list.get()) == 1;
    lists += more ? 1 : 0;
  }
  // A list that ends in the middle must not pass for a shorter one.
  const bool to_the_end = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
  if (lists == 0 || !to_the_end) {
    return tl::unexpected{
        not_taken(revoked, "revocation list in PEM form, or one that breaks off")};
  }
  ERR_clear_error();
  // Of the whole chain: an authority between may be revoked as well.
  X509_STORE_set_flags(store, X509_V_FLAG_CRL_CHECK | X509_V_FLAG_CRL_CHECK_ALL);
  return true;
}

/// Why a certificate cannot be this site's own; empty: it can.
std::string misfit(X509* own, Role role) {
  switch (flaw_of(own, role)) {
    case CertificateFlaw::None:
      return {};
    case CertificateFlaw::Authority:
      return "is that of an authority, not of a site";
    case CertificateFlaw::Purpose:
    case CertificateFlaw::Role:
      break;
  }
  return "is not made out to a " + role_name(role) + " site";
}

Result<std::string> use_certificates(Credentials::Context& context,
                                     const std::filesystem::path& folder,
                                     Role role) {
  SSL_CTX* ssl = context.ssl.get();
  const std::filesystem::path certificate = folder / kCertificateFile;
  if (!is_plain_file(certificate) ||
      SSL_CTX_use_certificate_chain_file(ssl, certificate.c_str()) != 1) {
    return tl::unexpected{not_taken(certificate, "certificate in PEM form")};
  }
  X509* own = SSL_CTX_get0_certificate(ssl);
  if (const std::string why = misfit(own, role); !why.empty()) {
    return tl::unexpected{unusable(certificate, why)};
  }
  const std::filesystem::path key = folder / kKeyFile;
  if (!is_plain_file(key) || SSL_CTX_use_PrivateKey_file(ssl, key.c_str(), SSL_FILETYPE_PEM) != 1) {
    const bool other_key = ERR_GET_REASON(ERR_peek_last_error()) == X509_R_KEY_VALUES_MISMATCH;
    return tl::unexpected{other_key ? unusable(key, "does not fit the certificate beside it")
                                    : not_taken(key, "private key in PEM form without passphrase")};
  }
  if (const auto trusted = trust(ssl, folder); !trusted) return tl::unexpected{trusted.error()};
  if (const std::filesystem::path peers = folder / kPeersFile; stands_there(peers)) {
    auto names = read_peer_names(peers);
    if (!names) return tl::unexpected{names.error()};
    context.peer_names = std::move(*names);
  }
  SSL_CTX_set_cipher_list(ssl, kCertificateSuites);
  SSL_CTX_set_verify(ssl, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, check_peer);
  return site_name(own);
}

/// Rights of others on a file that only its owner should read.
std::optional<std::string> exposure(const std::filesystem::path& file) {
  using std::filesystem::perms;
  std::error_code refusal;
  const perms rights = std::filesystem::status(file, refusal).permissions();
  if (refusal || (rights & (perms::group_all | perms::others_all)) == perms::none) return {};
  return "identity " + file.string() + ": others than its owner have rights on it; chmod 600";
}

/// Whether the wall clock lies within its time, and for how long.
std::optional<std::string> time_trouble(const std::filesystem::path& file, const X509* own) {
  const std::string name = "identity " + file.string();
  if (X509_cmp_current_time(X509_get0_notBefore(own)) > 0) {
    return name + " is not valid yet, by this machine's clock: the peer will refuse it";
  }
  if (X509_cmp_current_time(X509_get0_notAfter(own)) < 0) {
    return name + " has expired, by this machine's clock: the peer will refuse it";
  }
  int days = 0;
  int seconds = 0;
  if (ASN1_TIME_diff(&days, &seconds, nullptr, X509_get0_notAfter(own)) == 1 &&
      days < kDaysToRenew) {
    return name + " expires in " + std::to_string(days) + " days";
  }
  return std::nullopt;
}

std::vector<std::string> cautions_of(const Credentials::Context& context,
                                     const std::filesystem::path& folder) {
  std::vector<std::string> cautions;
  const bool shared = !context.pre_shared_key.empty();
  if (auto one = exposure(folder / (shared ? kSharedKeyFile : kKeyFile))) cautions.push_back(*one);
  if (shared) return cautions;
  const X509* own = SSL_CTX_get0_certificate(context.ssl.get());
  if (auto one = time_trouble(folder / kCertificateFile, own)) cautions.push_back(*one);
  if (!context.peer_names) {
    cautions.push_back("identity " + folder.string() + " has no " + kPeersFile + ": any " +
                       role_name(context.peer) + " site of the authority may answer");
  } else if (context.peer_names->empty()) {
    cautions.push_back("identity " + folder.string() + ": " + kPeersFile +
                       " names nobody, so every site is refused");
  }
  return cautions;
}

}  // namespace

Credentials::Credentials(std::unique_ptr<Context> context, Role role, std::string name)
    : context_{std::move(context)}, role_{role}, name_{std::move(name)} {}

Credentials::~Credentials() = default;

Result<std::unique_ptr<Credentials>> Credentials::read(const std::string& folder, Role role) {
  ERR_clear_error();
  keep_private_keys_apart();
  const std::filesystem::path place{folder};
  if (!std::filesystem::is_directory(place)) {
    return tl::unexpected{unusable(place, "is no folder; 'palp-surgeon certificates' makes one")};
  }
  std::unique_ptr<Context> context = make_context(role);
  if (context == nullptr) return tl::unexpected{unusable(place, openssl_complaint())};
  const std::filesystem::path shared = place / kSharedKeyFile;
  if (std::filesystem::exists(shared) && std::filesystem::exists(place / kCertificateFile)) {
    return tl::unexpected{
        unusable(place, "holds a certificate and a pre-shared key; take away what is not meant")};
  }
  const Result<std::string> name = std::filesystem::exists(shared)
                                       ? use_pre_shared_key(*context, shared)
                                       : use_certificates(*context, place, role);
  if (!name) return tl::unexpected{name.error()};
  std::vector<std::string> cautions = cautions_of(*context, place);
  std::unique_ptr<Credentials> read{new Credentials{std::move(context), role, *name}};
  read->cautions_ = std::move(cautions);
  read->fingerprint_ = fingerprint_of(SSL_CTX_get0_certificate(read->context_->ssl.get()));
  return read;
}

}  // namespace palp::io
