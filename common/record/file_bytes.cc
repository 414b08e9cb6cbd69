#include "common/record/file_bytes.h"

#include <algorithm>
#include <cstdint>

#include <sys/mman.h>
#include <unistd.h>

namespace palp::record {

void FileBytes::forget(std::size_t begin, std::size_t end) const noexcept {
  if (!mapped_) return;
  // Whole pages. The last one stays: more of it may be wanted.
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): where a page begins
  const auto base = reinterpret_cast<std::uintptr_t>(bytes_.data());
  const std::uintptr_t from = (base + begin) / page * page;
  const std::uintptr_t to = (base + std::min(end, bytes_.size())) / page * page;
  if (to <= from) return;
  // Clean pages of a file: the system reads them again where they are looked at again.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast,performance-no-int-to-ptr): as above
  (void)::madvise(reinterpret_cast<void*>(from), to - from, MADV_DONTNEED);
}

}  // namespace palp::record
