#include "netem/relay/control_token.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cinttypes>
#include <cstdio>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/core/printable.h"
#include "common/io/process/descriptor.h"
#include "common/io/process/entropy.h"
#include "common/io/process/system_text.h"

namespace palp::netem {
namespace {

constexpr std::size_t kTokenFileMax = 4096;  ///< [bytes]

Result<std::string> make_token(const std::string& path) {
  std::array<char, 33> digits{};
  std::snprintf(digits.data(),
                digits.size(),
                "%016" PRIx64 "%016" PRIx64,
                io::draw_entropy(),
                io::draw_entropy());
  const std::string token{digits.data()};
  const io::Descriptor file{::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
  const std::string line = token + '\n';
  if (!file.valid() ||
      ::write(file.number(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    return fail_to_reach("'" + printable(path) + "' cannot be made: " + io::system_text(errno));
  }
  return token;
}

bool usable(char sign) { return sign > ' ' && sign < 0x7f && sign != '"' && sign != '\\'; }

}  // namespace

Result<std::string> read_or_make_token(const std::string& path) {
  const io::Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (!file.valid() && errno == ENOENT) return make_token(path);
  const std::string quoted = "'" + printable(path) + "'";
  struct stat about {};
  if (!file.valid() || ::fstat(file.number(), &about) != 0 || !S_ISREG(about.st_mode)) {
    return fail_to_reach(quoted + " cannot be read");
  }
  if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return fail(quoted + " can be read or written by others, expected mode 0600");
  }
  if (about.st_uid != ::geteuid()) return fail(quoted + " is another user's");
  std::string text(kTokenFileMax, '\0');
  text.resize(static_cast<std::size_t>(
      std::max<ssize_t>(0, ::read(file.number(), text.data(), text.size()))));
  text.resize(std::min(text.find_first_of("\r\n"), text.size()));
  if (text.size() < kTokenMin || !std::ranges::all_of(text, usable)) {
    return fail(quoted + " holds no token: expected a line of at least " +
                std::to_string(kTokenMin) + " printable characters");
  }
  return text;
}

bool shows_token(std::string_view line, std::string_view token) {
  constexpr std::string_view kBefore = R"({"token":")";
  constexpr std::string_view kBehind = R"("})";
  std::string shown{line};
  std::erase_if(shown, [](char sign) { return sign == ' ' || sign == '\t' || sign == '\r'; });
  if (token.empty() || shown.size() != kBefore.size() + token.size() + kBehind.size() ||
      !shown.starts_with(kBefore) || !shown.ends_with(kBehind)) {
    return false;
  }
  unsigned differs = 0;
  for (std::size_t i = 0; i < token.size(); ++i) {
    differs |= static_cast<unsigned char>(shown[kBefore.size() + i] ^ token[i]);
  }
  return differs == 0;
}

}  // namespace palp::netem
