#include "study/block.h"

#include <algorithm>
#include <cmath>

#include "common/core/check.h"

namespace palp::study {

Block::Block(const Study& study, const AnswerTable& table, const BlockPlan& plan)
    : study_{&study}, plan_{&plan} {
  Method method = study.method;
  if (study.task.yes_no) method.constant_from = 1;  // at 0 nothing lies: the schedule says when
  method.stop = {.trials_min = study.trials, .trials_max = study.trials};
  for (std::size_t i = 0; i < study.tracks; ++i) {
    tracks_.emplace_back(table, method, study.seed, plan.stream + i);
  }
}

bool Block::practised() const noexcept {
  const Practice& rule = study_->practice;
  if (rule.right == 0) return true;
  const auto last = static_cast<std::ptrdiff_t>(std::min(rule.of, practice_.size()));
  return static_cast<std::size_t>(std::count(practice_.end() - last, practice_.end(), true)) >=
         rule.right;
}

bool Block::excluded() const noexcept {
  return !practised() && practice_.size() >= plan_->practice.size();
}

bool Block::done() const noexcept { return excluded() || trials_ >= plan_->trials.size(); }

TrialAsk Block::next() const {
  PALP_CHECK(!done(), "there is a next trial until the block is done");
  const bool practice = !practised();
  const Slot& slot = practice ? plan_->practice[practice_.size()] : plan_->trials[trials_];
  TrialAsk ask{.kind = slot.kind,
               .number = answered(),
               .track = slot.track,
               .level = 0,
               .stronger = slot.stronger,
               .decoy = slot.decoy,
               .hidden = slot.hidden,
               .before = trials_,
               .count = plan_->trials.size()};
  const Track& track = tracks_[slot.track];
  const AnswerTable& table = track.posterior().table();
  if (slot.kind == TrialKind::Trial) {
    ask.level = table.levels()[track.next()];
  } else {
    ask.level = slot.kind == TrialKind::Practice
                    ? table.levels()[table.nearest(study_->practice.level)]
                    : table.levels().back();
    // Easy is a level of either sign where the question is which is stiffer.
    if (study_->task.two_sided && slot.stronger == 0) ask.level = -ask.level;
  }
  if (study_->task.yes_no && slot.stronger == 0) ask.level = 0;
  return ask;
}

void Block::told(bool yes) {
  const TrialAsk ask = next();
  if (ask.kind == TrialKind::Practice) {
    practice_.push_back(study_->task.two_sided ? yes == (ask.stronger == 1) : yes);
    return;
  }
  if (ask.kind == TrialKind::Trial) {
    Track& track = tracks_[ask.track];
    if (study_->task.yes_no && ask.stronger == 0) {
      track.heard(0, yes);
    } else {
      track.told(track.next(), yes);
    }
  }
  ++trials_;
}

Marginal Block::believed(std::size_t track) const { return tracks_[track].posterior().ln_jnd(); }

}  // namespace palp::study
