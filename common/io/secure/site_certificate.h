#pragma once

#include <filesystem>
#include <set>
#include <string>

#include <openssl/x509.h>

#include "common/core/result.h"
#include "common/link/telegram.h"

/// What a certificate must say to pass as a site's, beyond what OpenSSL looks at (signature,
/// authority, time, revocation). Thread: any.
namespace palp::io {

/// "palp:surgeon" or "palp:patient": a URI among the subject's alternative names.
[[nodiscard]] std::string role_uri(link::Role role);

/// "surgeon" or "patient".
[[nodiscard]] std::string role_name(link::Role role);

/// The common name, in which a site is known to others, a NUL within it included; what is not
/// printable ASCII becomes '?'. Empty: there is none, or more than one.
[[nodiscard]] std::string site_name(const X509* certificate);

/// SHA-256 of a certificate in hexadecimal digits; empty: it cannot be had.
[[nodiscard]] std::string fingerprint_of(const X509* certificate);

enum class CertificateFlaw { None, Authority, Purpose, Role };

/// A certificate of an authority is none of a site. One without extended key usage, or with the
/// other role's (client: surgeon, server: patient), was made for something else.
[[nodiscard]] CertificateFlaw flaw_of(X509* certificate, link::Role role);

/// The names of the sites that this one talks to, a line each; "#" begins a remark. The sentence of
/// an error names the file. A list that names nobody is one.
[[nodiscard]] Result<std::set<std::string>> read_peer_names(const std::filesystem::path& file);

}  // namespace palp::io
