#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/io/secure/certificates.h"
#include "common/io/secure/credentials.h"
#include "tests/support/own_path.h"

namespace palp::io::test {

/// An authority with both sites' certificates, on disk as long as this lives.
class KeysFolder {
 public:
  explicit KeysFolder(const std::string& name, bool bench = false)
      : folder_{palp::test::own_path(name)} {
    std::filesystem::remove_all(folder_);
    const auto made = bench ? make_pre_shared_key(folder_) : make_certificates(config());
    EXPECT_TRUE(made) << made.error().text;
  }
  ~KeysFolder() { std::filesystem::remove_all(folder_); }
  KeysFolder(const KeysFolder&) = delete;
  KeysFolder& operator=(const KeysFolder&) = delete;

  [[nodiscard]] CertificatesConfig config() const { return {.folder = folder_, .name = "test"}; }
  [[nodiscard]] std::filesystem::path path() const { return folder_; }
  [[nodiscard]] std::filesystem::path site(link::Role role) const {
    return folder_ / (role == link::Role::Surgeon ? "surgeon" : "patient");
  }
  [[nodiscard]] std::unique_ptr<Credentials> credentials(link::Role role) const {
    auto read = Credentials::read(site(role), role);
    EXPECT_TRUE(read) << read.error().text;
    return read ? std::move(*read) : nullptr;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace palp::io::test
