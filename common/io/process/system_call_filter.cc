#include "common/io/process/system_call_filter.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <type_traits>

#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "common/io/process/system_text.h"

namespace palp::io {
namespace {

/// Refused whatever their arguments.
constexpr std::array kNever{
    // Other programs and processes.
    "execve",
    "execveat",
    "fork",
    "vfork",
    // Looking into processes, and taking what they hold.
    "ptrace",
    "process_vm_readv",
    "process_vm_writev",
    "process_madvise",
    "kcmp",
    "pidfd_getfd",
    // The kernel itself.
    "kexec_load",
    "kexec_file_load",
    "reboot",
    "init_module",
    "finit_module",
    "delete_module",
    "bpf",
    "perf_event_open",
    "userfaultfd",
    "syslog",
    "iopl",
    "ioperm",
    "modify_ldt",
    "personality",
    "acct",
    "swapon",
    "swapoff",
    "settimeofday",
    "clock_settime",  // not clock_adjtime, which also tells how well the clock is kept
    "sethostname",
    "setdomainname",
    // Asks for other calls, past this filter.
    "io_uring_setup",
    "io_uring_enter",
    "io_uring_register",
    // Keys of others.
    "add_key",
    "request_key",
    "keyctl",
    // Files elsewhere.
    "mount",
    "umount2",
    "pivot_root",
    "chroot",
    "move_mount",
    "open_tree",
    "fsopen",
    "fsconfig",
    "fsmount",
    "fspick",
    "mount_setattr",
    "mknod",
    "mknodat",
    "open_by_handle_at",
    "fanotify_init",
    "quotactl",
    "quotactl_fd",
    // Other rights.
    "setns",
    "unshare",
    "capset",
    "setuid",
    "setgid",
    "setreuid",
    "setregid",
    "setresuid",
    "setresgid",
    "setfsuid",
    "setfsgid",
    "setgroups",
};

/// Of sockets: the network, the service manager and name services, and the kernel's lists of
/// addresses and devices.
constexpr std::array<std::uint64_t, 4> kFamilies{AF_UNIX, AF_INET, AF_INET6, AF_NETLINK};
/// What clone() may not be asked for, even for a thread.
constexpr std::array<std::uint64_t, 7> kNamespaces{CLONE_NEWNS,
                                                   CLONE_NEWUTS,
                                                   CLONE_NEWIPC,
                                                   CLONE_NEWUSER,
                                                   CLONE_NEWPID,
                                                   CLONE_NEWNET,
                                                   CLONE_NEWCGROUP};
constexpr std::uint64_t kWholeInt = 0xFFFF'FFFF;  ///< what the kernel reads of an int
constexpr std::uint64_t kSocketKind = 0xF;        ///< of socket()'s type, without its flags
constexpr unsigned kAsIfNotBuilt = ENOSYS;        ///< then the C library asks another way
constexpr unsigned kFirst = 0, kSecond = 1;       ///< arguments of a call

/// The filter while it is made. Keeps the first refusal of libseccomp.
class Filter {
 public:
  Filter() : context_{seccomp_init(SCMP_ACT_ALLOW), &seccomp_release} {
    if (context_ == nullptr) {
      refusal_ = -ENOMEM;
      return;
    }
    note(seccomp_attr_set(context_.get(), SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_ERRNO(EPERM)));
    // The answer is found by halving, and all threads that may be there get the filter.
    note(seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_OPTIMIZE, 2));
    note(seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_TSYNC, 1));
  }

  template <class... Arguments>
  void refuse(const char* call, unsigned error, Arguments... arguments) {
    if (refusal_ != 0) return;
    const int number = seccomp_syscall_resolve_name(call);
    if (number == __NR_SCMP_ERROR) {
      note(-ENOSYS);
      return;
    }
    const std::array<scmp_arg_cmp, sizeof...(arguments)> compared{arguments...};
    note(seccomp_rule_add_array(
        context_.get(), SCMP_ACT_ERRNO(error), number, compared.size(), compared.data()));
  }

  /// @returns a negative error number, or 0.
  int enter() {
    if (refusal_ == 0) note(seccomp_load(context_.get()));
    return refusal_;
  }

 private:
  void note(int result) {
    if (refusal_ == 0 && result < 0) refusal_ = result;
  }

  std::unique_ptr<std::remove_pointer_t<scmp_filter_ctx>, decltype(&seccomp_release)> context_;
  int refusal_{};
};

scmp_arg_cmp equal(unsigned argument, std::uint64_t value) {
  return {argument, SCMP_CMP_EQ, value, 0};
}
scmp_arg_cmp above(unsigned argument, std::uint64_t value) {
  return {argument, SCMP_CMP_GT, value, 0};
}
scmp_arg_cmp masked(unsigned argument, std::uint64_t mask, std::uint64_t value) {
  return {argument, SCMP_CMP_MASKED_EQ, mask, value};
}

void refuse_processes(Filter& filter) {
  // Its flags lie in memory, where no filter can look: without it the C library asks clone().
  filter.refuse("clone3", kAsIfNotBuilt);
  filter.refuse("clone", EPERM, masked(kFirst, CLONE_THREAD, 0));
  for (const std::uint64_t flag : kNamespaces) {
    filter.refuse("clone", EPERM, masked(kFirst, flag, flag));
  }
}

void refuse_sockets(Filter& filter) {
  const std::uint64_t last = *std::ranges::max_element(kFamilies);
  for (std::uint64_t family = 0; family < last; ++family) {
    if (std::ranges::find(kFamilies, family) != kFamilies.end()) continue;
    filter.refuse("socket", EPERM, equal(kFirst, family));
  }
  filter.refuse("socket", EPERM, above(kFirst, last));
  for (const std::uint64_t family : std::array<std::uint64_t, 2>{AF_INET, AF_INET6}) {
    filter.refuse("socket", EPERM, equal(kFirst, family), masked(kSecond, kSocketKind, SOCK_RAW));
  }
}

}  // namespace

std::optional<std::string> refuse_system_calls() {
  Filter filter;
  for (const char* const call : kNever) filter.refuse(call, EPERM);
  refuse_processes(filter);
  refuse_sockets(filter);
  // Keys pressed in the name of who sits at the terminal.
  filter.refuse("ioctl", EPERM, masked(kSecond, kWholeInt, TIOCSTI));
  filter.refuse("ioctl", EPERM, masked(kSecond, kWholeInt, TIOCLINUX));
  const int refusal = filter.enter();
  if (refusal == 0) return std::nullopt;
  return "this process cannot refuse system calls: " + system_text(-refusal);
}

}  // namespace palp::io
