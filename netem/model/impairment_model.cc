#include "netem/model/impairment_model.h"

#include <algorithm>

#include "common/core/check.h"

namespace palp::netem {
namespace {

std::variant<ExactModel, KernelModel> make_model(const PreparedLaw& law,
                                                 const Streams& streams,
                                                 TimePoint start) {
  if (law.impairment.mode == Mode::Netem61) return KernelModel{law, streams};
  return ExactModel{law, streams, start};
}

}  // namespace

ImpairmentModel::ImpairmentModel(const Impairment& impairment,
                                 std::uint64_t seed,
                                 Direction direction,
                                 TimePoint start)
    : first_law_{std::make_unique<const PreparedLaw>(impairment)},
      law_{first_law_.get()},
      model_{make_model(*law_, Streams{seed, direction}, start)} {}

void ImpairmentModel::change(const PreparedLaw& law) noexcept {
  PALP_CHECK(law.impairment.mode == law_->impairment.mode, "a change keeps the mode");
  law_ = &law;
  if (auto* exact = std::get_if<ExactModel>(&model_)) exact->change(law);
  if (auto* kernel = std::get_if<KernelModel>(&model_)) kernel->change(law);
}

void ImpairmentModel::lean(const PreparedLaw& towards, double share) noexcept {
  if (auto* exact = std::get_if<ExactModel>(&model_)) exact->lean(towards, share);
}

void ImpairmentModel::flood(std::size_t copies) noexcept {
  if (auto* exact = std::get_if<ExactModel>(&model_)) {
    exact->flood(std::min(copies, kCopiesMax - 2));
  }
}

}  // namespace palp::netem
