#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "common/link/telegram.h"

namespace palp::io {

/// What a site proves itself with and trusts: read once from a folder.
///
///     certificate.pem    its own certificate, which names its role
///     key.pem            the private key of it
///     authority.pem      whoever signs the certificates of both sites
///     peers.txt          optional: the names of the sites that it talks to, a line each
///     revoked.pem        optional: revocation lists of that authority and of those between, or the
///                        words "nothing is revoked"
///
/// or, for a bench, `pre_shared_key.txt` alone: 64 hexadecimal digits, the same at both sites.
/// Immutable after construction. Thread: made by any, then io's.
class Credentials {
 public:
  /// The sentence names the file and what is wrong with it.
  [[nodiscard]] static Result<std::unique_ptr<Credentials>> read(const std::string& folder,
                                                                 link::Role role);
  ~Credentials();
  Credentials(const Credentials&) = delete;
  Credentials& operator=(const Credentials&) = delete;

  [[nodiscard]] link::Role role() const noexcept { return role_; }
  /// For people: the name in the own certificate, or "a pre-shared key".
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  /// SHA-256 of the own certificate, in hexadecimal digits; empty: a pre-shared key.
  [[nodiscard]] const std::string& fingerprint() const noexcept { return fingerprint_; }

  /// What its owner should know, in sentences: a key that others can read, a certificate that is
  /// not good now or not for long.
  [[nodiscard]] const std::vector<std::string>& cautions() const noexcept { return cautions_; }

  /// The settings of a DTLS endpoint (an SSL_CTX): keeps OpenSSL's types out of this header.
  struct Context;
  [[nodiscard]] Context& context() const noexcept { return *context_; }

 private:
  Credentials(std::unique_ptr<Context> context, link::Role role, std::string name);

  std::unique_ptr<Context> context_;
  link::Role role_;
  std::string name_;
  std::string fingerprint_;
  std::vector<std::string> cautions_;
};

}  // namespace palp::io
