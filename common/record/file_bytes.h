#pragma once

#include <concepts>
#include <cstddef>
#include <span>

namespace palp::record {

/// The bytes of a file, in memory or mapped (MappedFile). A view: what it looks at outlives it.
class FileBytes {
 public:
  FileBytes() = default;
  template <class Range>
  requires(std::convertible_to<const Range&, std::span<const std::byte>> &&
           !std::same_as<Range, FileBytes>)
      // NOLINTNEXTLINE(google-explicit-constructor): as a span is made of a range
      FileBytes(const Range& bytes)
      : bytes_{bytes} {}
  [[nodiscard]] static FileBytes of_mapping(std::span<const std::byte> bytes) noexcept {
    FileBytes mapped{bytes};
    mapped.mapped_ = true;
    return mapped;
  }

  // NOLINTNEXTLINE(google-explicit-constructor): it is such a span
  operator std::span<const std::byte>() const noexcept { return bytes_; }
  [[nodiscard]] std::size_t size() const noexcept { return bytes_.size(); }  ///< [bytes]
  [[nodiscard]] bool empty() const noexcept { return bytes_.empty(); }

  /// The memory of a mapping's bytes [`begin`, `end`) is not needed for now; they stay readable.
  void forget(std::size_t begin, std::size_t end) const noexcept;

 private:
  std::span<const std::byte> bytes_;
  bool mapped_{};
};

}  // namespace palp::record
