#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

namespace palp::test {

/// A path in the folder of temporary files that nothing else uses: tests run at once, each as its
/// own process. Nothing is made there.
[[nodiscard]] inline std::string own_path(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("palp-" + std::to_string(::getpid()) + '-' + name);
}

}  // namespace palp::test
