#include "netem/syntax/data_files.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace palp::netem {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kFileMax = std::uintmax_t{64} << 20;

}  // namespace

std::vector<std::string> data_folders() {
  std::vector<std::string> folders;
  std::error_code failed;
  // The build and an installation alike: bin/palp-netem and share/palp/traces.
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) folders.push_back(program.parent_path().parent_path() / "share/palp/traces");
  // Where Debian's iproute2 has its tables, on any architecture, and where others have them.
  for (const auto& entry : fs::directory_iterator{"/usr/lib", failed}) {
    if (entry.path().filename().string().ends_with("-linux-gnu"))
      folders.push_back(entry.path() / "tc");
  }
  folders.insert(folders.end(), {"/usr/lib/tc", "/usr/share/tc"});
  return folders;
}

Result<std::string> read_data_file(const std::string& name) {
  std::vector<fs::path> places{name};
  if (name.find('/') == std::string::npos) {
    for (const std::string& folder : data_folders()) places.push_back(fs::path{folder} / name);
  }
  for (const fs::path& place : places) {
    std::error_code failed;
    if (!fs::is_regular_file(place, failed)) continue;
    if (fs::file_size(place, failed) > kFileMax || failed) {
      return fail("'" + name + "' is longer than 64 MiB");
    }
    std::ifstream file{place, std::ios::binary};
    if (!file) return fail_to_reach("'" + name + "' cannot be read");
    return std::string{std::istreambuf_iterator<char>{file}, {}};
  }
  return fail_to_reach("no file '" + name + "'");
}

}  // namespace palp::netem
