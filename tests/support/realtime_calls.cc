#include "tests/support/realtime_calls.h"

#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <typeinfo>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "tests/support/realtime_guard.h"

// Definitions in the program come before those of shared libraries, so these are called by
// everyone in the process. Each tells the guard and passes the call on to the C library.

using palp::test::RealtimeGuard;

namespace {

/// The C library's own function of that name. Found once, by prepare_realtime_calls() at the
/// latest; one object per function.
class Next {
 public:
  explicit constexpr Next(const char* name) noexcept : name_{name} {}
  void find() noexcept {
    if (function_ == nullptr) function_ = dlsym(RTLD_NEXT, name_);
  }
  /// Tells the guard, and passes the call on.
  template <class Result, class... Arguments>
  Result call(Arguments... arguments) {
    RealtimeGuard::violation(name_);
    return pass<Result>(arguments...);
  }
  template <class Result, class... Arguments>
  Result pass(Arguments... arguments) {
    find();
    return reinterpret_cast<Result (*)(Arguments...)>(function_)(arguments...);
  }

 private:
  const char* name_;
  void* function_{nullptr};
};

constinit Next next_mutex_lock{"pthread_mutex_lock"};
constinit Next next_mutex_trylock{"pthread_mutex_trylock"};
constinit Next next_mutex_timedlock{"pthread_mutex_timedlock"};
constinit Next next_read_lock{"pthread_rwlock_rdlock"};
constinit Next next_write_lock{"pthread_rwlock_wrlock"};
constinit Next next_cond_wait{"pthread_cond_wait"};
constinit Next next_cond_timedwait{"pthread_cond_timedwait"};
constinit Next next_cond_clockwait{"pthread_cond_clockwait"};
constinit Next next_create{"pthread_create"};
constinit Next next_join{"pthread_join"};
constinit Next next_sem_wait{"sem_wait"};
constinit Next next_sem_timedwait{"sem_timedwait"};
constinit Next next_nanosleep{"nanosleep"};
constinit Next next_clock_nanosleep{"clock_nanosleep"};
constinit Next next_usleep{"usleep"};
constinit Next next_sleep{"sleep"};
constinit Next next_poll{"poll"};
constinit Next next_ppoll{"ppoll"};
constinit Next next_select{"select"};
constinit Next next_epoll_wait{"epoll_wait"};
constinit Next next_read{"read"};
constinit Next next_write{"write"};
constinit Next next_writev{"writev"};
constinit Next next_fsync{"fsync"};
constinit Next next_recv{"recv"};
constinit Next next_recvfrom{"recvfrom"};
constinit Next next_recvmsg{"recvmsg"};
constinit Next next_recvmmsg{"recvmmsg"};
constinit Next next_send{"send"};
constinit Next next_sendto{"sendto"};
constinit Next next_sendmsg{"sendmsg"};
constinit Next next_sendmmsg{"sendmmsg"};
constinit Next next_open{"open"};
constinit Next next_open64{"open64"};
constinit Next next_fopen{"fopen"};
constinit Next next_fopen64{"fopen64"};
constinit Next next_fwrite{"fwrite"};
constinit Next next_fputs{"fputs"};
constinit Next next_puts{"puts"};
constinit Next next_fflush{"fflush"};
constinit Next next_throw{"__cxa_throw"};
constinit Next next_exception{"__cxa_allocate_exception"};

/// Whether a call on this descriptor could block; with MSG_DONTWAIT in `flags` it cannot.
bool may_block(int descriptor, int flags) noexcept {
  if ((flags & MSG_DONTWAIT) != 0) return false;
  const int error = errno;
  const int status = fcntl(descriptor, F_GETFL);
  errno = error;
  return status >= 0 && (status & O_NONBLOCK) == 0;
}

void tell_if_blocking(const char* function, int descriptor, int flags) noexcept {
  if (may_block(descriptor, flags)) RealtimeGuard::violation(function);
}

}  // namespace

namespace palp::test {

void prepare_realtime_calls() noexcept {
  const auto find = [](auto&... all) { (all.find(), ...); };
  find(next_mutex_lock, next_mutex_trylock, next_mutex_timedlock, next_read_lock, next_write_lock);
  find(next_cond_wait, next_cond_timedwait, next_cond_clockwait, next_create, next_join);
  find(next_sem_wait, next_sem_timedwait, next_nanosleep, next_clock_nanosleep, next_usleep);
  find(next_sleep, next_poll, next_ppoll, next_select, next_epoll_wait, next_read, next_write);
  find(next_writev, next_fsync, next_recv, next_recvfrom, next_recvmsg, next_recvmmsg, next_send);
  find(next_sendto, next_sendmsg, next_sendmmsg, next_open, next_open64, next_fopen, next_fopen64);
  find(next_fwrite, next_fputs, next_puts, next_fflush, next_throw, next_exception);
}

}  // namespace palp::test

extern "C" {

// Memory. glibc offers its own allocator under these names for this purpose.
void* __libc_malloc(std::size_t size) noexcept;                           // NOLINT(*-identifier*)
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;        // NOLINT(*-identifier*)
void* __libc_realloc(void* memory, std::size_t size) noexcept;            // NOLINT(*-identifier*)
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;  // NOLINT(*-identifier*)
void __libc_free(void* memory) noexcept;                                  // NOLINT(*-identifier*)

void* malloc(std::size_t size) noexcept {
  RealtimeGuard::violation("malloc");
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  RealtimeGuard::violation("calloc");
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  RealtimeGuard::violation("realloc");
  return __libc_realloc(memory, size);
}
void free(void* memory) noexcept {
  if (memory != nullptr) RealtimeGuard::violation("free");
  __libc_free(memory);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  RealtimeGuard::violation("memalign");
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  RealtimeGuard::violation("aligned_alloc");
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  RealtimeGuard::violation("posix_memalign");
  void* const made = __libc_memalign(alignment, size);
  if (made == nullptr) return ENOMEM;
  *memory = made;
  return 0;
}

// Locks, waits, threads. A trylock counts too: its holder makes others wait for this thread.
int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept { return next_mutex_lock.call<int>(mutex); }
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  return next_mutex_trylock.call<int>(mutex);
}
int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
  return next_mutex_timedlock.call<int>(mutex, until);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  return next_read_lock.call<int>(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  return next_write_lock.call<int>(lock);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  return next_cond_wait.call<int>(condition, mutex);
}
int pthread_cond_timedwait(pthread_cond_t* condition,
                           pthread_mutex_t* mutex,
                           const timespec* until) {
  return next_cond_timedwait.call<int>(condition, mutex, until);
}
int pthread_cond_clockwait(pthread_cond_t* condition,
                           pthread_mutex_t* mutex,
                           clockid_t clock,
                           const timespec* until) {
  return next_cond_clockwait.call<int>(condition, mutex, clock, until);
}
int pthread_create(pthread_t* thread,
                   const pthread_attr_t* attributes,
                   void* (*run)(void*),
                   void* argument) noexcept {
  return next_create.call<int>(thread, attributes, run, argument);
}
int pthread_join(pthread_t thread, void** result) { return next_join.call<int>(thread, result); }
int sem_wait(sem_t* semaphore) { return next_sem_wait.call<int>(semaphore); }
int sem_timedwait(sem_t* semaphore, const timespec* until) {
  return next_sem_timedwait.call<int>(semaphore, until);
}

// Sleeping and waiting for events.
int nanosleep(const timespec* span, timespec* rest) { return next_nanosleep.call<int>(span, rest); }
int clock_nanosleep(clockid_t clock, int flags, const timespec* span, timespec* rest) {
  return next_clock_nanosleep.call<int>(clock, flags, span, rest);
}
int usleep(useconds_t span) { return next_usleep.call<int>(span); }
unsigned int sleep(unsigned int span) { return next_sleep.call<unsigned int>(span); }
int poll(pollfd* all, nfds_t count, int timeout) {
  return next_poll.call<int>(all, count, timeout);
}
int ppoll(pollfd* all, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  return next_ppoll.call<int>(all, count, timeout, mask);
}
int select(int count, fd_set* reading, fd_set* writing, fd_set* failing, timeval* timeout) {
  return next_select.call<int>(count, reading, writing, failing, timeout);
}
int epoll_wait(int descriptor, epoll_event* events, int count, int timeout) {
  return next_epoll_wait.call<int>(descriptor, events, count, timeout);
}

// Input and output: on a descriptor that never blocks they are allowed.
ssize_t read(int descriptor, void* buffer, std::size_t size) {
  tell_if_blocking("read", descriptor, 0);
  return next_read.pass<ssize_t>(descriptor, buffer, size);
}
ssize_t write(int descriptor, const void* buffer, std::size_t size) {
  tell_if_blocking("write", descriptor, 0);
  return next_write.pass<ssize_t>(descriptor, buffer, size);
}
ssize_t writev(int descriptor, const iovec* parts, int count) {
  tell_if_blocking("writev", descriptor, 0);
  return next_writev.pass<ssize_t>(descriptor, parts, count);
}
int fsync(int descriptor) { return next_fsync.call<int>(descriptor); }
ssize_t recv(int descriptor, void* buffer, std::size_t size, int flags) {
  tell_if_blocking("recv", descriptor, flags);
  return next_recv.pass<ssize_t>(descriptor, buffer, size, flags);
}
ssize_t recvfrom(int descriptor,
                 void* buffer,
                 std::size_t size,
                 int flags,
                 sockaddr* from,
                 socklen_t* from_size) {
  tell_if_blocking("recvfrom", descriptor, flags);
  return next_recvfrom.pass<ssize_t>(descriptor, buffer, size, flags, from, from_size);
}
ssize_t recvmsg(int descriptor, msghdr* message, int flags) {
  tell_if_blocking("recvmsg", descriptor, flags);
  return next_recvmsg.pass<ssize_t>(descriptor, message, flags);
}
int recvmmsg(int descriptor, mmsghdr* all, unsigned int count, int flags, timespec* timeout) {
  tell_if_blocking("recvmmsg", descriptor, flags);
  return next_recvmmsg.pass<int>(descriptor, all, count, flags, timeout);
}
ssize_t send(int descriptor, const void* buffer, std::size_t size, int flags) {
  tell_if_blocking("send", descriptor, flags);
  return next_send.pass<ssize_t>(descriptor, buffer, size, flags);
}
ssize_t sendto(int descriptor,
               const void* buffer,
               std::size_t size,
               int flags,
               const sockaddr* to,
               socklen_t to_size) {
  tell_if_blocking("sendto", descriptor, flags);
  return next_sendto.pass<ssize_t>(descriptor, buffer, size, flags, to, to_size);
}
ssize_t sendmsg(int descriptor, const msghdr* message, int flags) {
  tell_if_blocking("sendmsg", descriptor, flags);
  return next_sendmsg.pass<ssize_t>(descriptor, message, flags);
}
int sendmmsg(int descriptor, mmsghdr* all, unsigned int count, int flags) {
  tell_if_blocking("sendmmsg", descriptor, flags);
  return next_sendmmsg.pass<int>(descriptor, all, count, flags);
}

// Files and text.
int open(const char* path, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return next_open.call<int>(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return next_open64.call<int>(path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) { return next_fopen.call<FILE*>(path, mode); }
FILE* fopen64(const char* path, const char* mode) { return next_fopen64.call<FILE*>(path, mode); }
std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* file) {
  return next_fwrite.call<std::size_t>(data, size, count, file);
}
int fputs(const char* text, FILE* file) { return next_fputs.call<int>(text, file); }
int puts(const char* text) { return next_puts.call<int>(text); }
int fflush(FILE* file) { return next_fflush.call<int>(file); }
int printf(const char* format, ...) {
  RealtimeGuard::violation("printf");
  std::va_list rest;
  va_start(rest, format);
  const int count = std::vprintf(format, rest);  // NOLINT(*-nonliteral): passed on as it came
  va_end(rest);
  return count;
}
int fprintf(FILE* file, const char* format, ...) {
  RealtimeGuard::violation("fprintf");
  std::va_list rest;
  va_start(rest, format);
  const int count = std::vfprintf(file, format, rest);
  va_end(rest);
  return count;
}

// Exceptions.
[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*destroy)(void*)) {
  next_throw.call<void>(thrown, type, destroy);
  __builtin_unreachable();
}
void* __cxa_allocate_exception(std::size_t size) noexcept {
  RealtimeGuard::violation("throw");
  return next_exception.pass<void*>(size);
}
}
