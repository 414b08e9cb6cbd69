#include "common/io/secure/dtls_failure.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>

#include "common/link/codec_control.h"

namespace palp::io {
namespace {

constexpr char kTwoAuthorities[] =
    "these keys come from two different authorities: make both in one run of 'palp-surgeon "
    "certificates' and give each site its whole folder";
constexpr char kTwoKinds[] =
    "no shared cipher: one site has a certificate, the other a pre-shared key: give both a folder "
    "of the same run of "
    "'palp-surgeon certificates'";

}  // namespace

DtlsFailure failure_of_silence(bool certificates) {
  return {
      std::string{"no answer"} + (certificates ? "" : ", or another pre-shared key") +
          ": start the patient site there and let UDP through to its port (firewall, router), or"
          " let both sites meet at a relay (--through)",
      false,
      true};
}

std::string silence_in_room(const std::string& relay) {
  return "the other site does not answer by way of the relay at " + relay +
         ": start it there, with the same --room, and its folder from the same run of"
         " 'palp-surgeon certificates'";
}

/// A table of what people can do about it. The first three are what check_peer() in credentials.cc
/// sets.
DtlsFailure failure_of_certificate(long verdict) {
  switch (verdict) {
    case X509_V_ERR_APPLICATION_VERIFICATION:
      return {"the peer's certificate is made out to another role", true};
    case X509_V_ERR_INVALID_PURPOSE:
      return {"the peer's certificate is not one of a site", true};
    case X509_V_ERR_HOSTNAME_MISMATCH:
      return {"the peer's certificate bears a name that peers.txt does not list", true};
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
    case X509_V_ERR_CERT_SIGNATURE_FAILURE:
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
      return {kTwoAuthorities, true};
    case X509_V_ERR_CERT_REVOKED:
      return {"the peer's certificate is revoked: it needs a new one", true};
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return {
          "the peer's certificate has expired, by this machine's clock: set the clock, or make new "
          "ones with 'palp-surgeon certificates'",
          true};
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return {"the peer's certificate is not valid yet, by this machine's clock: set the clock",
              false};
    case X509_V_ERR_CRL_HAS_EXPIRED:
      return {"this site's revoked.pem has expired: 'palp-surgeon certificates' renews it", true};
    default:
      return {std::string{"the peer's certificate is refused: "} +
                  X509_verify_cert_error_string(verdict),
              false};
  }
}

std::string protocol_name() { return "palp/" + std::to_string(link::kProtocolVersion); }

DtlsFailure failure_of_version() {
  return {"the peer does not speak " + protocol_name() +
              ", the protocol of this program: install the same version of Palp at both sites",
          false};
}

DtlsFailure failure_of_handshake(unsigned long error) {
  switch (ERR_GET_REASON(error)) {
    case SSL_R_TLSV1_ALERT_UNKNOWN_CA:
    case SSL_R_TLSV1_ALERT_DECRYPT_ERROR:
      return {std::string{"the peer refuses this site: "} + kTwoAuthorities, false};
    case SSL_R_SSLV3_ALERT_CERTIFICATE_EXPIRED:
      return {
          "the peer refuses this site: certificate expired, by its clock; set the clocks, or make "
          "new ones with 'palp-surgeon certificates'",
          false};
    case SSL_R_SSLV3_ALERT_CERTIFICATE_REVOKED:
      return {"the peer refuses this site: its certificate is revoked and it needs a new one",
              false};
    case SSL_R_SSLV3_ALERT_BAD_CERTIFICATE:
    case SSL_R_SSLV3_ALERT_UNSUPPORTED_CERTIFICATE:
    case SSL_R_SSLV3_ALERT_CERTIFICATE_UNKNOWN:
      return {
          "the peer refuses this site's certificate: its own log says why; is it of this role and "
          "in the peer's peers.txt?",
          false};
    case SSL_R_NO_APPLICATION_PROTOCOL:
    case SSL_R_TLSV1_ALERT_NO_APPLICATION_PROTOCOL:
      return failure_of_version();
    case SSL_R_NO_SHARED_CIPHER:
    case SSL_R_SSLV3_ALERT_HANDSHAKE_FAILURE:
      return {kTwoKinds, false};
    default: {
      const char* reason = error == 0 ? nullptr : ERR_reason_error_string(error);
      return {reason == nullptr ? "no reason given" : reason, false};
    }
  }
}

}  // namespace palp::io
