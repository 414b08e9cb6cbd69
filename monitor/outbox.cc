#include "monitor/outbox.h"

#include <iterator>
#include <utility>

namespace palp::monitor {

void Outbox::push(Frame frame) {
  waiting_ += frame.body.size();
  if (!frame.passing) ++staying_;
  frames_.push_back(std::move(frame));
  auto one = std::next(frames_.begin(), sending_ ? 1 : 0);
  while (waiting_ > bound_ && one != frames_.end() && std::next(one) != frames_.end()) {
    if (!one->passing) {
      ++one;
      continue;
    }
    broken_ = broken_ || one->chained;
    give_way(one);
  }
  if (!broken_) return;
  for (one = std::next(frames_.begin(), sending_ ? 1 : 0); one != frames_.end();) {
    one->chained ? give_way(one) : void(++one);
  }
}

void Outbox::give_way(std::list<Frame>::iterator& one) {
  waiting_ -= one->body.size();
  ++dropped_;
  one = frames_.erase(one);
}

void Outbox::pop() {
  waiting_ -= frames_.front().body.size();
  if (!frames_.front().passing) --staying_;
  frames_.pop_front();
  sending_ = false;
}

}  // namespace palp::monitor
