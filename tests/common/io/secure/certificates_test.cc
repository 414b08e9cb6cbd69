// Goal: what was revoked stays revoked, whatever happens to the folders; owners are told in time.
// Method: an authority on disk, and handshakes' own reading of what it made.
#include "common/io/secure/certificates.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/crypto.h>
#include <openssl/pem.h>
#include <sys/stat.h>

#include "common/io/secure/openssl_handles.h"
#include "tests/common/io/secure/keys_folder.h"

namespace palp::io {
namespace {

using link::Role;
using test::KeysFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(CertificatesTest, AListThatCannotBeReadIsNotBegunAnew) {
  const KeysFolder keys{"list"};
  const auto certificate = (keys.site(Role::Surgeon) / "certificate.pem").string();
  ASSERT_TRUE(revoke_certificate(keys.config(), certificate));
  const auto list = keys.path() / "authority" / "revoked.pem";
  std::filesystem::resize_file(list, std::filesystem::file_size(list) / 2);
  ASSERT_TRUE(make_certificates(keys.config()));
  const auto second = revoke_certificate(keys.config(), certificate);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().text, HasSubstr("revoked.pem"));
}

TEST(CertificatesTest, AnotherAuthoritysCertificateCannotBeRevoked) {
  const KeysFolder keys{"ours"};
  const KeysFolder others{"others"};
  const auto refused =
      revoke_certificate(keys.config(), others.site(Role::Surgeon) / "certificate.pem");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text, HasSubstr("was not made by the authority"));
  EXPECT_FALSE(std::filesystem::exists(keys.site(Role::Patient) / "revoked.pem"));
}

TEST(CertificatesTest, AnAuthorityCannotRevokeItself) {
  const KeysFolder keys{"itself"};
  const auto refused = revoke_certificate(keys.config(), keys.path() / "authority/certificate.pem");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text, HasSubstr("is the authority's own"));
  EXPECT_FALSE(std::filesystem::exists(keys.site(Role::Patient) / "revoked.pem"));
}

/// A pipe in the place of the file, without a writer: whoever opens it waits for ever.
void put_pipe(const std::filesystem::path& file) {
  std::filesystem::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
}

TEST(CertificatesTest, APipeIsNotWaitedFor) {
  const KeysFolder keys{"pipe"};
  put_pipe(keys.path() / "pipe.pem");
  EXPECT_FALSE(revoke_certificate(keys.config(), keys.path() / "pipe.pem"));
  put_pipe(keys.path() / "authority/key.pem");
  EXPECT_FALSE(make_certificates(keys.config()));
}

TEST(CredentialsTest, APipeIsNotWaitedForAndToldAsSuch) {
  for (const char* const name : {"key.pem", "certificate.pem", "authority.pem"}) {
    const KeysFolder keys{"pipe"};
    put_pipe(keys.site(Role::Patient) / name);
    const auto read = Credentials::read(keys.site(Role::Patient), Role::Patient);
    ASSERT_FALSE(read) << name;
    EXPECT_THAT(read.error().text, AllOf(HasSubstr(name), HasSubstr("is no regular file")));
  }
}

TEST(CertificatesTest, ANewAuthorityDoesNotBeginBesideTheListOfAnother) {
  const KeysFolder keys{"begun"};
  const auto certificate = keys.site(Role::Surgeon) / "certificate.pem";
  ASSERT_TRUE(revoke_certificate(keys.config(), certificate));
  std::filesystem::rename(keys.path() / "authority", keys.path() / "stick");
  const auto refused = make_certificates(keys.config());
  ASSERT_FALSE(refused) << "each site would refuse the other: the list is not their authority's";
  EXPECT_THAT(refused.error().text, HasSubstr("revoked.pem is of an authority that is not here"));
  EXPECT_FALSE(std::filesystem::exists(keys.path() / "authority"));
  std::filesystem::rename(keys.path() / "stick", keys.path() / "authority");
  EXPECT_TRUE(make_certificates(keys.config()));
}

TEST(CertificatesTest, SaysWhereTheListOfRevokedOnesIs) {
  const KeysFolder keys{"where"};
  const auto done = revoke_certificate(keys.config(), keys.site(Role::Patient) / "certificate.pem");
  ASSERT_TRUE(done) << done.error().text;
  for (const char* place : {"authority", "surgeon", "patient"}) {
    EXPECT_THAT(*done, HasSubstr((keys.path() / place / "revoked.pem").string()));
  }
}

TEST(CertificatesTest, NewFoldersOfSitesKnowWhatWasRevoked) {
  const KeysFolder keys{"folders"};
  ASSERT_TRUE(revoke_certificate(keys.config(), keys.site(Role::Surgeon) / "certificate.pem"));
  for (const Role role : {Role::Surgeon, Role::Patient}) {
    std::filesystem::remove_all(keys.site(role));  // moved to the site
  }
  ASSERT_TRUE(make_certificates(keys.config()));
  for (const Role role : {Role::Surgeon, Role::Patient}) {
    EXPECT_TRUE(std::filesystem::exists(keys.site(role) / "revoked.pem"));
  }
}

TEST(CertificatesTest, CertificatesAndASharedKeyDoNotGoIntoOneFolder) {
  const KeysFolder certificates{"certificates"};
  const KeysFolder bench{"bench", true};
  EXPECT_FALSE(make_pre_shared_key(certificates.path()));
  EXPECT_FALSE(make_certificates(bench.config()));
  EXPECT_FALSE(std::filesystem::exists(bench.path() / "authority"));
  const auto key = certificates.site(Role::Patient) / "pre_shared_key.txt";
  std::filesystem::copy_file(bench.site(Role::Patient) / "pre_shared_key.txt", key);
  const auto read = Credentials::read(certificates.site(Role::Patient), Role::Patient);
  ASSERT_FALSE(read) << "it would speak under the key and nobody would know";
  EXPECT_THAT(read.error().text, HasSubstr("a certificate and a pre-shared key"));
}

TEST(CredentialsTest, TellTheFingerprintOfTheirCertificate) {
  const KeysFolder certificates{"fingerprint"};
  const KeysFolder bench{"no-fingerprint", true};
  const auto own = Credentials::read(certificates.site(Role::Patient), Role::Patient);
  ASSERT_TRUE(own);
  EXPECT_EQ((*own)->fingerprint().size(), 64U) << "SHA-256 in hexadecimal digits";
  const auto shared = Credentials::read(bench.site(Role::Patient), Role::Patient);
  ASSERT_TRUE(shared);
  EXPECT_EQ((*shared)->fingerprint(), "") << "a shared key has none";
}

TEST(CredentialsTest, ThePrivateKeyLiesInMemoryThatIsNeitherSwappedNorDumped) {
  const KeysFolder keys{"apart"};
  const auto read = Credentials::read(keys.site(Role::Surgeon), Role::Surgeon);
  ASSERT_TRUE(read);
  EXPECT_EQ(CRYPTO_secure_malloc_initialized(), 1);
  EXPECT_GT(CRYPTO_secure_used(), 0U);
}

TEST(CredentialsTest, AFreshIdentityNeedsNoCaution) {
  for (const bool bench : {false, true}) {
    const KeysFolder keys{"fresh", bench};
    EXPECT_THAT(keys.credentials(Role::Surgeon)->cautions(), IsEmpty());
  }
}

TEST(CredentialsTest, AKeyThatOthersCanReadIsTold) {
  using std::filesystem::perms;
  for (const bool bench : {false, true}) {
    for (const perms right : {perms::group_read, perms::others_read, perms::others_write}) {
      const KeysFolder keys{"exposed", bench};
      const auto file = keys.site(Role::Patient) / (bench ? "pre_shared_key.txt" : "key.pem");
      std::filesystem::permissions(file, right, std::filesystem::perm_options::add);
      EXPECT_THAT(keys.credentials(Role::Patient)->cautions(), ElementsAre(HasSubstr("chmod 600")));
    }
  }
}

TEST(CredentialsTest, ACertificateThatEndsSoonOrHasEndedIsTold) {
  const KeysFolder keys{"soon"};
  CertificatesConfig config = keys.config();
  for (const auto& [days, words] : {std::pair{13, "expires in 1"}, {-1, "has expired"}}) {
    config.days = days;
    ASSERT_TRUE(make_certificates(config));
    EXPECT_THAT(keys.credentials(Role::Surgeon)->cautions(), ElementsAre(HasSubstr(words)));
  }
  config.days = 16;
  ASSERT_TRUE(make_certificates(config));
  EXPECT_THAT(keys.credentials(Role::Surgeon)->cautions(), IsEmpty());
}

TEST(CredentialsTest, WhatIsWrongWithAFileIsSaidInWordsOfItsOwner) {
  struct Case {
    const char* file;
    const char* content;  ///< null: none
    const char* words;
  };
  for (const auto& [file, content, words] :
       {Case{"key.pem", nullptr, "cannot be read: no such file"},
        {"key.pem", "rubbish", "holds no private key"},
        {"certificate.pem", nullptr, "cannot be read: no such file"},
        {"certificate.pem", "", "holds no certificate"},
        {"authority.pem", nullptr, "cannot be read: no such file"},
        {"authority.pem", "rubbish", "holds no certificate"},
        {"revoked.pem", "rubbish", "holds no revocation list"}}) {
    const KeysFolder keys{"wrong"};
    const auto place = keys.site(Role::Patient) / file;
    std::filesystem::remove(place);
    if (content != nullptr) std::ofstream{place} << content;
    const auto read = Credentials::read(keys.site(Role::Patient), Role::Patient);
    ASSERT_FALSE(read) << file;
    EXPECT_THAT(read.error().text, AllOf(HasSubstr(file), HasSubstr(words)));
  }
  const KeysFolder keys{"misfit"};
  std::filesystem::copy_file(keys.site(Role::Surgeon) / "key.pem",
                             keys.site(Role::Patient) / "key.pem",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(Credentials::read(keys.site(Role::Patient), Role::Patient).error().text,
              HasSubstr("key.pem: does not fit the certificate"));
}

TEST(CredentialsTest, TheWordsThatNothingIsRevokedStandForNoListAndNoOthersDo) {
  const KeysFolder keys{"words"};
  const auto file = keys.site(Role::Patient) / "revoked.pem";
  std::ofstream{file} << "nothing is revoked";
  EXPECT_TRUE(Credentials::read(keys.site(Role::Patient), Role::Patient));
  for (const char* const other :
       {"", "nothing is revoked\n-----BEGIN X509 CRL-----\n", "nothing"}) {
    std::ofstream{file} << other;
    EXPECT_FALSE(Credentials::read(keys.site(Role::Patient), Role::Patient)) << other;
  }
}

/// The service reads its identity from a folder that systemd fills: what is not named in the unit
/// is not there, and a list of revoked certificates that is missing refuses nobody.
TEST(CredentialsTest, TheServiceIsGivenEachFileOfAnIdentity) {
  std::ifstream in{PALP_TREE "/debian/palp-patient-site.palp-patient@.service"};
  const std::string unit{std::istreambuf_iterator<char>{in}, {}};
  const KeysFolder keys{"service"};
  ASSERT_TRUE(revoke_certificate(keys.config(), keys.site(Role::Surgeon) / "certificate.pem"));
  int files = 0;
  for (const auto& one : std::filesystem::directory_iterator{keys.site(Role::Patient)}) {
    const std::string name = one.path().filename();
    EXPECT_THAT(unit, HasSubstr("\nLoadCredential=" + name + ":/etc/palp/keys/%i/" + name + "\n"));
    ++files;
  }
  EXPECT_EQ(files, 5);
  EXPECT_THAT(unit, HasSubstr("\nSetCredential=revoked.pem:nothing is revoked\n"));
}

TEST(CredentialsTest, AKeyWithAPassphraseIsRefusedWithoutAsking) {
  const KeysFolder keys{"passphrase"};
  const auto file = (keys.site(Role::Surgeon) / "key.pem").string();
  const Openssl<EVP_PKEY> key{EVP_EC_gen("P-256")};
  const Openssl<BIO> out{BIO_new_file(file.c_str(), "w")};
  ASSERT_EQ(PEM_write_bio_PKCS8PrivateKey(
                out.get(), key.get(), EVP_aes_256_cbc(), "word", 4, nullptr, nullptr),
            1);
  ASSERT_EQ(BIO_flush(out.get()), 1);
  const auto read = Credentials::read(keys.site(Role::Surgeon), Role::Surgeon);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().text, HasSubstr("key.pem"));
}

}  // namespace
}  // namespace palp::io
