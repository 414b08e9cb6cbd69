#include "site_program/session_info.h"

#include <sys/utsname.h>

#include "site_program/build_info.h"

namespace palp::site_program {
namespace {

std::string host_kernel() {
  utsname names{};
  if (uname(&names) != 0) return "unknown";
  return std::string{names.sysname} + ' ' + names.release + ' ' + names.machine;
}

}  // namespace

record::SessionInfo session_info(link::Role role,
                                 const std::string& program,
                                 std::uint64_t seed,
                                 const config::Document& document) {
  record::SessionInfo info;
  info.site = role;
  info.metadata = {{"program", program},
                   {"version", std::string{version()}},
                   {"git_commit", std::string{git_commit()}},
                   {"protocol_version", std::to_string(link::kProtocolVersion)},
                   {"seed", std::to_string(seed)},
                   {"host_kernel", host_kernel()},
                   {"time", "real"}};
  info.attachments = {{"config.textproto", "text/plain", document.text()}};
  return info;
}

}  // namespace palp::site_program
