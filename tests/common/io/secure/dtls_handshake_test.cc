// Goal: a handshake comes about between the right two only, whatever the network loses.
// Method: both ends in one thread, datagrams passed by hand; real certificates.
#include "common/io/secure/dtls_handshake.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include "common/core/random.h"
#include "common/io/secure/openssl_context.h"
#include "common/io/secure/openssl_handles.h"
#include "tests/common/io/net/loopback.h"
#include "tests/common/io/secure/keys_folder.h"

namespace palp::io {
namespace {

using link::Role;
using test::KeysFolder;
using testing::AnyOf;
using testing::HasSubstr;
using State = DtlsHandshake::State;

const Endpoint kSurgeonAt = *resolve_endpoint("127.0.0.1:1000");

/// A surgeon that calls and a patient that listens.
class Pair {
 public:
  Pair(const Credentials& surgeon, const Credentials& patient)
      : surgeon_{surgeon}, listener_{patient} {}

  /// Passes what either says until nobody says anything.
  void pass() {
    for (int round = 0; round < 20; ++round) {
      bool quiet = true;
      for (const DtlsDatagram& one : surgeon_.take_datagrams()) {
        quiet = false;
        to_patient(one);
      }
      if (patient_) {
        for (const DtlsDatagram& one : patient_->take_datagrams()) answers_.push_back(one);
      }
      for (const DtlsDatagram& one : std::exchange(answers_, {})) {
        quiet = false;
        sizes_.push_back(one.size());
        surgeon_.hear(one);
      }
      if (quiet) return;
    }
  }
  void to_patient(std::span<const std::byte> datagram) {
    sizes_.push_back(datagram.size());
    if (patient_) {
      patient_->hear(datagram);
      return;
    }
    DtlsListener::Answer answer = listener_.hear(datagram, kSurgeonAt, TimePoint{});
    answers_ = std::move(answer.datagrams);
    if (answer.handshake) patient_.emplace(std::move(*answer.handshake));
  }
  DtlsHandshake surgeon_;
  DtlsListener listener_;
  std::optional<DtlsHandshake> patient_;
  std::vector<DtlsDatagram> answers_;
  std::vector<std::size_t> sizes_;
};

TEST(DtlsHandshakeTest, BothEndsGetTheSameKeysAndKnowEachOther) {
  for (const bool bench : {false, true}) {
    const KeysFolder keys{"handshake", bench};
    const auto surgeon = keys.credentials(Role::Surgeon);
    const auto patient = keys.credentials(Role::Patient);
    Pair pair{*surgeon, *patient};
    pair.pass();
    ASSERT_EQ(pair.surgeon_.state(), State::Done) << pair.surgeon_.failure().sentence;
    ASSERT_EQ(pair.patient_->state(), State::Done) << pair.patient_->failure().sentence;
    const auto ours = pair.surgeon_.take_result();
    const auto theirs = pair.patient_->take_result();
    EXPECT_EQ(ours->keys.data.send.key, theirs->keys.data.receive.key);
    EXPECT_EQ(ours->keys.control.receive.key, theirs->keys.control.send.key);
    EXPECT_EQ(ours->keys.send_connection, theirs->keys.receive_connection);
    EXPECT_EQ(ours->peer_name, bench ? "a pre-shared key" : "test patient site");
    EXPECT_EQ(theirs->peer_name, bench ? "a pre-shared key" : "test surgeon site");
    EXPECT_LE(*std::ranges::max_element(pair.sizes_), 1200U);
  }
}

TEST(DtlsHandshakeTest, EachHandshakeHasKeysOfItsOwn) {
  const KeysFolder keys{"handshake"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  Pair first{*surgeon, *patient};
  Pair second{*surgeon, *patient};
  first.pass();
  second.pass();
  EXPECT_FALSE(first.surgeon_.take_result()->keys.data.send.key ==
               second.surgeon_.take_result()->keys.data.send.key);
}

/// Both ends; the sentence of whoever refused, or of both.
std::string refusal(const Credentials& surgeon, const Credentials& patient) {
  Pair pair{surgeon, patient};
  pair.pass();
  const bool refused = pair.surgeon_.state() == State::Failed ||
                       (pair.patient_ && pair.patient_->state() == State::Failed);
  EXPECT_TRUE(refused);
  EXPECT_FALSE(pair.patient_ && pair.patient_->state() == State::Done) << "the stage would move";
  return pair.surgeon_.failure().sentence + " | " +
         (pair.patient_ ? pair.patient_->failure().sentence : "");
}

TEST(DtlsHandshakeTest, ACertificateOfAnotherAuthorityIsRefused) {
  const KeysFolder ours{"ours"};
  const KeysFolder theirs{"theirs"};
  EXPECT_THAT(refusal(*theirs.credentials(Role::Surgeon), *ours.credentials(Role::Patient)),
              HasSubstr("certificate"));
  // A surgeon who trusts both but is signed by the other: the patient has the last word.
  std::filesystem::copy_file(ours.site(Role::Patient) / "authority.pem",
                             theirs.site(Role::Surgeon) / "authority.pem",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(refusal(*theirs.credentials(Role::Surgeon), *ours.credentials(Role::Patient)),
              HasSubstr("two different authorities"));
}

TEST(DtlsHandshakeTest, ASelfSignedCertificateIsRefused) {
  const KeysFolder keys{"ours"};
  const KeysFolder own{"own"};
  // It even has the right role, for it is its own authority.
  const auto surgeon = own.site(Role::Surgeon);
  std::filesystem::copy_file(keys.site(Role::Patient) / "authority.pem",
                             surgeon / "authority.pem",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(refusal(*own.credentials(Role::Surgeon), *keys.credentials(Role::Patient)),
              HasSubstr("two different authorities"));
}

/// Credentials in `role` with the certificate and key of the other site.
void swap_in(const KeysFolder& keys, Role role, Role certificate_of) {
  for (const char* file : {"certificate.pem", "key.pem"}) {
    std::filesystem::copy_file(keys.site(certificate_of) / file,
                               keys.site(role) / file,
                               std::filesystem::copy_options::overwrite_existing);
  }
}

TEST(DtlsHandshakeTest, ASiteRefusesToStartWithACertificateOfTheOtherRole) {
  const KeysFolder keys{"role"};
  swap_in(keys, Role::Surgeon, Role::Patient);
  const auto read = Credentials::read(keys.site(Role::Surgeon), Role::Surgeon);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().text, HasSubstr("is not made out to a surgeon site"));
}

TEST(DtlsHandshakeTest, RightAuthorityButWrongRoleIsRefused) {
  const KeysFolder keys{"role"};
  const auto patient = keys.credentials(Role::Patient);
  // A program of the attacker's does not check itself: the certificate is swapped in later.
  const auto surgeon = keys.credentials(Role::Surgeon);
  SSL_CTX* context = surgeon->context().ssl.get();
  const auto folder = keys.site(Role::Patient);
  ASSERT_EQ(SSL_CTX_use_certificate_chain_file(context, (folder / "certificate.pem").c_str()), 1);
  ASSERT_EQ(SSL_CTX_use_PrivateKey_file(context, (folder / "key.pem").c_str(), SSL_FILETYPE_PEM),
            1);
  EXPECT_THAT(refusal(*surgeon, *patient), HasSubstr("not one of a site"));
}

TEST(DtlsHandshakeTest, ASiteThatIsNotOnTheListIsRefusedAndWithoutAListAnyIsTaken) {
  const KeysFolder keys{"names"};
  CertificatesConfig other = keys.config();
  other.name = "elsewhere";
  const auto here = keys.credentials(Role::Surgeon);
  ASSERT_TRUE(make_certificates(other));  // of the same authority
  const auto patient = keys.credentials(Role::Patient);
  EXPECT_THAT(refusal(*here, *patient), HasSubstr("a name that peers.txt does not list"));
  here->context().peer_names.reset();
  Pair pair{*here, *patient};
  pair.pass();
  EXPECT_EQ(pair.surgeon_.state(), State::Done) << pair.surgeon_.failure().sentence;
}

using Extensions = std::vector<std::pair<int, std::string>>;

/// Gives a site another key, and a certificate of the authority in `folder` with these extensions.
void swap_certificate(const Credentials& site,
                      const std::filesystem::path& folder,
                      const std::string& name,
                      const Extensions& extensions) {
  const Openssl<BIO> file{BIO_new_file((folder / "key.pem").c_str(), "r")};
  const Openssl<EVP_PKEY> authority{PEM_read_bio_PrivateKey(file.get(), nullptr, nullptr, nullptr)};
  const Openssl<BIO> signer{BIO_new_file((folder / "certificate.pem").c_str(), "r")};
  const Openssl<X509> issuer{PEM_read_bio_X509(signer.get(), nullptr, nullptr, nullptr)};
  const Openssl<EVP_PKEY> key{EVP_EC_gen("P-256")};
  const Openssl<X509> made{X509_new()};
  X509_set_version(made.get(), X509_VERSION_3);
  X509_set_pubkey(made.get(), key.get());
  X509_gmtime_adj(X509_getm_notBefore(made.get()), -60);
  X509_gmtime_adj(X509_getm_notAfter(made.get()), 3600);
  X509_NAME_add_entry_by_txt(X509_get_subject_name(made.get()),
                             "CN",
                             MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()),
                             -1,
                             -1,
                             0);
  X509_set_issuer_name(made.get(), X509_get_subject_name(issuer.get()));
  for (const auto& [what, value] : extensions) {
    const Openssl<X509_EXTENSION> extension{
        X509V3_EXT_conf_nid(nullptr, nullptr, what, value.c_str())};
    ASSERT_NE(extension, nullptr) << value;
    X509_add_ext(made.get(), extension.get(), -1);
  }
  ASSERT_NE(X509_sign(made.get(), authority.get(), EVP_sha256()), 0);
  SSL_CTX* context = site.context().ssl.get();
  ASSERT_EQ(SSL_CTX_use_certificate(context, made.get()), 1);
  ASSERT_EQ(SSL_CTX_use_PrivateKey(context, key.get()), 1);
}

/// The surgeon's refusal of a patient whose certificate was made with other extensions.
std::string refusal_of_patient_with(const Extensions& extensions) {
  const KeysFolder keys{"extensions"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  swap_certificate(*patient, keys.path() / "authority", "test patient site", extensions);
  Pair pair{*surgeon, *patient};
  pair.pass();
  EXPECT_EQ(pair.surgeon_.state() == State::Done, pair.surgeon_.failure().sentence.empty());
  return pair.surgeon_.failure().sentence;
}

TEST(DtlsHandshakeTest, AListThatCannotBeReadToItsEndStopsASite) {
  const KeysFolder keys{"broken-lists"};
  const auto folder = keys.site(Role::Patient);
  ASSERT_TRUE(revoke_certificate(keys.config(), keys.site(Role::Surgeon) / "certificate.pem"));
  const auto list = folder / "revoked.pem";
  const auto size = std::filesystem::file_size(list);
  std::ifstream in{list};
  const std::string whole{std::istreambuf_iterator<char>{in}, {}};
  std::ofstream{list, std::ios::app} << whole;
  EXPECT_TRUE(Credentials::read(folder, Role::Patient)) << "two whole lists";
  std::filesystem::resize_file(list, 2 * size - 60);
  EXPECT_FALSE(Credentials::read(folder, Role::Patient)) << "one and a part";
  for (const char* name : {"revoked.pem", "peers.txt"}) {
    std::filesystem::remove(folder / "revoked.pem");
    std::filesystem::remove(folder / "peers.txt");
    EXPECT_TRUE(Credentials::read(folder, Role::Patient));
    std::filesystem::create_symlink("nowhere", folder / name);
    EXPECT_FALSE(Credentials::read(folder, Role::Patient)) << name << " leads nowhere";
  }
}

TEST(DtlsHandshakeTest, WhatAnAuthorityMadeForSomethingElseIsRefused) {
  const std::pair<int, std::string> site{NID_subject_alt_name, "URI:palp:patient"};
  const std::pair<int, std::string> server{NID_ext_key_usage, "serverAuth"};
  EXPECT_THAT(refusal_of_patient_with({site}), HasSubstr("not one of a site"));
  EXPECT_THAT(refusal_of_patient_with({site, server, {NID_basic_constraints, "CA:TRUE"}}),
              HasSubstr("not one of a site"));
  const std::pair<int, std::string> signs{NID_key_usage, "digitalSignature,keyCertSign"};
  EXPECT_THAT(refusal_of_patient_with({site, server, signs}), HasSubstr("not one of a site"));
  EXPECT_THAT(refusal_of_patient_with({server}), HasSubstr("another role"));
  EXPECT_EQ(refusal_of_patient_with({site, server}), "");
}

TEST(DtlsHandshakeTest, AnExpiredCertificateIsRefused) {
  const KeysFolder keys{"expired"};
  CertificatesConfig config = keys.config();
  config.days = -1;  // ends as it begins, a day ago
  ASSERT_TRUE(make_certificates(config));
  EXPECT_THAT(refusal(*keys.credentials(Role::Surgeon), *keys.credentials(Role::Patient)),
              HasSubstr("expired"));
}

TEST(DtlsHandshakeTest, ARevokedCertificateIsRefusedAndANewOneAccepted) {
  const KeysFolder keys{"revoked"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  ASSERT_TRUE(revoke_certificate(keys.config(), keys.site(Role::Surgeon) / "certificate.pem"));
  EXPECT_THAT(refusal(*surgeon, *keys.credentials(Role::Patient)), HasSubstr("revoked"));
  ASSERT_TRUE(make_certificates(keys.config()));
  const auto renewed = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  Pair pair{*renewed, *patient};
  pair.pass();
  EXPECT_EQ(pair.surgeon_.state(), State::Done) << pair.surgeon_.failure().sentence;
}

TEST(DtlsHandshakeTest, AnotherPreSharedKeyIsRefused) {
  const KeysFolder ours{"psk-ours", true};
  const KeysFolder theirs{"psk-theirs", true};
  const auto surgeon = theirs.credentials(Role::Surgeon);
  const auto patient = ours.credentials(Role::Patient);
  Pair pair{*surgeon, *patient};
  pair.pass();
  // Neither can read what the other says last; they give up when they have repeated it in vain.
  EXPECT_NE(pair.surgeon_.state(), State::Done);
  ASSERT_TRUE(pair.patient_);
  EXPECT_NE(pair.patient_->state(), State::Done);
}

TEST(DtlsHandshakeTest, NoCertificateAtAllIsRefused) {
  const KeysFolder keys{"none"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  SSL_CTX_clear_chain_certs(surgeon->context().ssl.get());
  // A context like the surgeon's without certificate.
  surgeon->context().ssl.reset(SSL_CTX_new(DTLS_client_method()));
  SSL_CTX_set_cipher_list(surgeon->context().ssl.get(), "ECDHE-ECDSA-AES256-GCM-SHA384");
  EXPECT_THAT(refusal(*surgeon, *keys.credentials(Role::Patient)),
              HasSubstr("peer did not return a certificate"));
}

/// Of a client that offers what we do not.
std::string refused_offer(const std::function<void(SSL_CTX*)>& change) {
  const KeysFolder keys{"downgrade"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  change(surgeon->context().ssl.get());
  return refusal(*surgeon, *patient);
}

TEST(DtlsHandshakeTest, WeakSuitesAndOldVersionsAreRefused) {
  EXPECT_THAT(refused_offer([](SSL_CTX* context) {
                SSL_CTX_set_security_level(context, 0);
                SSL_CTX_set_min_proto_version(context, DTLS1_VERSION);
                SSL_CTX_set_max_proto_version(context, DTLS1_VERSION);
                SSL_CTX_set_cipher_list(context, "ALL:@SECLEVEL=0");
              }),
              HasSubstr("version"));
  for (const char* suites : {"eNULL:@SECLEVEL=0",
                             "aNULL:@SECLEVEL=0",
                             "ECDHE-ECDSA-AES256-SHA384:@SECLEVEL=0",
                             "ECDHE-ECDSA-AES256-SHA:@SECLEVEL=0",
                             "AES256-GCM-SHA384:@SECLEVEL=0",
                             "ECDHE-ECDSA-AES128-GCM-SHA256"}) {
    EXPECT_THAT(refused_offer([suites](SSL_CTX* context) {
                  EXPECT_EQ(SSL_CTX_set_cipher_list(context, suites), 1) << suites;
                }),
                AnyOf(HasSubstr("no shared cipher"), HasSubstr("handshake failure")))
        << suites;
  }
}

TEST(DtlsHandshakeTest, APeerWithoutExtendedMasterSecretIsRefused) {
  EXPECT_THAT(refused_offer([](SSL_CTX* context) {
                SSL_CTX_set_options(context, SSL_OP_NO_EXTENDED_MASTER_SECRET);
              }),
              HasSubstr("extended master secret"));
}

TEST(DtlsHandshakeTest, APeerOfAnotherVersionIsToldApartInWords) {
  constexpr std::array<unsigned char, 7> kOther{6, 'p', 'a', 'l', 'p', '/', '0'};
  for (const unsigned offered : {7U, 0U}) {  // none: before versions had names
    EXPECT_THAT(refused_offer([&](SSL_CTX* context) {
                  SSL_CTX_set_alpn_protos(context, kOther.data(), offered);
                }),
                HasSubstr("does not speak " + protocol_name()));
  }
}

TEST(DtlsHandshakeTest, AnEditedHelloEndsInNoKeys) {
  const KeysFolder keys{"edited"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  // Bits all over the second ClientHello, which the Finished messages cover.
  bool edited = true;
  for (std::size_t bit = 8 * 13; edited; bit += 37) {
    edited = false;
    Pair pair{*surgeon, *patient};
    int sent = 0;
    for (int round = 0; round < 6; ++round) {
      for (DtlsDatagram& one : pair.surgeon_.take_datagrams()) {
        if (++sent == 2 && bit / 8 < one.size()) {
          one[bit / 8] ^= std::byte{1} << bit % 8;
          edited = true;
        }
        pair.to_patient(one);
      }
      if (pair.patient_) {
        for (auto& one : pair.patient_->take_datagrams()) pair.answers_.push_back(std::move(one));
      }
      for (const auto& one : std::exchange(pair.answers_, {})) pair.surgeon_.hear(one);
    }
    if (!edited) break;  // beyond its end
    EXPECT_NE(pair.surgeon_.state(), State::Done) << "bit " << bit;
    EXPECT_FALSE(pair.patient_ && pair.patient_->state() == State::Done) << "bit " << bit;
  }
}

TEST(DtlsListenerTest, AClientHelloWithoutCookieCostsNothingAndIsAnsweredWithLess) {
  const KeysFolder keys{"cookie"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  DtlsListener listener{*patient};
  for (int i = 0; i < 100; ++i) {
    DtlsHandshake caller{*surgeon};
    const auto hello = caller.take_datagrams();
    ASSERT_EQ(hello.size(), 1U);
    const auto answer = listener.hear(hello[0], kSurgeonAt, TimePoint{});
    EXPECT_FALSE(answer.handshake);
    ASSERT_EQ(answer.datagrams.size(), 1U);
    EXPECT_LT(2 * answer.datagrams[0].size(), hello[0].size());
  }
}

TEST(DtlsListenerTest, ACookieIsGoodForItsAddressOnlyAndNotForLong) {
  const KeysFolder keys{"cookie"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  DtlsListener listener{*patient};
  DtlsHandshake caller{*surgeon};
  const auto hello = caller.take_datagrams();
  caller.hear(listener.hear(hello[0], kSurgeonAt, TimePoint{}).datagrams.at(0));
  const auto second = caller.take_datagrams();
  ASSERT_EQ(second.size(), 1U);
  const Endpoint elsewhere = *resolve_endpoint("127.0.0.1:1001");
  EXPECT_FALSE(listener.hear(second[0], elsewhere, TimePoint{}).handshake);
  const TimePoint next_minute = TimePoint{} + std::chrono::seconds{61};
  const TimePoint later = TimePoint{} + std::chrono::seconds{122};
  DtlsListener::Answer answer = listener.hear(second[0], kSurgeonAt, next_minute);
  EXPECT_TRUE(answer.handshake) << "it was on its way while the secret was renewed";
  EXPECT_FALSE(listener.hear(second[0], kSurgeonAt, later).handshake);
}

TEST(DtlsListenerTest, JunkThatLooksLikeAClientHelloIsSurvived) {
  const KeysFolder keys{"junk"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  DtlsListener listener{*patient};
  DtlsHandshake caller{*surgeon};
  const DtlsDatagram hello = caller.take_datagrams().at(0);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    DtlsDatagram junk = hello;
    for (std::uint64_t k = 0; k < 1 + i % 8; ++k) {
      junk[random_bits(i, 1, k) % junk.size()] ^= static_cast<std::byte>(random_bits(i, 2, k));
    }
    if (i % 3 == 0) junk.resize(random_bits(i, 3, 0) % junk.size());
    const auto answer = listener.hear(junk, kSurgeonAt, TimePoint{});
    EXPECT_FALSE(answer.handshake);
    for (const auto& one : answer.datagrams) EXPECT_LE(one.size(), junk.size());
  }
  Pair pair{*surgeon, *patient};
  pair.pass();
  EXPECT_EQ(pair.surgeon_.state(), State::Done);
}

}  // namespace
}  // namespace palp::io
