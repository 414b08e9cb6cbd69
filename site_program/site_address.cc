#include "site_program/site_address.h"

namespace palp::site_program {

tl::expected<HostAndPort, ExitStatus> site_address(const std::string& flag,
                                                   const std::string& text,
                                                   const settings::ProtectionSettings& protection,
                                                   std::uint16_t port_min) {
  if (text.empty()) {
    return tl::unexpected{bad_input(flag + " is missing, an address such as 127.0.0.1:9000")};
  }
  const Result<HostAndPort> place = parse_host_and_port(text, port_min);
  if (!place) {
    return tl::unexpected{bad_input(flag + ": " + place.error().text)};
  }
  if (protection.insecure && !protection.identity.empty()) {
    return tl::unexpected{bad_input("--identity and --insecure exclude each other")};
  }
  if (!protection.insecure && protection.identity.empty()) {
    return tl::unexpected{
        bad_input("--identity is missing, a folder with certificate and key ('palp-surgeon "
                  "certificates' makes one for each site); --insecure does without, on loopback "
                  "addresses only")};
  }
  const Result<io::Endpoint> found = io::resolve(*place);
  if (!found) {
    return tl::unexpected{cannot_start(flag + ": " + found.error().text)};
  }
  if (protection.insecure && !found->loopback()) {
    return tl::unexpected{
        bad_input(flag + " " + text +
                  " is not a loopback address, and --insecure is refused anywhere else: everybody "
                  "on the way could move the stage")};
  }
  return *place;
}

}  // namespace palp::site_program
