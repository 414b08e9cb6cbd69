#include "netem/fate.h"

#include <algorithm>

#include "common/core/check.h"

namespace palp::netem {
namespace {

std::variant<ExactFates, KernelFates> make_fates(const PreparedLaw& law,
                                                 const Streams& streams,
                                                 TimePoint start) {
  if (law.impairment.mode == Mode::Netem61) return KernelFates{law, streams};
  return ExactFates{law, streams, start};
}

}  // namespace

FateSequence::FateSequence(const Impairment& impairment,
                           std::uint64_t seed,
                           Direction direction,
                           TimePoint start)
    : first_law_{std::make_unique<const PreparedLaw>(impairment)},
      law_{first_law_.get()},
      fates_{make_fates(*law_, Streams{seed, direction}, start)} {}

void FateSequence::change(const PreparedLaw& law) noexcept {
  PALP_CHECK(law.impairment.mode == law_->impairment.mode, "a change keeps the mode");
  law_ = &law;
  if (auto* exact = std::get_if<ExactFates>(&fates_)) exact->change(law);
  if (auto* kernel = std::get_if<KernelFates>(&fates_)) kernel->change(law);
}

void FateSequence::lean(const PreparedLaw& towards, double share) noexcept {
  if (auto* exact = std::get_if<ExactFates>(&fates_)) exact->lean(towards, share);
}

void FateSequence::flood(std::size_t copies) noexcept {
  if (auto* exact = std::get_if<ExactFates>(&fates_)) {
    exact->flood(std::min(copies, kCopiesMax - 2));
  }
}

}  // namespace palp::netem
