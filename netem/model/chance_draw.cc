#include "netem/model/chance_draw.h"

#include <algorithm>
#include <cmath>

namespace palp::netem {

ChanceDraw::ChanceDraw(const Impairment& law, const Streams& streams) noexcept
    : law_{&law},
      streams_{streams},
      duplicate_{law.duplicate, streams.of(Stage::Duplicate)},
      loss_{law.loss, streams.of(Stage::Loss)},
      corrupt_{law.corrupt, streams.of(Stage::Corrupt)},
      truncate_{law.truncate, streams.of(Stage::Truncate)},
      reorder_{law.reorder.chance, streams.of(Stage::Reorder)},
      swap_{law.swap, streams.of(Stage::Swap)},
      state_{law.state.value_or(FourStateLaw{}), streams.of(Stage::StateSteps)},
      gemodel_{law.gemodel.value_or(GemodelLaw{}), streams.of(Stage::GemodelSteps)} {}

void ChanceDraw::change(const Impairment& law, std::uint64_t index) noexcept {
  catch_up(index);
  wake();
  law_ = &law;
  duplicate_.change(law.duplicate);
  loss_.change(law.loss);
  corrupt_.change(law.corrupt);
  truncate_.change(law.truncate);
  reorder_.change(law.reorder.chance);
  swap_.change(law.swap);
  state_.change(law.state.value_or(FourStateLaw{}));
  gemodel_.change(law.gemodel.value_or(GemodelLaw{}));
}

void ChanceDraw::lean(const Impairment& towards, double share, std::uint64_t index) noexcept {
  catch_up(index);
  wake();
  const auto mix = [share](const Chance& one, const Chance& to) {
    return Chance{std::lerp(one.share, to.share, share),
                  std::lerp(one.correlation, to.correlation, share)};
  };
  loss_.lean(mix(law_->loss, towards.loss));
  duplicate_.lean(mix(law_->duplicate, towards.duplicate));
  corrupt_.lean(mix(law_->corrupt, towards.corrupt));
}

/// Tells the processes how many datagrams passed without asking them.
void ChanceDraw::catch_up(std::uint64_t index) noexcept {
  const std::uint64_t passed = index - asked_;
  for (ChanceProcess* process : {&duplicate_, &loss_, &truncate_, &corrupt_}) process->skip(passed);
  state_.skip(passed);
  gemodel_.skip(passed);
  if (law_->reorder.gap == 1) reorder_.skip(passed);
  if (law_->order == Order::Swap) swap_.skip(passed);
  asked_ = index;
}

Chances ChanceDraw::next(std::uint64_t index) noexcept {
  catch_up(index);
  const Chances chances{.duplicate = duplicate_.next(),
                        .lost = loss_.next(),
                        .swept = state_.next(),
                        .loss_gemodel = gemodel_.next(),
                        .cut = truncate_.next(),
                        .flipped = corrupt_.next(),
                        .jumps = law_->reorder.gap > 0 && jumps(),
                        .swaps = law_->order == Order::Swap && swap_.next()};
  asked_ = index + 1;
  quiet_end_ = asked_ + quiet_run();
  return chances;
}

/// Of every datagram, lost or not, so that losses move no other draw.
bool ChanceDraw::jumps() noexcept {
  if (++since_reorder_ < law_->reorder.gap || !reorder_.next()) return false;
  since_reorder_ = 0;
  return true;
}

/// How many of the next none has anything to say about.
std::uint64_t ChanceDraw::quiet_run() const noexcept {
  std::uint64_t quiet = std::min({duplicate_.quiet(),
                                  loss_.quiet(),
                                  truncate_.quiet(),
                                  corrupt_.quiet(),
                                  state_.quiet(),
                                  gemodel_.quiet()});
  if (law_->reorder.gap > 0) quiet = law_->reorder.gap == 1 ? std::min(quiet, reorder_.quiet()) : 0;
  if (law_->order == Order::Swap) quiet = std::min(quiet, swap_.quiet());
  return quiet;
}

Chances ChanceDraw::of_copy(const Chances& original,
                            std::size_t copy,
                            std::uint64_t index) const noexcept {
  return {.lost = loss_.aside(streams_.of(Stage::Loss, copy), index),
          .swept = original.swept,
          .loss_gemodel = original.loss_gemodel,
          .cut = truncate_.aside(streams_.of(Stage::Truncate, copy), index),
          .flipped = corrupt_.aside(streams_.of(Stage::Corrupt, copy), index)};
}

}  // namespace palp::netem
