#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

/// Owners of what OpenSSL gives out. For the .cc files that speak OpenSSL only.
namespace palp::io {

struct FreeOpenssl {
  void operator()(SSL_CTX* one) const noexcept { SSL_CTX_free(one); }
  void operator()(SSL* one) const noexcept { SSL_free(one); }
  void operator()(BIO* one) const noexcept { BIO_free(one); }
  void operator()(BIO_METHOD* one) const noexcept { BIO_meth_free(one); }
  void operator()(BIO_ADDR* one) const noexcept { BIO_ADDR_free(one); }
  void operator()(BIGNUM* one) const noexcept { BN_free(one); }
  void operator()(X509* one) const noexcept { X509_free(one); }
  void operator()(X509_CRL* one) const noexcept { X509_CRL_free(one); }
  void operator()(X509_REVOKED* one) const noexcept { X509_REVOKED_free(one); }
  void operator()(ASN1_TIME* one) const noexcept { ASN1_TIME_free(one); }
  void operator()(X509_EXTENSION* one) const noexcept { X509_EXTENSION_free(one); }
  void operator()(GENERAL_NAMES* one) const noexcept { GENERAL_NAMES_free(one); }
  void operator()(EVP_PKEY* one) const noexcept { EVP_PKEY_free(one); }
};

template <class T>
using Openssl = std::unique_ptr<T, FreeOpenssl>;

/// OpenSSL opens a file and waits: of a pipe, for a writer that may never come.
inline bool is_plain_file(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored);
}

/// For reading; null: it is no regular file, or cannot be opened.
inline Openssl<BIO> open_plain_file(const std::filesystem::path& file) {
  return Openssl<BIO>{is_plain_file(file) ? BIO_new_file(file.c_str(), "r") : nullptr};
}

/// What OpenSSL complained of last on this thread, in its words; forgets all complaints.
inline std::string openssl_complaint() {
  const unsigned long error = ERR_peek_last_error();
  ERR_clear_error();
  const char* reason = error == 0 ? nullptr : ERR_reason_error_string(error);
  return reason == nullptr ? "no reason given" : reason;
}

}  // namespace palp::io
