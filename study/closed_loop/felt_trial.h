#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/result.h"
#include "study/study_file.h"
#include "study/trial_row.h"

/// A trial as a whole session in virtual time: the sites' own programs, a link, a tissue with two
/// places, a hand with a will.
namespace palp::study {

/// What stands at both places, and how the hand goes about it.
struct FeltSetting {
  std::array<double, 2> ln_stiffness{};  ///< [-], of each interval's tissue over the plain one
  std::array<std::vector<double>, 2> depth{};  ///< [m], aimed at in plain tissue, of each tap
  std::uint64_t seed{};                        ///< of the session's noise
};

/// What came of it.
struct FeltTrial {
  std::array<std::vector<double>, 2> ln_slopes{};  ///< [ln N/m], as felt in each interval
  double duration{};                               ///< [s], to the question
  int taps{};
  double force_max{};  ///< [N]
  double contact{};    ///< [s]
};

/// Sessions of one condition, which is read once. Thread: any, feel() at once too.
class FeltSession {
 public:
  [[nodiscard]] static Result<FeltSession> make(const Condition& condition);
  FeltSession(FeltSession&& other) noexcept;
  FeltSession& operator=(FeltSession&& other) noexcept;
  ~FeltSession();

  /// Both intervals over the link, through the stages of a Trial.
  [[nodiscard]] FeltTrial feel(const FeltSetting& setting) const;
  /// The same hand at the same tissue with its own finger: no device, no link, no stage.
  [[nodiscard]] FeltTrial touch(const FeltSetting& setting) const;
  [[nodiscard]] int taps() const noexcept { return taps_; }

 private:
  struct Parts;
  FeltSession(std::unique_ptr<Parts> parts, int taps) noexcept;

  std::unique_ptr<Parts> parts_;
  int taps_;
};

}  // namespace palp::study
