// Input: an impairment as text, the text of a timeline, and lines of live control, which are done
// to a path under traffic.
#include "netem/model/impairment.h"

#include <algorithm>
#include <array>

#include "common/core/check.h"
#include "netem/model/channel.h"
#include "netem/model/impairment_model.h"
#include "netem/syntax/timeline.h"
#include "tests/fuzz/fuzz.h"

namespace palp::netem {
namespace {

bool share(double value) { return value >= 0 && value <= 1; }
bool span(Duration value) { return value >= Duration{0} && value <= kTimeMax; }

void limits(const Impairment& impairment) {
  const DelayLaw& delay = impairment.delay;
  PALP_CHECK(span(delay.mean) && span(delay.jitter) && span(delay.correlation_time) &&
                 share(delay.floor) && share(delay.correlation),
             "a delay law keeps its limits");
  for (const Chance& chance : {impairment.loss,
                               impairment.duplicate,
                               impairment.corrupt,
                               impairment.truncate,
                               impairment.reorder.chance,
                               impairment.swap}) {
    PALP_CHECK(share(chance.share) && share(chance.correlation), "probabilities are shares");
  }
  PALP_CHECK(impairment.swap_depth <= kSwapDepthMax, "few are overtaken");
  // Whatever can be said can be decided about.
  ImpairmentModel outcomes{impairment, 1, Direction::Up, TimePoint{}};
  for (int i = 0; i < 8; ++i) {
    const auto copies =
        outcomes.next({.at = TimePoint{std::chrono::milliseconds{i}}, .length = 100, .room = 10});
    for (const CopyOutcome& copy : copies) {
      PALP_CHECK(copy.verdict != Verdict::Delivered || copy.release >= TimePoint{},
                 "nothing leaves before it came");
    }
  }
  PALP_CHECK(impairment.burst.rate >= 0 && impairment.burst.rate <= kBurstRateMax &&
                 span(impairment.burst.length),
             "a burst law keeps its limits");
  const GilbertLaw& gilbert = impairment.gilbert;
  PALP_CHECK(share(gilbert.loss_bad) && share(gilbert.loss_good), "losses are shares");
  PALP_CHECK(gilbert == GilbertLaw{} || (gilbert.good >= kStayMin && gilbert.bad >= kStayMin),
             "stays bound the work per datagram");
  PALP_CHECK(impairment.blackouts.size() <= kBlackoutsMax, "blackouts are few");
  for (const Blackout& blackout : impairment.blackouts) {
    PALP_CHECK(span(blackout.from) && blackout.length > Duration{0}, "a blackout is a span");
  }
}

/// Files would make the input more than itself: every name is a small table, trace or bitmap.
Result<std::string> any_file(const std::string& name) {
  if (name.ends_with(".dist")) return std::string{"-8192 0 8192\n"};
  if (name.starts_with("t")) return std::string{"t_ms,delay_ms\n0,5\n10,7\n"};
  if (name.starts_with("h")) return std::string{"1 2\n2 1\n"};
  if (name.starts_with("b")) return std::string{"0101\n"};
  return fail("no file");
}

/// A few datagrams, `pause` apart, and whoever is due: none is lost sight of.
void pass(Channel& channel, TimePoint& now, Duration pause) {
  const std::array<std::byte, 50> datagram{};
  for (int i = 0; i < 5; ++i, now += pause) {
    (void)channel.push(datagram, now);
    while (channel.pop_in_place(now)) {
    }
  }
  const ChannelCounters& counters = channel.counters();
  PALP_CHECK(counters.pushed + counters.copies == counters.popped + counters.lost +
                                                      counters.header_hit + counters.blackout +
                                                      counters.over_limit + channel.in_flight(),
             "datagrams are conserved");
}

/// Whatever a timeline has is done when its time comes, over hours too.
void run(const PathPlan& plan) {
  Channel channel{plan, 1, Direction::Up, 32, TimePoint{}, 1472};
  TimePoint now{};
  for (const Duration pause : {Duration{std::chrono::milliseconds{7}},
                               Duration{std::chrono::seconds{1}},
                               Duration{std::chrono::hours{1}}}) {
    pass(channel, now, pause);
  }
}

/// Whatever can be said line by line while a path runs can be done to it.
void say_all(std::string_view text, std::string_view beginning) {
  Impairment law = *parse_impairment(beginning);
  Channel channel{law, 1, Direction::Up, 32};
  TimePoint now{};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto request =
        parse_control_line(text.substr(0, end), {.up = law, .down = law}, any_file);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!request || request->kind != ControlRequest::Kind::Change) continue;
    const Change& change = request->up ? request->change_up : request->change_down;
    PreparedChange prepared = prepare(change);
    if (prepared.law) law = change.impairment;
    channel.apply(prepared, now);
    pass(channel, now, std::chrono::milliseconds{2});
  }
}

void round_trip(const Impairment& impairment) {
  const std::string words = to_string(impairment);
  const auto again = parse_impairment(words, Mode::Exact, any_file);
  PALP_CHECK(again.has_value(), "the words of an impairment are understood");
  PALP_CHECK(*again == impairment, "the words give exactly the same impairment");
  PALP_CHECK(to_string(*again) == words, "the same impairment has the same words");
}

}  // namespace
}  // namespace palp::netem

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = palp::fuzz::as_text(data, size);
  if (const auto impairment =
          palp::netem::parse_impairment(text, palp::netem::Mode::Exact, palp::netem::any_file)) {
    palp::netem::limits(*impairment);
    palp::netem::round_trip(*impairment);
  } else {
    PALP_CHECK(!impairment.error().text.empty(), "a refusal says why");
  }
  const auto no_preset = [](const std::string&) -> palp::Result<palp::netem::Timeline> {
    return palp::fail("no preset");
  };
  if (const auto timeline =
          palp::netem::parse_timeline("fuzz", text, no_preset, palp::netem::any_file)) {
    for (const auto& plan : {timeline->up, timeline->down}) {
      palp::netem::limits(plan.impairment);
      for (const auto& change : plan.changes) palp::netem::limits(change.impairment);
      palp::netem::run(plan);
    }
  } else {
    PALP_CHECK(!timeline.error().text.empty(), "a refusal says why");
  }
  if (const auto request = palp::netem::parse_control_line(text, {}, palp::netem::any_file)) {
    palp::netem::limits(request->change_up.impairment);
  } else {
    PALP_CHECK(!request.error().text.empty(), "a refusal says why");
  }
  for (const char* beginning : {"none", "mode netem-6.1 delay 5ms"}) {
    palp::netem::say_all(text, beginning);
  }
  return 0;
}
