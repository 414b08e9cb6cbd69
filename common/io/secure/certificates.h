#pragma once

#include <string>

#include "common/core/result.h"

namespace palp::io {

struct CertificatesConfig {
  std::string folder;        ///< where `authority`, `surgeon` and `patient` are, or will be
  int days{365};             ///< validity of the sites' certificates; the authority's: ten times
  std::string name{"palp"};  ///< of the installation, in the certificates
};

/// A small certificate authority and a certificate for each site, in three folders; `surgeon` and
/// `patient` are what Credentials::read() takes, each with the other's name in peers.txt. An
/// authority that is there already is used again, and the sites then get new keys. Private keys are
/// readable by their owner only.
/// @returns what was made, in a sentence. Reads the wall clock.
[[nodiscard]] Result<std::string> make_certificates(const CertificatesConfig& config);

/// Puts the certificate in file `certificate` on the authority's list of revoked ones, and the list
/// into the folders of both sites.
/// @returns where the lists are now, and what is to be done with them, in a sentence.
[[nodiscard]] Result<std::string> revoke_certificate(const CertificatesConfig& config,
                                                     const std::string& certificate);

/// A key that both sites share, in `surgeon` and `patient`: for a bench.
[[nodiscard]] Result<std::string> make_pre_shared_key(const std::string& folder);

}  // namespace palp::io
