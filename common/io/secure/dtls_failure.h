#pragma once

#include <string>

/// What OpenSSL says of a handshake that failed, in the words of whoever set up the two sites.
namespace palp::io {

struct DtlsFailure {
  std::string sentence;  ///< what is wrong and what helps; no full stop
  /// Found by this site's own look at the peer's certificate: the next attempt ends alike. What the
  /// peer only says about us is never that, since anybody can say it in its name.
  bool hopeless{};
  bool silent{};  ///< nothing came back
};

/// Nothing came back. `certificates`: else a pre-shared key, and another one is not answered
/// either.
[[nodiscard]] DtlsFailure failure_of_silence(bool certificates);
/// The same of the other site in a room of the relay at `relay`, in one whole sentence.
[[nodiscard]] std::string silence_in_room(const std::string& relay);
/// `verdict`: an X509_V_ERR_..., but not X509_V_OK, about the peer's certificate.
[[nodiscard]] DtlsFailure failure_of_certificate(long verdict);
/// How our protocol names itself in a handshake (RFC 7301): `palp/` and its version. Sites whose
/// names differ would not understand each other's first word.
[[nodiscard]] std::string protocol_name();
/// The peer offers or has chosen no version that we speak.
[[nodiscard]] DtlsFailure failure_of_version();
/// `error`: of OpenSSL's queue; 0: none.
[[nodiscard]] DtlsFailure failure_of_handshake(unsigned long error);

}  // namespace palp::io
