#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palp::record {

/// What the sequence numbers of a topic say of its messages: writers count them 0, 1, 2, ...
/// Thread: any one.
class SequenceCount {
 public:
  /// `first`: the number with which the part begins that is looked at.
  explicit SequenceCount(std::uint32_t first = 0) noexcept : next_{first} {}

  /// The number of the next message in the file.
  void see(std::uint32_t sequence);

  /// Numbers below the greatest that no message had.
  [[nodiscard]] std::uint64_t missing() const noexcept { return missing_; }
  /// Messages that stand behind one of a greater number: twice there, or not in their order.
  [[nodiscard]] std::uint64_t disordered() const noexcept { return disordered_; }

 private:
  void fill(std::uint32_t sequence);

  struct Gap {
    std::uint32_t from{};
    std::uint32_t to{};  ///< not in it
  };
  /// Kept of a file that has more; what comes late into others counts as twice there.
  static constexpr std::size_t kGapsMax = 1024;
  std::vector<Gap> gaps_;
  std::uint64_t next_{};
  std::uint64_t missing_{};
  std::uint64_t disordered_{};
};

}  // namespace palp::record
