#include "monitor/outbox.h"

#include <iterator>
#include <utility>

namespace palp::monitor {

void Outbox::push(Frame frame) {
  if (frame.chained && chained_ >= kChainedMax) {
    ++dropped_;
    return break_chain();
  }
  waiting_ += frame.body.size();
  if (!frame.passing) ++staying_;
  if (frame.chained) ++chained_;
  frames_.push_back(std::move(frame));
  bool broken = false;
  auto one = std::next(frames_.begin(), sending_ ? 1 : 0);
  while (waiting_ > bound_ && one != frames_.end() && std::next(one) != frames_.end()) {
    if (!one->passing) {
      ++one;
      continue;
    }
    broken = broken || one->chained;
    give_way(one);
  }
  if (broken) break_chain();
}

void Outbox::give_way(std::list<Frame>::iterator& one) {
  waiting_ -= one->body.size();
  if (one->chained) --chained_;
  ++dropped_;
  one = frames_.erase(one);
}

void Outbox::break_chain() {
  broken_ = true;
  for (auto one = std::next(frames_.begin(), sending_ ? 1 : 0); one != frames_.end();) {
    one->chained ? give_way(one) : void(++one);
  }
}

void Outbox::pop() {
  waiting_ -= frames_.front().body.size();
  if (!frames_.front().passing) --staying_;
  if (frames_.front().chained) --chained_;
  frames_.pop_front();
  sending_ = false;
}

}  // namespace palp::monitor
