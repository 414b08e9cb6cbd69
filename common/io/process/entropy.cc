#include "common/io/process/entropy.h"

#include <cerrno>
#include <stdexcept>

#include <sys/random.h>

#include "common/io/process/system_text.h"

namespace palp::io {

std::uint64_t draw_entropy() {
  std::uint64_t bits = 0;
  if (getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) {
    throw std::runtime_error{"the kernel gives no random bits: " + system_text(errno)};
  }
  return bits;
}

}  // namespace palp::io
