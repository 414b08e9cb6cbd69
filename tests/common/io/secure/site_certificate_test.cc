// Goal: the list of peers is read as its owner meant it.
#include "common/io/secure/site_certificate.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/common/io/secure/keys_folder.h"

namespace palp::io {
namespace {

using link::Role;
using test::KeysFolder;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(SiteCertificateTest, APeersListIsReadWithoutRemarksAndBlanks) {
  const KeysFolder keys{"peers"};
  const auto file = keys.path() / "peers.txt";
  std::ofstream{file} << "# ours\n\n  theatre 3 patient site \r\nb # the new one\n#c\n";
  EXPECT_THAT(*read_peer_names(file), ElementsAre("b", "theatre 3 patient site"));
  std::ofstream{file} << "";
  EXPECT_TRUE(read_peer_names(file)->empty());
  std::ofstream{file} << std::string{
      "\xff\xfe"
      "b\0\n\0",
      6};
  EXPECT_THAT(read_peer_names(file).error().text, HasSubstr("no list of names"));
  const auto missing = read_peer_names(keys.path() / "none");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().text, HasSubstr("cannot read"));
}

TEST(SiteCertificateTest, SitesThatAreMadeTogetherListEachOtherAndKeepWhoIsListed) {
  const KeysFolder keys{"peers"};
  const auto file = keys.site(Role::Surgeon) / "peers.txt";
  EXPECT_THAT(*read_peer_names(file), ElementsAre("test patient site"));
  EXPECT_THAT(*read_peer_names(keys.site(Role::Patient) / "peers.txt"),
              ElementsAre("test surgeon site"));
  std::ofstream{file, std::ios::app} << "guest patient site";
  CertificatesConfig other = keys.config();
  other.name = "a";
  ASSERT_TRUE(make_certificates(other));
  EXPECT_THAT(*read_peer_names(file),
              ElementsAre("a patient site", "guest patient site", "test patient site"));
}

}  // namespace
}  // namespace palp::io
