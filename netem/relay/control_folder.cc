#include "netem/relay/control_folder.h"

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "common/core/printable.h"
#include "common/io/process/system_text.h"
#include "netem/syntax/data_files.h"

namespace palp::netem {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFileMax = std::uint64_t{64} << 20U;  ///< [bytes]

/// As much as the file said it has: a file of the kernel's that says 0 and never ends gives none.
Result<std::string> content_of(const io::Descriptor& file, const std::string& quoted) {
  struct stat about {};
  if (::fstat(file.number(), &about) != 0 || !S_ISREG(about.st_mode)) {
    return fail(quoted + " is no regular file");
  }
  const auto size = static_cast<std::uint64_t>(about.st_size);
  if (size > kFileMax) return fail(quoted + " is longer than 64 MiB");
  std::string text(size, '\0');
  std::size_t got = 0;
  while (got < text.size()) {
    const ssize_t more = ::read(file.number(), text.data() + got, text.size() - got);
    if (more <= 0) break;
    got += static_cast<std::size_t>(more);
  }
  text.resize(got);
  return text;
}

}  // namespace

Result<ControlFolder> ControlFolder::open(const std::string& path) {
  std::error_code failed;
  ControlFolder folder;
  folder.path_ = fs::absolute(path, failed).lexically_normal();
  folder.folder_ = io::Descriptor{::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)};
  if (failed || !folder.folder_.valid()) {
    return fail_to_reach("'" + printable(path) + "' is no folder that can be opened");
  }
  return folder;
}

Result<io::Descriptor> ControlFolder::open_below(const std::string& name, int flags) const {
  const std::string quoted = "'" + printable(name) + "'";
  if (path_.empty()) return fail(quoted + ": live control has no folder (--control-folder)");
  open_how how{};
  how.flags = static_cast<decltype(how.flags)>(flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  how.mode = (flags & O_CREAT) != 0 ? 0600 : 0;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  // A path from the root is meant where it leads into the folder.
  fs::path below{name};
  if (below.is_absolute()) below = below.lexically_relative(path_);
  const long made = ::syscall(SYS_openat2, folder_.number(), below.c_str(), &how, sizeof how);
  if (made < 0) {
    const int why = errno;
    if (why == EXDEV || why == ELOOP) return fail(quoted + " lies outside of " + path_);
    return fail_to_reach(quoted + ": " + io::system_text(why));
  }
  return io::Descriptor{static_cast<int>(made)};
}

Result<std::string> ControlFolder::read(const std::string& name) const {
  const auto own = open_below(name, O_RDONLY);
  if (own) return content_of(*own, "'" + printable(name) + "'");
  if (name.find('/') == std::string::npos) {
    for (const std::string& folder : data_folders()) {
      std::error_code failed;
      const fs::path shipped = fs::path{folder} / name;
      if (fs::is_regular_file(shipped, failed)) return read_data_file(shipped);
    }
  }
  return tl::unexpected<Error>(own.error());
}

Result<io::Descriptor> ControlFolder::create(const std::string& name) const {
  return open_below(name, O_WRONLY | O_CREAT | O_EXCL);
}

FileReader ControlFolder::reader() const {
  return [this](const std::string& name) { return read(name); };
}

}  // namespace palp::netem
