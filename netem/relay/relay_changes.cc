#include "netem/relay/relay_changes.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/config/report.h"
#include "netem/relay/relay_report.h"

namespace palp::netem {
namespace {

constexpr std::size_t kWaitingMax = 4096;
/// So many the relay may have at a time: its queues hold more.
constexpr std::size_t kUnderwayMax = 32;
/// So long before its time a change is handed over, so that this thread's pauses do not make it
/// late; preparing a law takes up to 15 ms.
constexpr Duration kAhead = std::chrono::milliseconds{40};
/// Above the places of any plan.
constexpr std::uint64_t kOwnLaws = std::uint64_t{1} << 32U;

}  // namespace

const Impairment& RelayChanges::law(std::size_t way) const {
  const std::uint64_t number = relay_.law_numbers[way].load(std::memory_order_relaxed);
  const PathPlan& plan = *plans_[way];
  if (number > 0 && number <= plan.changes.size()) return plan.changes[number - 1].impairment;
  const auto own = own_laws_[way].find(number);
  return own == own_laws_[way].end() ? plan.impairment : own->second;
}

ControlContext RelayChanges::laws() const { return {.up = law(0), .down = law(1)}; }

bool RelayChanges::hold(const ControlRequest& request,
                        std::string_view line,
                        std::uint64_t number) {
  if (waiting_.size() >= kWaitingMax) return false;
  const TimePoint now = monotonic_now();
  const Change& asked = request.up ? request.change_up : request.change_down;
  const TimePoint at = request.now ? now : std::max(now, relay_.start() + asked.at);
  const auto place = std::upper_bound(
      waiting_.begin(), waiting_.end(), at, [](TimePoint time, const Waiting& one) {
        return time < one.at;
      });
  waiting_.insert(place, {at, number, std::string{line}, request.now, request.stands_on_law});
  return true;
}

void RelayChanges::work(TimePoint now, const Reply& reply) {
  hear(reply);
  while (!waiting_.empty() && commands_underway_ + 2 <= kUnderwayMax) {
    const Waiting& next = waiting_.front();
    // What stands on the law that holds then has to wait until that is known.
    if (next.at > now + (next.stands_on_law ? Duration{} : kAhead)) return;
    if (next.stands_on_law && commands_underway_ > 0) return;
    if (const auto handed = hand_over(next); !handed) {
      reply(next.number, error_line(handed.error().text));
    }
    waiting_.erase(waiting_.begin());
  }
}

/// Read again: a law takes memory while it waits, and a trace stands on the law that holds now.
Result<void> RelayChanges::hand_over(const Waiting& change) {
  const auto request = read(change.line);
  if (!request) return tl::unexpected<Error>(request.error());
  const Change& asked = request->up ? request->change_up : request->change_down;
  const bool down = request->down && !(request->up && asked.kind == Change::Kind::Rebind);
  Underway underway;
  if (!change.now) underway.asked_s = seconds(asked.at);
  if (request->up && enqueue(request->change_up, Direction::Up, change)) ++underway.ways;
  if (down && enqueue(request->change_down, Direction::Down, change)) ++underway.ways;
  if (underway.ways == 0) return fail("the relay takes no changes");
  commands_underway_ += underway.ways;
  underway_[change.number] = underway;
  return {};
}

bool RelayChanges::enqueue(const Change& change, Direction direction, const Waiting& waiting) {
  RelayCommand command{prepare(change), direction, waiting.at, waiting.line, waiting.number};
  if (command.change.law) {
    command.change.law_number = kOwnLaws + own_laws_made_++;
    own_laws_[static_cast<std::size_t>(direction)][command.change.law_number] = change.impairment;
  }
  return relay_.commands.try_enqueue(std::move(command));
}

void RelayChanges::hear(const Reply& reply) {
  RelayCommand spent;
  while (relay_.spent.try_dequeue(spent)) {
    --commands_underway_;
    const double applied_s = seconds(spent.at - relay_.start());
    char when[40];
    std::snprintf(when, sizeof when, "%.3f s, ", applied_s);
    log_.push_back(when + std::string{spent.direction == Direction::Up ? "up: " : "down: "} +
                   spent.words + '\n');
    const auto found = underway_.find(spent.number);
    if (found == underway_.end() || --found->second.ways > 0) continue;
    std::string text = "{\"applied_at_s\":" + config::json_number(applied_s);
    if (found->second.asked_s) text += ",\"at_s\":" + config::json_number(*found->second.asked_s);
    reply(spent.number, text + "}");
    underway_.erase(found);
  }
  if (commands_underway_ > 0) return;
  for (const std::size_t way : {0U, 1U}) {
    const std::uint64_t held = relay_.law_numbers[way].load(std::memory_order_relaxed);
    std::erase_if(own_laws_[way], [held](const auto& one) { return one.first != held; });
  }
}

std::vector<std::string> RelayChanges::take_log() { return std::exchange(log_, {}); }

}  // namespace palp::netem
