#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>

#include "common/record/mcap_format.h"

namespace palp::record {

/// Bytes that are wanted only once more, all together at the end. With a file, one without a name
/// in the folder for such, the older ones lie there: a recording of a day takes no more memory than
/// one of a minute. Where none can be had they stay in memory. Thread: its owner's, never rt.
class IndexStore {
 public:
  /// In memory, more than the index of a short recording. [bytes]
  static constexpr std::size_t kKept = std::size_t{64} * 1024;

  explicit IndexStore(bool with_file) : file_{with_file ? std::tmpfile() : nullptr} {}

  /// To append to; whole records, then settle().
  [[nodiscard]] Bytes& newest() noexcept { return newest_; }
  void settle() noexcept;
  /// Everything in order; nothing where the file cannot be read back.
  [[nodiscard]] Bytes all();
  /// [bytes], what lies in the file.
  [[nodiscard]] std::size_t laid_down() const noexcept { return laid_down_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
  };

  Bytes newest_;
  std::unique_ptr<std::FILE, Close> file_;
  std::size_t laid_down_{};  ///< [bytes]
  bool refused_{};
};

}  // namespace palp::record
