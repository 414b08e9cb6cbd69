#include "review/report_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace palp::review {

std::optional<Error> write_whole(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  {
    std::ofstream file{temporary, std::ios::binary | std::ios::trunc};
    file << text;
    file.flush();
    if (!file) {
      return Error{"report " + path + " cannot be written: " + std::strerror(errno)};
    }
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) {
    return Error{"report " + path + " cannot be put in its place: " + std::strerror(errno)};
  }
  return std::nullopt;
}

}  // namespace palp::review
