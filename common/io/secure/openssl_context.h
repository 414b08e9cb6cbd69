#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/io/secure/credentials.h"
#include "common/io/secure/openssl_handles.h"

namespace palp::io {

/// See Credentials. OpenSSL reaches it through the SSL_CTX's app data, so it does not move.
struct Credentials::Context {
  Openssl<SSL_CTX> ssl;
  link::Role peer{};
  std::optional<std::set<std::string>> peer_names;  ///< absent: any name
  std::vector<unsigned char> pre_shared_key;        ///< empty: certificates

  ~Context() { OPENSSL_cleanse(pre_shared_key.data(), pre_shared_key.size()); }
};

}  // namespace palp::io
