#include "common/io/secure/site_certificate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <string_view>

#include <openssl/x509v3.h>

#include "common/core/byte_order_mark.h"
#include "common/core/whole_file.h"
#include "common/io/secure/openssl_handles.h"

namespace palp::io {
namespace {

using link::Role;

bool names_role(X509* certificate, Role role) {
  const Openssl<GENERAL_NAMES> names{static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr))};
  const std::string wanted = role_uri(role);
  for (int i = 0; names != nullptr && i < sk_GENERAL_NAME_num(names.get()); ++i) {
    const GENERAL_NAME* name = sk_GENERAL_NAME_value(names.get(), i);
    if (name->type != GEN_URI) continue;
    const ASN1_IA5STRING* uri = name->d.uniformResourceIdentifier;
    const std::string text{reinterpret_cast<const char*>(ASN1_STRING_get0_data(uri)),
                           static_cast<std::size_t>(ASN1_STRING_length(uri))};
    if (text == wanted) return true;
  }
  return false;
}

std::string trimmed(const std::string& line) {
  constexpr char kBlank[] = " \t\r";
  const std::size_t begin = line.find_first_not_of(kBlank);
  if (begin == std::string::npos) return {};
  return line.substr(begin, line.find_last_not_of(kBlank) + 1 - begin);
}

}  // namespace

std::string role_name(Role role) { return role == Role::Surgeon ? "surgeon" : "patient"; }

std::string role_uri(Role role) { return "palp:" + role_name(role); }

std::string site_name(const X509* certificate) {
  const X509_NAME* subject = X509_get_subject_name(certificate);
  const int first = X509_NAME_get_index_by_NID(subject, NID_commonName, -1);
  // Of two names nobody could tell which counts.
  if (first < 0 || X509_NAME_get_index_by_NID(subject, NID_commonName, first) >= 0) return {};
  const ASN1_STRING* text = X509_NAME_ENTRY_get_data(X509_NAME_get_entry(subject, first));
  std::string name{reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
                   static_cast<std::size_t>(ASN1_STRING_length(text))};
  std::ranges::replace_if(
      name, [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

std::string fingerprint_of(const X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (certificate == nullptr || X509_digest(certificate, EVP_sha256(), digest.data(), &size) != 1) {
    return {};
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * std::size_t{size});
  for (unsigned i = 0; i < size; ++i) {
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 15U];
  }
  return text;
}

CertificateFlaw flaw_of(X509* certificate, Role role) {
  const std::uint32_t flags = X509_get_extension_flags(certificate);
  const bool signs_others =
      (flags & EXFLAG_KUSAGE) != 0 && (X509_get_key_usage(certificate) & KU_KEY_CERT_SIGN) != 0;
  if ((flags & EXFLAG_CA) != 0 || signs_others) return CertificateFlaw::Authority;
  const std::uint32_t wanted = role == Role::Surgeon ? XKU_SSL_CLIENT : XKU_SSL_SERVER;
  if ((flags & EXFLAG_XKUSAGE) == 0 || (X509_get_extended_key_usage(certificate) & wanted) == 0) {
    return CertificateFlaw::Purpose;
  }
  return names_role(certificate, role) ? CertificateFlaw::None : CertificateFlaw::Role;
}

Result<std::set<std::string>> read_peer_names(const std::filesystem::path& file) {
  const auto text = read_whole_file(file.string());
  if (!text) return fail("identity", text.error());
  const std::string_view lines = without_byte_order_mark(*text);
  if (lines.find('\0') != std::string_view::npos || lines.starts_with("\xff\xfe") ||
      lines.starts_with("\xfe\xff")) {
    return fail("identity " + file.string() + ": is no list of names in ASCII, one a line");
  }
  std::set<std::string> names;
  std::istringstream in{std::string{lines}};
  for (std::string line; std::getline(in, line);) {
    const std::string name = trimmed(line.substr(0, line.find('#')));
    if (!name.empty()) names.insert(name);
  }
  return names;
}

}  // namespace palp::io
