#pragma once

#include <concepts>
#include <memory>
#include <utility>

#include "common/coupling/coupling.h"

/// Laws that are none of the closed set (any_coupling.h): who tries one in the lab need not enter
/// it there. No site makes one.
namespace palp::coupling {

/// Who is asked first whether it is another type is not asked for ever whether it can be copied.
template <class Law, class Half, class Input, class Output>
concept OtherLaw = !std::same_as<Law, Half> && HalfOfLaw<Law, Input, Output>;

/// A half of a law of any type. A copy of it copies the half, and allocates; a step and a move do
/// not. Thread: its law's. A value.
template <class Input, class Output>
class OutsideHalf {
 public:
  template <OtherLaw<OutsideHalf, Input, Output> Law>
  explicit OutsideHalf(Law law) : half_{std::make_unique<Of<Law>>(std::move(law))} {}
  OutsideHalf(const OutsideHalf& other) : half_{other.half_->copy()} {}
  OutsideHalf(OutsideHalf&& other) noexcept = default;
  OutsideHalf& operator=(const OutsideHalf& other) {
    if (this != &other) half_ = other.half_->copy();
    return *this;
  }
  OutsideHalf& operator=(OutsideHalf&& other) noexcept = default;
  ~OutsideHalf() = default;

  void begin_epoch(double position) noexcept { half_->begin_epoch(position); }
  Output step(const Input& in, const Lapse& lapse) noexcept { return half_->step(in, lapse); }

 private:
  class Half {
   public:
    Half() = default;
    Half(const Half&) = delete;
    Half(Half&&) = delete;
    Half& operator=(const Half&) = delete;
    Half& operator=(Half&&) = delete;
    virtual ~Half() = default;
    [[nodiscard]] virtual std::unique_ptr<Half> copy() const = 0;
    virtual void begin_epoch(double position) noexcept = 0;
    virtual Output step(const Input& in, const Lapse& lapse) noexcept = 0;
  };
  template <class Law>
  class Of final : public Half {
   public:
    explicit Of(Law law) : law_{std::move(law)} {}
    [[nodiscard]] std::unique_ptr<Half> copy() const override { return std::make_unique<Of>(law_); }
    void begin_epoch(double position) noexcept override { law_.begin_epoch(position); }
    Output step(const Input& in, const Lapse& lapse) noexcept override {
      return law_.step(in, lapse);
    }

   private:
    Law law_;
  };

  std::unique_ptr<Half> half_;  ///< none only where it was moved from
};

using OutsideSurgeon = OutsideHalf<SurgeonInput, SurgeonOutput>;
using OutsidePatient = OutsideHalf<PatientInput, PatientOutput>;

/// Both halves.
struct OutsideLaw {
  OutsideSurgeon surgeon;
  OutsidePatient patient;
};

static_assert(HalfOfLaw<OutsideSurgeon, SurgeonInput, SurgeonOutput>);
static_assert(HalfOfLaw<OutsidePatient, PatientInput, PatientOutput>);

}  // namespace palp::coupling
