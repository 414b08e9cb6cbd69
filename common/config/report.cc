#include "common/config/report.h"

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/config/json.h"
#include "common/config/number.h"
#include "common/core/printable.h"

namespace palp::config {
namespace {

tl::unexpected<Error> cannot_write(const std::string& path, int error) {
  return fail("cannot write " + printable(path) + ": " + std::generic_category().message(error));
}

constexpr int kSilenceMaxMs = 2000;  // [ms], of who reads a pipe

/// Zero, or the error number.
int write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EAGAIN) {
      pollfd ready{file, POLLOUT, 0};
      if (::poll(&ready, 1, kSilenceMaxMs) == 0) return ETIMEDOUT;
    } else if (written < 0 && errno != EINTR) {
      return errno;
    }
    text.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
  }
  return 0;
}

/// Where the bytes of a file go.
struct Destination {
  bool renamed{};              ///< through `temporary`, else straight to the path
  std::string target;          ///< the file behind a link
  std::string temporary;       ///< beside it
  std::optional<mode_t> mode;  ///< of the file that is there
};

/// Writes `text` there, into the temporary file or straight. Zero, or the error number.
int fill_file(const Destination& to, std::string_view text) {
  // Opening a pipe that nobody reads would wait for a reader. At the temporary name there is
  // nothing but what a run left that was killed, or what somebody laid there, whose file it would
  // stay: it goes.
  if (to.renamed) (void)::unlink(to.temporary.c_str());
  const int flags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK | O_NOCTTY |
                    (to.renamed ? O_NOFOLLOW | O_EXCL : 0);
  const int file = ::open((to.renamed ? to.temporary : to.target).c_str(), flags, 0666);
  if (file < 0) {
    return errno;
  }
  int error = to.mode && ::fchmod(file, *to.mode) != 0 ? errno : 0;
  if (error == 0) {
    error = write_all(file, text);
  }
  if (error == 0 && to.renamed && ::fsync(file) != 0) {
    error = errno;
  }
  if (::close(file) != 0 && error == 0) {
    error = errno;
  }
  return error;
}

/// So that the new name survives a power cut; a folder that cannot be synced is no error.
void sync_folder(const std::filesystem::path& file) {
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle >= 0) {
    (void)::fsync(handle);
    (void)::close(handle);
  }
}

Result<Destination> destination_of(const std::string& path) {
  struct stat there {};
  const bool exists = ::stat(path.c_str(), &there) == 0;
  if (exists && S_ISDIR(there.st_mode)) {
    return cannot_write(path, EISDIR);
  }
  // Renaming asks for the folder's rights alone.
  constexpr mode_t kMayWrite = S_IWUSR | S_IWGRP | S_IWOTH;
  if (exists && S_ISREG(there.st_mode) && (there.st_mode & kMayWrite) == 0) {
    return cannot_write(path, EACCES);
  }
  Destination to;
  // Renaming would put a file in the place of a device.
  to.renamed = !exists || S_ISREG(there.st_mode);
  to.target = path;
  if (exists && to.renamed) {  // a link stays a link: the file behind it is replaced
    to.mode = there.st_mode & 07777;
    std::error_code unresolved;
    const auto resolved = std::filesystem::canonical(path, unresolved);
    to.target = unresolved ? path : resolved.string();
  }
  to.temporary = to.target + ".partial." + std::to_string(::getpid());
  return to;
}

}  // namespace

Result<void> can_write_file(const std::string& path) {
  const auto to = destination_of(path);
  if (!to) {
    return tl::unexpected(to.error());
  }
  if (!to->renamed) {  // opening a pipe might wait for its reader
    return ::access(path.c_str(), W_OK) == 0 ? Result<void>{} : cannot_write(path, errno);
  }
  const int error = fill_file(*to, {});
  (void)::unlink(to->temporary.c_str());
  return error == 0 ? Result<void>{} : cannot_write(path, error);
}

Result<void> can_write_files(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    if (auto can = can_write_file(path); !can) return can;
  }
  return {};
}

Result<void> write_whole_file(const std::string& path, std::string_view text) {
  const auto to = destination_of(path);
  if (!to) {
    return tl::unexpected(to.error());
  }
  if (!to->renamed) {
    const int error = fill_file(*to, text);
    return error == 0 ? Result<void>{} : cannot_write(path, error);
  }
  int error = fill_file(*to, text);
  if (error == 0 && ::rename(to->temporary.c_str(), to->target.c_str()) != 0) {
    error = errno;
  }
  if (error != 0) {
    (void)::unlink(to->temporary.c_str());
    return cannot_write(path, error);
  }
  sync_folder(to->target);
  return {};
}

std::string failure_report(const std::string& schema, const ExitStatus& exit_status) {
  Json json;
  json["schema"] = schema;
  json["outcome"] = exit_status.code == ExitCode::BadInput ? "bad input" : "cannot start";
  json["reason"] = exit_status.text;
  // What people typed need not be UTF-8.
  return json.dump(2) + "\n";
}

std::string json_number(double value) { return std::isfinite(value) ? number_text(value) : "null"; }

}  // namespace palp::config
