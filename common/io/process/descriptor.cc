#include "common/io/process/descriptor.h"

#include <unistd.h>

namespace palp::io {

void Descriptor::close() noexcept {
  if (number_ >= 0) {
    ::close(std::exchange(number_, -1));
  }
}

}  // namespace palp::io
