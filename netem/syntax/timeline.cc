#include "netem/syntax/timeline.h"

#include <algorithm>
#include <cmath>

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include "proto/timeline.pb.h"

namespace palp::netem {
namespace {

using google::protobuf::TextFormat;
using proto::timeline::TimelineEvent;

constexpr double kTimeMaxS = 1e6;
constexpr std::uint32_t kCopiesInFloodMax = 15;  // kCopiesMax less the original and its duplicate

/// Counted from 0; -1: not known.
struct Place {
  int line{-1};
  int column{-1};
};

class FirstComplaint final : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, int column, const std::string& message) override {
    if (text.empty()) {
      place = {line, column};
      text = message;
    }
  }
  Place place;
  std::string text;
};

tl::unexpected<Error> refuse(std::string_view name, Place place, const std::string& what) {
  std::string text{name};
  if (place.line >= 0) {
    text += ':' + std::to_string(place.line + 1) + ':' + std::to_string(place.column + 1);
  }
  return fail(text + ": " + what);
}

/// A refusal that names the field it is about.
struct FieldError {
  std::string field;
  std::string text;
};

bool is_time_s(double value) { return value >= 0 && value <= kTimeMaxS; }

/// Its delays are data, each at its place.
bool is_followed(const Impairment& law) {
  return !law.trace.points.empty() || !law.replay.rows.empty();
}

/// As the words of a refusal spell it.
const char* name_of(Mode mode) { return mode == Mode::Exact ? "exact" : "netem-6.1"; }

/// What an event does to one direction that stands at `current`; `current` moves on with it. Its
/// mode stays: the two of them are other machines, which cannot take over from each other.
tl::expected<Change, FieldError> make_change(const TimelineEvent& event,
                                             Impairment& current,
                                             const FileReader& read) {
  using Kind = Change::Kind;
  const auto wrong = [](const char* field, const std::string& text) {
    return tl::unexpected<FieldError>(FieldError{field, text});
  };
  const auto words = [&](const std::string& text) -> Result<Impairment> {
    auto impairment = parse_impairment(text, current.mode, read);
    if (impairment && impairment->mode != current.mode) {
      return fail(std::string{"a change keeps the mode, which is "} + name_of(current.mode) +
                  " here, not " + name_of(impairment->mode));
    }
    return impairment;
  };
  const bool kernel = current.mode == Mode::Netem61;
  Change change;
  if (!is_time_s(event.at_s())) return wrong("at_s", "at_s must be from 0 to 1000000 s");
  change.at = from_seconds(event.at_s());
  const auto span =
      [&](double ms, const char* field, Kind kind) -> tl::expected<Change, FieldError> {
    if (!(ms > 0 && is_time_s(ms * 1e-3))) return wrong(field, "ms must be above 0, to 1e9");
    change.kind = kind;
    change.span = from_seconds(ms * 1e-3);
    return change;
  };
  switch (event.what_case()) {
    case TimelineEvent::kSet: {
      auto impairment = words(event.set());
      if (!impairment) return wrong("set", impairment.error().text);
      current = change.impairment = *std::move(impairment);
      break;
    }
    case TimelineEvent::kRamp: {
      if (kernel) return wrong("ramp", "mode netem-6.1 knows no ramp");
      auto impairment = words(event.ramp().set());
      if (!impairment) return wrong("ramp", impairment.error().text);
      if (!(event.ramp().over_s() > 0 && is_time_s(event.ramp().over_s()))) {
        return wrong("ramp", "over_s must be above 0, to 1000000 s");
      }
      if (is_followed(current) || is_followed(*impairment)) {
        return wrong("ramp", "a trace or a replay has no mean delay for a ramp to begin or end at");
      }
      change.kind = Kind::Ramp;
      change.span = from_seconds(event.ramp().over_s());
      current = change.impairment = *std::move(impairment);
      break;
    }
    case TimelineEvent::kTrace: {
      std::string spec = "trace " + event.trace().file();
      if (event.trace().loop()) spec += " loop";
      if (event.trace().dither()) spec += " dither";
      auto traced = words(spec);
      if (!traced) return wrong("trace", traced.error().text);
      current.trace = std::move(traced->trace);
      change.impairment = current;
      break;
    }
    case TimelineEvent::kStall:
      return span(event.stall().ms(), "stall", Kind::Stall);
    case TimelineEvent::kBlackout:
      return span(event.blackout().ms(), "blackout", Kind::Blackout);
    case TimelineEvent::kFlood:
      if (kernel) return wrong("flood", "mode netem-6.1 knows no flood");
      if (event.flood().copies() < 1 || event.flood().copies() > kCopiesInFloodMax) {
        return wrong("flood", "copies must be from 1 to 15");
      }
      change.copies = event.flood().copies();
      return span(event.flood().ms(), "flood", Kind::Flood);
    case TimelineEvent::kRebind:
      change.kind = Kind::Rebind;
      break;
    default:
      return wrong("", "an event needs one of set, stall, blackout, ramp, rebind, trace, flood");
  }
  return change;
}

class Builder {
 public:
  Builder(std::string_view name, const FileReader& read, TextFormat::ParseInfoTree& tree)
      : name_{name}, read_{read}, tree_{tree} {}

  Result<void> add(const proto::timeline::Timeline& message, int index, Timeline& timeline) {
    const TimelineEvent& event = message.event(index);
    if (event.dir() != TimelineEvent::DOWN) {
      if (auto added = add(event, index, up_, timeline.up); !added) return added;
    }
    if (event.dir() != TimelineEvent::UP) {
      return add(event, index, down_, timeline.down);
    }
    return {};
  }
  void begin(const Timeline& timeline) {
    up_ = timeline.up.impairment;
    down_ = timeline.down.impairment;
  }
  [[nodiscard]] Place place_of_event(int index, const std::string& field) {
    const auto* events = proto::timeline::Timeline::descriptor()->FindFieldByName("event");
    auto* nested = tree_.GetTreeForNested(events, index);
    const auto* inner =
        field.empty() ? nullptr : TimelineEvent::descriptor()->FindFieldByName(field);
    const auto at = inner != nullptr && nested != nullptr ? nested->GetLocation(inner, -1)
                                                          : tree_.GetLocation(events, index);
    return {at.line, at.column};
  }

 private:
  Result<void> add(const TimelineEvent& event, int index, Impairment& current, PathPlan& plan) {
    // What is set at the start is no change: it may choose the mode of its direction.
    const bool begins = plan.changes.empty() && event.has_set() && !(event.at_s() > 0);
    if (begins) {
      const auto asked = parse_impairment(event.set(), current.mode, read_);
      if (asked) current.mode = asked->mode;
    }
    auto change = make_change(event, current, read_);
    if (!change) {
      return refuse(name_, place_of_event(index, change.error().field), change.error().text);
    }
    if (!plan.changes.empty() && change->at < plan.changes.back().at) {
      return refuse(name_, place_of_event(index, "at_s"), "events must be in the order of at_s");
    }
    plan.changes.push_back(*std::move(change));
    return {};
  }

  std::string name_;
  const FileReader& read_;
  TextFormat::ParseInfoTree& tree_;
  Impairment up_;
  Impairment down_;
};

/// What is set at the start holds from the start, its mode too.
void settle_start(PathPlan& plan) {
  if (plan.changes.empty()) return;
  const Change& first = plan.changes.front();
  if (first.at > Duration{} || first.kind != Change::Kind::Set) return;
  plan.impairment = first.impairment;
  if (plan.loop == Duration{}) plan.changes.erase(plan.changes.begin());
}

/// Whether the first law of a round is a ramp's and the last one of the round before is data.
bool ramps_from_the_end(const PathPlan& plan) {
  const auto is_law = [](const Change& change) {
    return change.kind == Change::Kind::Set || change.kind == Change::Kind::Ramp;
  };
  const auto first = std::find_if(plan.changes.begin(), plan.changes.end(), is_law);
  const auto last = std::find_if(plan.changes.rbegin(), plan.changes.rend(), is_law);
  return first != plan.changes.end() && first->kind == Change::Kind::Ramp &&
         is_followed(last->impairment);
}

}  // namespace

Result<Timeline> parse_timeline(std::string_view name,
                                std::string_view text,
                                const PresetFinder& find_preset,
                                const FileReader& read) {
  proto::timeline::Timeline message;
  FirstComplaint complaint;
  TextFormat::ParseInfoTree tree;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&complaint);
  parser.WriteLocationsTo(&tree);
  if (!parser.ParseFromString(std::string{text}, &message)) {
    return refuse(
        name, complaint.place, complaint.text.empty() ? "not understood" : complaint.text);
  }
  const auto place = [&](const char* field) {
    const auto at =
        tree.GetLocation(proto::timeline::Timeline::descriptor()->FindFieldByName(field), -1);
    return Place{at.line, at.column};
  };
  Timeline timeline;
  if (!message.preset().empty()) {
    auto preset = find_preset(message.preset());
    if (!preset) return refuse(name, place("preset"), preset.error().text);
    timeline = *std::move(preset);
  }
  timeline.preset = message.preset();
  timeline.means = message.means();
  timeline.sources.assign(message.source().begin(), message.source().end());
  const Mode mode =
      message.mode() == proto::timeline::Timeline::NETEM_6_1 ? Mode::Netem61 : Mode::Exact;
  if (!timeline.preset.empty() && mode != timeline.mode) {
    return refuse(name, place("mode"), "a preset is of mode EXACT");
  }
  timeline.mode = mode;
  timeline.up.impairment.mode = timeline.down.impairment.mode = mode;
  if (message.has_seed()) timeline.seed = message.seed();
  const bool events = message.event_size() > 0;
  if (events) {  // the preset's own are replaced
    timeline.up.changes.clear();
    timeline.down.changes.clear();
    timeline.up.loop = timeline.down.loop = {};
  }
  Builder builder{name, read, tree};
  builder.begin(timeline);
  for (int i = 0; i < message.event_size(); ++i) {
    if (auto added = builder.add(message, i, timeline); !added) {
      return tl::unexpected<Error>(added.error());
    }
  }
  if (message.loop()) {
    Duration last{};
    for (const PathPlan* plan : {&timeline.up, &timeline.down}) {
      if (!plan->changes.empty()) last = std::max(last, plan->changes.back().at);
    }
    if (!is_time_s(message.length_s())) return refuse(name, place("length_s"), "from 0 to 1e6 s");
    const Duration length = message.length_s() > 0 ? from_seconds(message.length_s()) : last;
    if (length < last || length < std::chrono::milliseconds{1}) {
      return refuse(
          name, place("loop"), "a loop lasts at least as long as its last event, and 1 ms");
    }
    timeline.up.loop = timeline.down.loop = length;
    if (ramps_from_the_end(timeline.up) || ramps_from_the_end(timeline.down)) {
      return refuse(name,
                    place("loop"),
                    "the first ramp would begin at the trace that ends the round before");
    }
  }
  if (events) {
    settle_start(timeline.up);
    settle_start(timeline.down);
  }
  return timeline;
}

Result<ControlRequest> parse_control_line(std::string_view line,
                                          const ControlContext& context,
                                          const FileReader& read) {
  TimelineEvent event;
  const auto parsed = google::protobuf::util::JsonStringToMessage(
      {line.data(), line.size()}, &event, google::protobuf::util::JsonParseOptions{});
  if (!parsed.ok()) return fail(std::string{parsed.message()});
  ControlRequest request;
  request.up = event.dir() != TimelineEvent::DOWN;
  request.down = event.dir() != TimelineEvent::UP;
  request.now = !event.has_at_s();
  request.stands_on_law = event.has_trace();
  switch (event.what_case()) {
    case TimelineEvent::kStats:
      if (!event.stats()) return fail("stats must be true");
      request.kind = ControlRequest::Kind::Stats;
      return request;
    case TimelineEvent::kQuit:
      if (!event.quit()) return fail("quit must be true");
      request.kind = ControlRequest::Kind::Quit;
      return request;
    case TimelineEvent::kRecord:
      request.kind = ControlRequest::Kind::Record;
      request.prefix = event.record();
      return request;
    default:
      break;
  }
  // Each direction has its own mode, so what one understands the other need not.
  const auto change = [&](Impairment law, Change& into) -> Result<void> {
    auto made = make_change(event, law, read);
    if (!made) return fail(made.error().text);
    into = *std::move(made);
    return {};
  };
  if (request.up) {
    if (auto made = change(context.up, request.change_up); !made) {
      return tl::unexpected<Error>(made.error());
    }
  }
  if (request.down) {
    if (auto made = change(context.down, request.change_down); !made) {
      return tl::unexpected<Error>(made.error());
    }
  }
  return request;
}

}  // namespace palp::netem
