#include "common/io/process/system_call_filter.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/timex.h>
#include <sys/wait.h>
#include <unistd.h>

namespace palp::io {
namespace {

/// A system call, and what the kernel would answer who may ask: never EPERM without the filter.
struct SystemCall {
  std::string name;
  long number;
  std::array<long, 6> arguments{};
};

constexpr long kNoPlace = -1;              // a descriptor or an address that is none
constexpr long kFarTooMany = 0x7FFF'FFFF;  // of whatever is counted

/// Each kind of what is refused, with arguments that nothing follows from.
std::vector<SystemCall> refused_calls() {
  return {
      {"execve", SYS_execve, {kNoPlace}},
      {"execveat", SYS_execveat, {kNoPlace, kNoPlace}},
      {"a process by clone", SYS_clone, {SIGCHLD | CLONE_FS | CLONE_NEWNS}},
      {"a process", SYS_clone, {SIGCHLD}},
      {"a thread in another network", SYS_clone, {CLONE_THREAD | CLONE_NEWNET}},
      {"ptrace", SYS_ptrace, {kFarTooMany, kFarTooMany}},
      {"process_vm_readv", SYS_process_vm_readv, {0, 0, 0, 0, 0, kFarTooMany}},
      {"process_vm_writev", SYS_process_vm_writev, {0, 0, 0, 0, 0, kFarTooMany}},
      {"pidfd_getfd", SYS_pidfd_getfd, {kNoPlace, 0, kFarTooMany}},
      {"kexec_load", SYS_kexec_load, {0, kFarTooMany, 0, kFarTooMany}},
      {"init_module", SYS_init_module, {kNoPlace, 0, kNoPlace}},
      {"finit_module", SYS_finit_module, {kNoPlace, kNoPlace, kFarTooMany}},
      {"delete_module", SYS_delete_module, {kNoPlace}},
      {"mount", SYS_mount, {kNoPlace, kNoPlace, kNoPlace}},
      {"umount2", SYS_umount2, {kNoPlace, kFarTooMany}},
      {"pivot_root", SYS_pivot_root, {kNoPlace, kNoPlace}},
      {"chroot", SYS_chroot, {kNoPlace}},
      {"fsopen", SYS_fsopen, {kNoPlace, kFarTooMany}},
      {"move_mount", SYS_move_mount, {kNoPlace, kNoPlace, kNoPlace, kNoPlace, kFarTooMany}},
      {"mknodat", SYS_mknodat, {kNoPlace, kNoPlace, 0}},
      {"bpf", SYS_bpf, {kFarTooMany}},
      {"perf_event_open", SYS_perf_event_open, {kNoPlace, 0, 0, kNoPlace, kFarTooMany}},
      {"userfaultfd", SYS_userfaultfd, {kFarTooMany}},
      {"io_uring_setup", SYS_io_uring_setup, {0, kNoPlace}},
      {"keyctl", SYS_keyctl, {kFarTooMany}},
      {"add_key", SYS_add_key, {kNoPlace}},
      {"setns", SYS_setns, {kNoPlace, 0}},
      {"unshare", SYS_unshare, {0}},
      {"setuid", SYS_setuid, {static_cast<long>(::getuid())}},
      {"capset", SYS_capset, {kNoPlace}},
      {"a socket of the kernel's ciphers", SYS_socket, {AF_ALG, SOCK_SEQPACKET, 0}},
      {"a socket of frames", SYS_socket, {AF_PACKET, SOCK_DGRAM, 0}},
      {"a socket of virtual machines", SYS_socket, {AF_VSOCK, SOCK_STREAM, 0}},
      {"a socket of no family", SYS_socket, {0, SOCK_STREAM, 0}},
      {"a family with more bits", SYS_socket, {1L << 32 | AF_VSOCK, SOCK_STREAM, 0}},
      {"a raw socket", SYS_socket, {AF_INET, SOCK_RAW | SOCK_CLOEXEC, IPPROTO_UDP}},
      {"a raw socket of IPv6", SYS_socket, {AF_INET6, SOCK_RAW, IPPROTO_UDP}},
      {"a key pressed at the terminal", SYS_ioctl, {kNoPlace, TIOCSTI}},
      {"the same with more bits", SYS_ioctl, {kNoPlace, 1L << 32 | TIOCSTI}},
      {"a paste at the terminal", SYS_ioctl, {kNoPlace, TIOCLINUX}},
  };
}

/// The error that it answers with; a process that it began ends at once.
int error_of(const SystemCall& call) {
  const std::array<long, 6>& a = call.arguments;
  errno = 0;
  const long answer = ::syscall(call.number, a[0], a[1], a[2], a[3], a[4], a[5]);
  if (call.number == SYS_clone && answer == 0) ::_exit(0);
  return answer < 0 ? errno : 0;
}

/// Whether `check` holds in a process of its own, where what it does ends with it.
template <class Check>
bool holds_in_another_process(Check&& check) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(check() ? 0 : 1);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(SystemCallFilterTest, WhatNoSiteAsksForIsRefused) {
  for (const SystemCall& call : refused_calls()) {
    EXPECT_TRUE(holds_in_another_process([&] {
      return !refuse_system_calls() && error_of(call) == EPERM;
    })) << call.name;
  }
}

TEST(SystemCallFilterTest, ThreadsThatBeginLaterAreHeldToo) {
  EXPECT_TRUE(holds_in_another_process([] {
    if (refuse_system_calls()) return false;
    int error = 0;
    std::thread{[&] { error = error_of({"execve", SYS_execve, {kNoPlace}}); }}.join();
    return error == EPERM;
  }));
}

// Flags that no filter sees: the C library then asks in the way that shows them.
TEST(SystemCallFilterTest, TheCallWhoseFlagsAreHiddenIsAsIfItWereNotThere) {
  EXPECT_TRUE(holds_in_another_process([] {
    return !refuse_system_calls() && error_of({"clone3", SYS_clone3, {0, 0}}) == ENOSYS;
  }));
}

TEST(SystemCallFilterTest, WhatSitesDoGoesOn) {
  const auto opens = [](int family, int type) {
    const int socket = ::socket(family, type | SOCK_CLOEXEC, 0);
    // A machine without IPv6 says so; only the filter says EPERM.
    return (socket >= 0 && ::close(socket) == 0) || errno == EAFNOSUPPORT;
  };
  EXPECT_TRUE(holds_in_another_process([&] {
    return !refuse_system_calls() && opens(AF_INET, SOCK_DGRAM) && opens(AF_INET6, SOCK_DGRAM) &&
           opens(AF_INET, SOCK_STREAM) && opens(AF_UNIX, SOCK_DGRAM) && opens(AF_NETLINK, SOCK_RAW);
  })) << "sockets";
  EXPECT_TRUE(holds_in_another_process([] {
    if (refuse_system_calls()) return false;
    std::FILE* const file = std::tmpfile();
    if (file == nullptr || std::fputs("a record", file) < 0 || std::fflush(file) != 0) return false;
    return ::fsync(::fileno(file)) == 0 && std::fclose(file) == 0;
  })) << "files";
  EXPECT_TRUE(holds_in_another_process([] {
    if (refuse_system_calls()) return false;
    bool ran = false;
    std::thread{[&] { ran = true; }}.join();
    const sched_param normal{};
    return ran && ::sched_setscheduler(0, SCHED_OTHER, &normal) == 0 && ::munlockall() == 0;
  })) << "threads";
  EXPECT_TRUE(holds_in_another_process([] {
    if (refuse_system_calls()) return false;
    timex asked{};  // changes nothing
    return ::clock_adjtime(CLOCK_REALTIME, &asked) >= 0;
  })) << "how well the clock is kept";
}

}  // namespace
}  // namespace palp::io
