#include "common/record/file_bytes.h"

#include <algorithm>

#include <sys/mman.h>
#include <unistd.h>

namespace palp::record {

void FileBytes::forget(std::size_t begin, std::size_t end) const noexcept {
  if (!mapped_) return;
  // A mapping begins with a page. A page of which a byte is still wanted stays.
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t from = begin / page * page;
  const std::size_t to = std::min(end, bytes_.size()) / page * page;
  if (to <= from) return;
  // Clean pages of a file: the system reads them again where they are looked at again.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): nothing is written
  (void)::madvise(const_cast<std::byte*>(bytes_.data()) + from, to - from, MADV_DONTNEED);
}

}  // namespace palp::record
