#pragma once

#include <algorithm>
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
      constexpr FileBytes(const Range& bytes)
      : bytes_{bytes} {}
  [[nodiscard]] static FileBytes of_mapping(std::span<const std::byte> bytes) noexcept {
    FileBytes mapped{bytes};
    mapped.mapped_ = true;
    return mapped;
  }

  // NOLINTNEXTLINE(google-explicit-constructor): it is such a span
  operator std::span<const std::byte>() const noexcept { return bytes_; }
  [[nodiscard]] const std::byte* data() const noexcept { return bytes_.data(); }
  [[nodiscard]] std::size_t size() const noexcept { return bytes_.size(); }  ///< [bytes]
  [[nodiscard]] bool empty() const noexcept { return bytes_.empty(); }

  /// `size` of them from `begin` on, which are there.
  [[nodiscard]] FileBytes part(std::size_t begin, std::size_t size) const noexcept {
    FileBytes one{bytes_.subspan(begin, size)};
    one.mapped_ = mapped_;
    return one;
  }

  /// The memory of a mapping's bytes [`begin`, `end`) is not needed for now; they stay readable.
  void forget(std::size_t begin, std::size_t end) const noexcept;

  /// `use(piece)` for one piece after the other: of many bytes only a piece at a time is in memory.
  void in_pieces(const auto& use) const {
    for (std::size_t at = 0; at < bytes_.size(); at += kPieceSize) {
      const std::size_t size = std::min(kPieceSize, bytes_.size() - at);
      use(bytes_.subspan(at, size));
      if (size == kPieceSize) forget(at, at + size);
    }
  }
  static constexpr std::size_t kPieceSize = std::size_t{1} << 20U;  ///< [bytes]

 private:
  std::span<const std::byte> bytes_;
  bool mapped_{};
};

}  // namespace palp::record
