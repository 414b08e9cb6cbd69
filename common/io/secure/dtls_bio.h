#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace palp::io {

/// What OpenSSL reads from and writes to: whole datagrams, where a memory BIO would glue them.
struct DatagramBox {
  std::deque<std::vector<std::byte>> in;
  std::vector<std::vector<std::byte>> out;
};

}  // namespace palp::io
