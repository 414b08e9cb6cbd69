#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <variant>

#include "common/link/telegram.h"
#include "common/message/given.h"

namespace palp::record {

/// Holds a tick and what it was given until its link was heard: then it is one message. Thread: the
/// writer's.
class GivenGatherer {
 public:
  explicit GivenGatherer(link::Role site) : site_{site} {}

  [[nodiscard]] link::Role site() const noexcept { return site_; }

  /// What is held cannot be of one message with `record`: it has to be written by itself first.
  [[nodiscard]] bool stands_in_the_way_of(const Record& record) const;
  /// A third sample: the first one has to be written by itself. @returns it.
  std::optional<Record> crowded_out_by(const Record& record) noexcept;
  /// @returns false: `record` is none that is held.
  bool take(const Record& record) noexcept;
  /// The tick's link was heard: its message can be written.
  [[nodiscard]] bool whole() const noexcept { return part<LinkHeard>() != nullptr; }
  [[nodiscard]] SurgeonFileTick surgeon() const noexcept;
  [[nodiscard]] PatientFileTick patient() const noexcept;

  /// What is held, the oldest first.
  [[nodiscard]] std::span<const Record> held() const noexcept { return {held_.data(), size_}; }
  void clear() noexcept { size_ = 0; }

 private:
  static constexpr std::size_t kPartsMax = 6;

  /// nullptr: none is held.
  template <class Part>
  [[nodiscard]] const Part* part() const noexcept {
    for (const Record& record : held()) {
      if (const auto* found = std::get_if<Part>(&record)) return found;
    }
    return nullptr;
  }
  [[nodiscard]] bool readings() const noexcept;
  [[nodiscard]] std::size_t samples() const noexcept;
  template <class FileTick>
  void add_rest(FileTick& made) const noexcept;

  link::Role site_;
  std::array<Record, kPartsMax> held_;
  std::size_t size_{};
};

}  // namespace palp::record
