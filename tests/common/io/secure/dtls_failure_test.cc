#include "common/io/secure/dtls_failure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>

namespace palp::io {
namespace {

using testing::HasSubstr;

TEST(DtlsFailureTest, TwoAuthoritiesAreNamedWithTheRemedy) {
  for (const long verdict :
       {X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY, X509_V_ERR_CERT_SIGNATURE_FAILURE}) {
    const DtlsFailure failure = failure_of_certificate(verdict);
    EXPECT_THAT(failure.sentence, HasSubstr("two different authorities"));
    EXPECT_THAT(failure.sentence, HasSubstr("palp-surgeon certificates"));
    EXPECT_TRUE(failure.hopeless);
  }
}

TEST(DtlsFailureTest, AClockThatMayStillBeSetIsNotHopeless) {
  EXPECT_FALSE(failure_of_certificate(X509_V_ERR_CERT_NOT_YET_VALID).hopeless);
}

TEST(DtlsFailureTest, WhatThePeerOnlySaysIsNeverHopeless) {
  for (const int reason : {SSL_R_TLSV1_ALERT_UNKNOWN_CA,
                           SSL_R_SSLV3_ALERT_CERTIFICATE_EXPIRED,
                           SSL_R_SSLV3_ALERT_CERTIFICATE_REVOKED,
                           SSL_R_SSLV3_ALERT_BAD_CERTIFICATE,
                           SSL_R_SSLV3_ALERT_HANDSHAKE_FAILURE,
                           SSL_R_NO_APPLICATION_PROTOCOL,
                           SSL_R_NO_SHARED_CIPHER}) {
    const DtlsFailure failure = failure_of_handshake(ERR_PACK(ERR_LIB_SSL, 0, reason));
    EXPECT_FALSE(failure.hopeless) << failure.sentence;
    EXPECT_THAT(failure.sentence, testing::Not(HasSubstr("alert")));
  }
}

TEST(DtlsFailureTest, SilenceSaysWhatToStartAndIsNeverHopeless) {
  const DtlsFailure failure = failure_of_silence(true);
  EXPECT_TRUE(failure.silent);
  EXPECT_FALSE(failure.hopeless);
  EXPECT_THAT(failure.sentence, HasSubstr("start the patient site"));
  EXPECT_THAT(silence_in_room("h:1"), HasSubstr("--room"));
  EXPECT_FALSE(failure_of_handshake(0).silent);
}

TEST(DtlsFailureTest, AnUnknownReasonKeepsItsWords) {
  EXPECT_EQ(failure_of_handshake(0).sentence, "no reason given");
  EXPECT_THAT(failure_of_certificate(X509_V_ERR_OUT_OF_MEM).sentence, HasSubstr("refused"));
}

}  // namespace
}  // namespace palp::io
