#include "site_program/certificates_command.h"

#include <algorithm>
#include <cstdio>

#include "common/io/secure/certificates.h"

namespace palp::site_program {

CertificatesCommand::CertificatesCommand(config::CommandLine& line) {
  config::CommandLine& verb = line.verb(
      "certificates", "Makes an authority, and a certificate and key for each of the two sites.");
  verb.text("--folder", folder_, "FOLDER", "where they go; an authority there is used again");
  verb.required();
  verb.whole("--days", days_, {1, 3650}, "validity of the sites' certificates");
  verb.text("--name", name_, "NAME", "of the installation: its sites know each other by it");
  verb.text("--revoke", revoked_, "FILE", "revokes this certificate instead of making any");
  verb.toggle("--bench", bench_, "a key that both sites share instead of certificates");
}

ExitStatus CertificatesCommand::run() const {
  constexpr std::size_t kNameMax = 40;
  if (name_.size() > kNameMax) return bad_input("--name is longer than 40 characters");
  const auto unfit = [](char c) { return c < ' ' || c > '~' || c == '#'; };
  if (name_.empty() || std::ranges::any_of(name_, unfit)) {
    return bad_input("--name takes printable ASCII without '#'");
  }
  if (bench_ && !revoked_.empty()) return bad_input("--bench and --revoke exclude each other");
  const io::CertificatesConfig config{
      .folder = folder_, .days = static_cast<int>(days_), .name = name_};
  const Result<std::string> made = bench_             ? io::make_pre_shared_key(folder_)
                                   : revoked_.empty() ? io::make_certificates(config)
                                                      : io::revoke_certificate(config, revoked_);
  if (!made) return exit_status_of(made.error());
  std::printf("%s\n", made->c_str());
  return {config::ExitCode::Done, "completed", ""};
}

}  // namespace palp::site_program
