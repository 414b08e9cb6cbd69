#include "netem/syntax/timeline.h"

#include <algorithm>
#include <cmath>

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include "netem/syntax/impairment_text.h"
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

/// What an event does to one direction that stands at `current`, which moves on with it. Its mode
/// stays: the two of them are other machines, which cannot take over from each other.
class ChangeMaker {
 public:
  using Made = tl::expected<Change, FieldError>;

  ChangeMaker(const TimelineEvent& event, Impairment& current, const FileReader& read)
      : event_{event}, current_{current}, read_{read} {}

  [[nodiscard]] Made make() {
    if (!is_time_s(event_.at_s())) return wrong("at_s", "at_s must be from 0 to 1000000 s");
    change_.at = from_seconds(event_.at_s());
    switch (event_.what_case()) {
      case TimelineEvent::kSet:
        return set();
      case TimelineEvent::kRamp:
        return ramp();
      case TimelineEvent::kTrace:
        return trace();
      case TimelineEvent::kStall:
        return last(event_.stall().ms(), "stall", Kind::Stall);
      case TimelineEvent::kBlackout:
        return last(event_.blackout().ms(), "blackout", Kind::Blackout);
      case TimelineEvent::kFlood:
        return flood();
      case TimelineEvent::kRebind:
        change_.kind = Kind::Rebind;
        return change_;
      default:
        return wrong("", "an event needs one of set, stall, blackout, ramp, rebind, trace, flood");
    }
  }

 private:
  using Kind = Change::Kind;

  static tl::unexpected<FieldError> wrong(const char* field, const std::string& text) {
    return tl::unexpected<FieldError>(FieldError{field, text});
  }
  [[nodiscard]] bool is_kernel() const { return current_.mode == Mode::Netem61; }
  [[nodiscard]] Result<Impairment> words(const std::string& text) const {
    auto impairment = parse_impairment(text, current_.mode, read_);
    if (impairment && impairment->mode != current_.mode) {
      return fail(std::string{"a change keeps the mode, which is "} + name_of(current_.mode) +
                  " here, not " + name_of(impairment->mode));
    }
    return impairment;
  }
  Made set() {
    auto impairment = words(event_.set());
    if (!impairment) return wrong("set", impairment.error().text);
    current_ = change_.impairment = *std::move(impairment);
    return change_;
  }
  Made ramp() {
    if (is_kernel()) return wrong("ramp", "mode netem-6.1 knows no ramp");
    auto impairment = words(event_.ramp().set());
    if (!impairment) return wrong("ramp", impairment.error().text);
    if (!(event_.ramp().over_s() > 0 && is_time_s(event_.ramp().over_s()))) {
      return wrong("ramp", "over_s must be above 0, to 1000000 s");
    }
    if (is_followed(current_) || is_followed(*impairment)) {
      return wrong("ramp", "a trace or a replay has no mean delay for a ramp to begin or end at");
    }
    change_.kind = Kind::Ramp;
    change_.span = from_seconds(event_.ramp().over_s());
    current_ = change_.impairment = *std::move(impairment);
    return change_;
  }
  Made trace() {
    std::string spec = "trace " + event_.trace().file();
    if (event_.trace().loop()) spec += " loop";
    if (event_.trace().dither()) spec += " dither";
    auto traced = words(spec);
    if (!traced) return wrong("trace", traced.error().text);
    current_.trace = std::move(traced->trace);
    change_.impairment = current_;
    return change_;
  }
  Made flood() {
    if (is_kernel()) return wrong("flood", "mode netem-6.1 knows no flood");
    if (event_.flood().copies() < 1 || event_.flood().copies() > kCopiesInFloodMax) {
      return wrong("flood", "copies must be from 1 to 15");
    }
    change_.copies = event_.flood().copies();
    return last(event_.flood().ms(), "flood", Kind::Flood);
  }
  Made last(double ms, const char* field, Kind kind) {
    if (!(ms > 0 && is_time_s(ms * 1e-3))) return wrong(field, "ms must be above 0, to 1e9");
    change_.kind = kind;
    change_.span = from_seconds(ms * 1e-3);
    return change_;
  }

  const TimelineEvent& event_;
  Impairment& current_;
  const FileReader& read_;
  Change change_;
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

/// Makes the timeline that a message says; a refusal names its place in the text.
class Builder {
 public:
  Builder(std::string_view name,
          const proto::timeline::Timeline& message,
          TextFormat::ParseInfoTree& tree,
          const FileReader& read)
      : name_{name}, message_{message}, tree_{tree}, read_{read} {}

  [[nodiscard]] Result<Timeline> build(const PresetFinder& find_preset) {
    if (auto begun = begin(find_preset); !begun) return tl::unexpected<Error>(begun.error());
    for (int i = 0; i < message_.event_size(); ++i) {
      if (auto added = add(i); !added) return tl::unexpected<Error>(added.error());
    }
    if (message_.loop()) {
      if (auto closed = close_loop(); !closed) return tl::unexpected<Error>(closed.error());
    }
    if (message_.event_size() > 0) {
      settle_start(timeline_.up);
      settle_start(timeline_.down);
    }
    return std::move(timeline_);
  }

 private:
  using Message = proto::timeline::Timeline;

  Result<void> begin(const PresetFinder& find_preset) {
    if (!message_.preset().empty()) {
      auto preset = find_preset(message_.preset());
      if (!preset) return refuse(name_, place("preset"), preset.error().text);
      timeline_ = *std::move(preset);
    }
    timeline_.preset = message_.preset();
    timeline_.means = message_.means();
    timeline_.sources.assign(message_.source().begin(), message_.source().end());
    const Mode mode = message_.mode() == Message::NETEM_6_1 ? Mode::Netem61 : Mode::Exact;
    if (!timeline_.preset.empty() && mode != timeline_.mode) {
      return refuse(name_, place("mode"), "a preset is of mode EXACT");
    }
    timeline_.mode = mode;
    timeline_.up.impairment.mode = timeline_.down.impairment.mode = mode;
    if (message_.has_seed()) timeline_.seed = message_.seed();
    if (message_.event_size() > 0) {  // the preset's own are replaced
      timeline_.up.changes.clear();
      timeline_.down.changes.clear();
      timeline_.up.loop = timeline_.down.loop = {};
    }
    up_ = timeline_.up.impairment;
    down_ = timeline_.down.impairment;
    return {};
  }

  Result<void> add(int index) {
    const TimelineEvent& event = message_.event(index);
    if (event.dir() != TimelineEvent::DOWN) {
      if (auto added = add(index, up_, timeline_.up); !added) return added;
    }
    if (event.dir() != TimelineEvent::UP) return add(index, down_, timeline_.down);
    return {};
  }

  Result<void> add(int index, Impairment& current, PathPlan& plan) {
    const TimelineEvent& event = message_.event(index);
    // What is set at the start is no change: it may choose the mode of its direction.
    const bool begins = plan.changes.empty() && event.has_set() && !(event.at_s() > 0);
    if (begins) {
      const auto asked = parse_impairment(event.set(), current.mode, read_);
      if (asked) current.mode = asked->mode;
    }
    auto change = ChangeMaker{event, current, read_}.make();
    if (!change) {
      return refuse(name_, place_of_event(index, change.error().field), change.error().text);
    }
    if (!plan.changes.empty() && change->at < plan.changes.back().at) {
      return refuse(name_, place_of_event(index, "at_s"), "events must be in the order of at_s");
    }
    plan.changes.push_back(*std::move(change));
    return {};
  }

  Result<void> close_loop() {
    Duration last{};
    for (const PathPlan* plan : {&timeline_.up, &timeline_.down}) {
      if (!plan->changes.empty()) last = std::max(last, plan->changes.back().at);
    }
    if (!is_time_s(message_.length_s())) {
      return refuse(name_, place("length_s"), "from 0 to 1e6 s");
    }
    const Duration length = message_.length_s() > 0 ? from_seconds(message_.length_s()) : last;
    if (length < last || length < std::chrono::milliseconds{1}) {
      return refuse(
          name_, place("loop"), "a loop lasts at least as long as its last event, and 1 ms");
    }
    timeline_.up.loop = timeline_.down.loop = length;
    if (ramps_from_the_end(timeline_.up) || ramps_from_the_end(timeline_.down)) {
      return refuse(name_,
                    place("loop"),
                    "the first ramp would begin at the trace that ends the round before");
    }
    return {};
  }

  [[nodiscard]] Place place(const char* field) const {
    const auto at = tree_.GetLocation(Message::descriptor()->FindFieldByName(field), -1);
    return {at.line, at.column};
  }
  [[nodiscard]] Place place_of_event(int index, const std::string& field) const {
    const auto* events = Message::descriptor()->FindFieldByName("event");
    auto* nested = tree_.GetTreeForNested(events, index);
    const auto* inner =
        field.empty() ? nullptr : TimelineEvent::descriptor()->FindFieldByName(field);
    const auto at = inner != nullptr && nested != nullptr ? nested->GetLocation(inner, -1)
                                                          : tree_.GetLocation(events, index);
    return {at.line, at.column};
  }

  std::string name_;
  const Message& message_;
  TextFormat::ParseInfoTree& tree_;
  const FileReader& read_;
  Timeline timeline_;
  Impairment up_;  ///< as the events left it
  Impairment down_;
};

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
  return Builder{name, message, tree, read}.build(find_preset);
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
    auto made = ChangeMaker{event, law, read}.make();
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
