#include "netem/model/delay_sequence.h"

#include <cmath>

namespace palp::netem {

void DelaySequence::change(const PreparedLaw& law) noexcept {
  law_ = &law;
  trace_.rewind();
  const DelayLaw& delay = law.impairment.delay;
  mean_ = law.curve.mean();
  jitter_ = law.curve.jitter();
  least_ = delay.floor * mean_;
  choose_source(delay.jitter > Duration{} || delay.shape == DelayShape::Histogram);
  carry_ = law.carry;
  share_ = std::sqrt(1 - carry_ * carry_);
  carry_gap_ = Duration{-1};
  ahead_end_ = 0;
}

void DelaySequence::choose_source(bool random) noexcept {
  const DelayLaw& delay = law_->impairment.delay;
  const Source before = source_;
  if (!law_->impairment.trace.points.empty()) {
    source_ = Source::Trace;
  } else if (!random) {
    source_ = Source::Mean;
  } else if (law_->carry > 0 || delay.correlation_time > Duration{}) {
    source_ = Source::Correlated;
  } else {
    source_ = law_->curve.by_normal() ? Source::Normal : Source::Share;
  }
  if (source_ != before) ahead_end_ = 0;
}

void DelaySequence::lean(const PreparedLaw& towards, double share) noexcept {
  const auto between = [share](double from, double to) { return from + share * (to - from); };
  // Of the curves: a histogram says neither in words.
  mean_ = between(law_->curve.mean(), towards.curve.mean());
  jitter_ = between(law_->curve.jitter(), towards.curve.jitter());
  least_ = between(law_->impairment.delay.floor, towards.impairment.delay.floor) * mean_;
  choose_source(jitter_ > 0);
}

/// Prepares the step of the correlated process over a gap other than the last one.
void DelaySequence::correlate(Duration gap) noexcept {
  const Duration memory = law_->impairment.delay.correlation_time;
  carry_gap_ = gap;
  if (memory == Duration{}) return;
  const double span = seconds(gap) / seconds(memory);
  carry_ = std::exp(-span);
  share_ = std::sqrt(-std::expm1(-2 * span));
  ahead_end_ = index_;  // of the steps drawn ahead none is right
  ahead_count_ = 0;
}

/// What the delay of datagram `index` is made of: where it hangs on the last one's a standard
/// normal, else its distance from the mean in units of the jitter.
double DelaySequence::fresh(RandomStream stream, std::uint64_t index) const noexcept {
  const std::uint64_t bits = stream.bits(index);
  if (source_ == Source::Share) return law_->curve.at_share(random_middle(bits));
  const double normal = law_->normal.at(bits);
  return source_ == Source::Normal ? law_->curve.at_normal(normal) : normal;
}

/// One after the other each would wait for its tables; many at once wait together. Only as many as
/// will be right if the gaps stay as they are: after one that changed the next is all that is
/// known, then twice as many each time.
void DelaySequence::look_ahead() noexcept {
  const bool by_gap = remembers() && law_->impairment.delay.correlation_time > Duration{};
  ahead_count_ = by_gap ? std::clamp<std::size_t>(2 * ahead_count_, 1, kAhead) : kAhead;
  ahead_end_ = index_ + ahead_count_;
  double z = z_before_;
  for (std::size_t i = 0; i < ahead_count_; ++i) {
    const std::size_t place = kAhead - ahead_count_ + i;
    ahead_[place] = fresh(stream_, index_ + i);
    if (!remembers()) continue;
    z = follows_ || i > 0 ? carry_ * z + share_ * ahead_[place] : ahead_[place];
    normals_[place] = z;
  }
  if (!remembers()) return;
  begun_ = true;
  for (std::size_t place = kAhead - ahead_count_; place < kAhead; ++place) {
    ahead_[place] = law_->curve.at_normal(normals_[place]);
  }
}

/// A sibling of its original in the correlated process leaves no trace in it.
double DelaySequence::around(std::size_t copy) const noexcept {
  const double drawn = fresh(streams_.of(Stage::Delay, copy), index_);
  if (!remembers()) return drawn;
  return law_->curve.at_normal(follows_ ? carry_ * z_before_ + share_ * drawn : drawn);
}

Duration DelaySequence::traced(TimePoint onward, std::size_t copy) noexcept {
  const DelayTrace& trace = law_->impairment.trace;
  Duration delay = trace_.delay(trace, onward - start_);
  if (trace.dither) {
    delay += nearest((streams_.of(Stage::Dither, copy).uniform(index_) - 0.5) * 1e6 + 1e9) -
             Duration{1'000'000'000};
  }
  return std::max(delay, Duration{});
}

}  // namespace palp::netem
