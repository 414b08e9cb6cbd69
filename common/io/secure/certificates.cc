#include "common/io/secure/certificates.h"

#include <array>
#include <cerrno>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <unistd.h>

#include "common/core/whole_file.h"
#include "common/io/process/descriptor.h"
#include "common/io/process/system_text.h"
#include "common/io/secure/credentials.h"
#include "common/io/secure/openssl_handles.h"
#include "common/io/secure/site_certificate.h"

namespace palp::io {
namespace {

using std::filesystem::path;

constexpr int kAuthorityLife = 10;  // times that of a site's certificate
constexpr long kDay = 86'400;       // [s]
constexpr int kSerialBits = 127;    // positive, at most 20 octets (RFC 5280, 4.1.2.2)

struct Holder {
  Openssl<X509> certificate;
  Openssl<EVP_PKEY> key;
};

/// Of a call that fails only where OpenSSL is broken or memory is short.
void demand(bool done) {
  if (!done) throw std::runtime_error{"cannot make certificates: " + openssl_complaint()};
}

void write_file(const path& file, const std::string& text, mode_t mode) {
  std::error_code ignored;
  std::filesystem::remove(file, ignored);  // else its old rights would stay
  const Descriptor out{::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode)};
  if (!out.valid() ||
      ::write(out.number(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error{"cannot write " + file.string() + ": " + system_text(errno)};
  }
}

std::string text_of(const Openssl<BIO>& memory) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

template <class Writer>
std::string pem(Writer writer) {
  const Openssl<BIO> memory{BIO_new(BIO_s_mem())};
  demand(memory != nullptr && writer(memory.get()) == 1);
  return text_of(memory);
}

void write_certificate(const path& file, X509* certificate) {
  constexpr mode_t kForAll = 0644;
  write_file(file, pem([&](BIO* out) { return PEM_write_bio_X509(out, certificate); }), kForAll);
}

void write_key(const path& file, EVP_PKEY* key) {
  constexpr mode_t kForOwner = 0600;
  std::string text = pem([&](BIO* out) {
    return PEM_write_bio_PrivateKey(out, key, nullptr, nullptr, 0, nullptr, nullptr);
  });
  write_file(file, text, kForOwner);
  OPENSSL_cleanse(text.data(), text.size());
}

void extend(X509* certificate, X509* issuer, int what, const std::string& value) {
  X509V3_CTX context{};
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Openssl<X509_EXTENSION> extension{
      X509V3_EXT_conf_nid(nullptr, &context, what, value.c_str())};
  demand(extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1);
}

/// Key and certificate of `name`, not signed yet.
Holder holder_named(const std::string& name, long days) {
  Holder made{Openssl<X509>{X509_new()}, Openssl<EVP_PKEY>{EVP_EC_gen("P-256")}};
  const Openssl<BIGNUM> serial{BN_new()};
  X509* certificate = made.certificate.get();
  demand(certificate != nullptr && made.key != nullptr && serial != nullptr);
  demand(BN_rand(serial.get(), kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
         BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(certificate)) != nullptr);
  demand(X509_set_version(certificate, X509_VERSION_3) == 1 &&
         X509_set_pubkey(certificate, made.key.get()) == 1);
  // A day of grace behind: the clocks of two hospitals may differ.
  demand(X509_gmtime_adj(X509_getm_notBefore(certificate), -kDay) != nullptr &&
         X509_gmtime_adj(X509_getm_notAfter(certificate), kDay * days) != nullptr);
  const auto* text = reinterpret_cast<const unsigned char*>(name.data());
  demand(X509_NAME_add_entry_by_NID(X509_get_subject_name(certificate),
                                    NID_commonName,
                                    MBSTRING_UTF8,
                                    text,
                                    static_cast<int>(name.size()),
                                    -1,
                                    0) == 1);
  return made;
}

void sign(X509* certificate, const Holder& authority) {
  demand(X509_set_issuer_name(certificate, X509_get_subject_name(authority.certificate.get())) ==
             1 &&
         X509_sign(certificate, authority.key.get(), EVP_sha256()) != 0);
}

Holder new_authority(const CertificatesConfig& config, const path& folder) {
  Holder authority = holder_named(config.name + " authority", long{kAuthorityLife} * config.days);
  X509* certificate = authority.certificate.get();
  extend(certificate, certificate, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  extend(certificate, certificate, NID_key_usage, "critical,keyCertSign,cRLSign");
  extend(certificate, certificate, NID_subject_key_identifier, "hash");
  sign(certificate, authority);
  std::filesystem::create_directories(folder);
  write_key(folder / "key.pem", authority.key.get());
  write_certificate(folder / "certificate.pem", certificate);
  return authority;
}

Holder read_holder(const path& folder) {
  const Openssl<BIO> certificate = open_plain_file(folder / "certificate.pem");
  const Openssl<BIO> key = open_plain_file(folder / "key.pem");
  Holder read;
  if (certificate != nullptr && key != nullptr) {
    read.certificate.reset(PEM_read_bio_X509(certificate.get(), nullptr, nullptr, nullptr));
    read.key.reset(PEM_read_bio_PrivateKey(key.get(), nullptr, nullptr, nullptr));
  }
  if (read.certificate == nullptr || read.key == nullptr ||
      X509_check_private_key(read.certificate.get(), read.key.get()) != 1) {
    ERR_clear_error();
    throw std::runtime_error{folder.string() + " holds no certificate and key that fit"};
  }
  return read;
}

/// A site that got new keys still refuses what was revoked before, also from a new folder.
void copy_revocations(const path& authority, const path& site) {
  if (!std::filesystem::exists(authority / "revoked.pem")) return;
  std::filesystem::copy_file(authority / "revoked.pem",
                             site / "revoked.pem",
                             std::filesystem::copy_options::overwrite_existing);
}

std::string name_of(const CertificatesConfig& config, link::Role role) {
  return config.name + " " + role_name(role) + " site";
}

/// What is on the list stays: a site may talk to others as well.
void add_peer(const path& file, const std::string& name) {
  std::string text = "# The sites that this one talks to: names as in their certificates.\n";
  if (std::filesystem::exists(file)) {
    const auto names = read_peer_names(file);
    if (!names) throw std::runtime_error{names.error().text};
    if (names->contains(name)) return;
    text = read_whole_file(file.string()).value_or("");
    if (!text.empty() && text.back() != '\n') text += '\n';
  }
  constexpr mode_t kForAll = 0644;
  write_file(file, text + name + "\n", kForAll);
}

void make_site(const CertificatesConfig& config, const Holder& authority, link::Role role) {
  const bool surgeon = role == link::Role::Surgeon;
  const link::Role peer = surgeon ? link::Role::Patient : link::Role::Surgeon;
  const Holder made = holder_named(name_of(config, role), config.days);
  X509* certificate = made.certificate.get();
  X509* issuer = authority.certificate.get();
  extend(certificate, issuer, NID_basic_constraints, "critical,CA:FALSE");
  extend(certificate, issuer, NID_key_usage, "critical,digitalSignature");
  extend(certificate, issuer, NID_ext_key_usage, surgeon ? "clientAuth" : "serverAuth");
  extend(certificate, issuer, NID_subject_alt_name, "URI:" + role_uri(role));
  extend(certificate, issuer, NID_authority_key_identifier, "keyid:always");
  sign(certificate, authority);
  const path folder = path{config.folder} / role_name(role);
  std::filesystem::create_directories(folder);
  write_key(folder / "key.pem", made.key.get());
  write_certificate(folder / "certificate.pem", certificate);
  write_certificate(folder / "authority.pem", authority.certificate.get());
  add_peer(folder / "peers.txt", name_of(config, peer));
  copy_revocations(path{config.folder} / "authority", folder);
}

/// A site proves itself in one way: with both in its folder nobody could tell which holds.
void demand_none(const path& file, const char* what) {
  if (std::filesystem::exists(file)) {
    throw std::runtime_error{file.string() + " is there already: " + what +
                             " need a folder of their own"};
  }
}

/// A list that another authority signed makes a site refuse all of its peers.
void demand_no_old_list(const CertificatesConfig& config) {
  for (const char* place : {"authority", "surgeon", "patient"}) {
    const path file = path{config.folder} / place / "revoked.pem";
    if (!std::filesystem::exists(file)) continue;
    throw std::runtime_error{file.string() + " is of an authority that is not here any more: put " +
                             (path{config.folder} / "authority").string() +
                             " back, or make certificates in a new folder"};
  }
}

/// What is thrown here, as a sentence.
template <class Work>
Result<std::string> told(Work work) {
  try {
    return work();
  } catch (const std::exception& error) {  // filesystem_error among them
    Error sentence{error.what()};
    sentence.unreachable = true;
    return tl::unexpected{sentence};
  }
}

/// The authority's list so far, or an empty one. A list that cannot be read is not begun anew: all
/// that was revoked would be good again.
Openssl<X509_CRL> revocation_list(const path& file, const Holder& authority) {
  const bool there = std::filesystem::exists(file);
  const Openssl<BIO> in = open_plain_file(file);
  Openssl<X509_CRL> list{
      in == nullptr ? nullptr : PEM_read_bio_X509_CRL(in.get(), nullptr, nullptr, nullptr)};
  ERR_clear_error();
  if (list != nullptr && X509_CRL_verify(list.get(), authority.key.get()) == 1) return list;
  ERR_clear_error();
  if (there) {
    throw std::runtime_error{file.string() +
                             " is no list of this authority's; put back a copy of it"};
  }
  list.reset(X509_CRL_new());
  demand(list != nullptr && X509_CRL_set_version(list.get(), X509_CRL_VERSION_2) == 1 &&
         X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(authority.certificate.get())) ==
             1);
  return list;
}

std::string revoke(const CertificatesConfig& config, const std::string& certificate) {
  const path folder{config.folder};
  const Holder authority = read_holder(folder / "authority");
  const Openssl<BIO> in = open_plain_file(certificate);
  const Openssl<X509> revoked{
      in == nullptr ? nullptr : PEM_read_bio_X509(in.get(), nullptr, nullptr, nullptr)};
  ERR_clear_error();
  if (revoked == nullptr) throw std::runtime_error{certificate + " holds no certificate"};
  const bool ours = X509_verify(revoked.get(), authority.key.get()) == 1;
  ERR_clear_error();
  if (X509_cmp(revoked.get(), authority.certificate.get()) == 0) {
    throw std::runtime_error{certificate +
                             " is the authority's own, which no list of its own can "
                             "revoke; make new certificates in another folder"};
  }
  if (!ours) {
    throw std::runtime_error{certificate + " was not made by the authority in " +
                             (folder / "authority").string()};
  }
  const path file = folder / "authority" / "revoked.pem";
  const Openssl<X509_CRL> list = revocation_list(file, authority);
  const Openssl<ASN1_TIME> now{X509_gmtime_adj(nullptr, 0)};
  const Openssl<ASN1_TIME> next{X509_gmtime_adj(nullptr, kDay * kAuthorityLife * config.days)};
  Openssl<X509_REVOKED> entry{X509_REVOKED_new()};
  demand(now != nullptr && next != nullptr && entry != nullptr);
  demand(X509_REVOKED_set_serialNumber(entry.get(), X509_get_serialNumber(revoked.get())) == 1 &&
         X509_REVOKED_set_revocationDate(entry.get(), now.get()) == 1 &&
         X509_CRL_add0_revoked(list.get(), entry.release()) == 1);
  demand(X509_CRL_set1_lastUpdate(list.get(), now.get()) == 1 &&
         X509_CRL_set1_nextUpdate(list.get(), next.get()) == 1 && X509_CRL_sort(list.get()) == 1 &&
         X509_CRL_sign(list.get(), authority.key.get(), EVP_sha256()) != 0);
  const std::string text = pem([&](BIO* out) { return PEM_write_bio_X509_CRL(out, list.get()); });
  constexpr mode_t kForAll = 0644;
  std::string lists;
  for (const char* place : {"authority", "surgeon", "patient"}) {
    if (!std::filesystem::is_directory(folder / place)) continue;
    const path list_there = folder / place / "revoked.pem";
    write_file(list_there, text, kForAll);
    lists += (lists.empty() ? "" : ", ") + list_there.string();
  }
  return "revoked " + certificate + ": the list is now in " + lists +
         "; copy it into the folder that each site uses, and start the site anew";
}

}  // namespace

Result<std::string> make_certificates(const CertificatesConfig& config) {
  return told([&] {
    for (const char* site : {"surgeon", "patient"}) {
      demand_none(path{config.folder} / site / "pre_shared_key.txt", "certificates");
    }
    const path folder = path{config.folder} / "authority";
    const bool there = std::filesystem::exists(folder / "key.pem");
    if (!there) demand_no_old_list(config);
    const Holder authority = there ? read_holder(folder) : new_authority(config, folder);
    make_site(config, authority, link::Role::Surgeon);
    make_site(config, authority, link::Role::Patient);
    return std::string{there ? "with the authority that was there, " : "an authority, "} +
           "certificates and keys for both sites, good for " + std::to_string(config.days) +
           " days: " + (path{config.folder} / "surgeon").string() + " and " +
           (path{config.folder} / "patient").string();
  });
}

Result<std::string> revoke_certificate(const CertificatesConfig& config,
                                       const std::string& certificate) {
  return told([&] { return revoke(config, certificate); });
}

Result<std::string> make_pre_shared_key(const std::string& folder) {
  return told([&] {
    for (const char* site : {"surgeon", "patient"}) {
      demand_none(path{folder} / site / "certificate.pem", "pre-shared keys");
    }
    std::array<unsigned char, 32> key{};
    demand(RAND_bytes(key.data(), key.size()) == 1);
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : key) {
      text += kDigits[byte >> 4U];
      text += kDigits[byte & 0xFU];
    }
    for (const char* site : {"surgeon", "patient"}) {
      std::filesystem::create_directories(path{folder} / site);
      constexpr mode_t kForOwner = 0600;
      write_file(path{folder} / site / "pre_shared_key.txt", text + "\n", kForOwner);
    }
    OPENSSL_cleanse(key.data(), key.size());
    OPENSSL_cleanse(text.data(), text.size());
    return "a key for a bench, the same in both: " + (path{folder} / "surgeon").string() + " and " +
           (path{folder} / "patient").string();
  });
}

}  // namespace palp::io
