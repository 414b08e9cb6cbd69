#include "surgeon_site/recording_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/record/mapped_file.h"
#include "common/record/session_reader.h"

namespace palp::surgeon {
namespace {

constexpr Duration kPointEvery = std::chrono::milliseconds{10};
constexpr Duration kRecordingMax = std::chrono::hours{4};
constexpr double kMeantMax = 0.2;        ///< [m], of a hand that can be meant
constexpr double kForceMax = 100;        ///< [N]
constexpr double kInTissue = 0.75e-3;    ///< [m], past the surface
constexpr double kStrokeDepth = 1.5e-3;  ///< [m], least of a tap
constexpr Duration kTapLongest = std::chrono::milliseconds{1500};

/// A point of the motion, with what the force adds to make the intent of it.
struct HandPoint {
  Duration at{};      ///< since the first
  double position{};  ///< [m], past the surface
  double intent{};    ///< [m]
  Place place;
};

/// Means of the engaged ticks, each over two intervals of points.
class HandMeans {
 public:
  HandMeans(double surface, double stiffness) : surface_{surface}, stiffness_{stiffness} {}

  /// False: such a motion no hand has made.
  bool add(const SiteTick& tick) {
    if (!began_at_) began_at_ = tick.at;
    const Duration at = elapsed(*began_at_, tick.at);
    const double position = tick.position - surface_;
    const bool sound = at >= Duration{0} && at <= kRecordingMax && at >= newest_ &&
                       std::abs(position) <= kMeantMax && std::abs(tick.force) <= kForceMax &&
                       is_finite(tick.place);
    if (!sound) return false;
    newest_ = at;
    const auto slot = static_cast<std::size_t>(at / kPointEvery);
    // A tick lies in the windows of the point before it and of the one behind it.
    sum(slot, position, tick);
    sum(slot + 1, position, tick);
    return true;
  }

  [[nodiscard]] std::vector<HandPoint> points() const {
    std::vector<HandPoint> points;
    for (const Sum& sum : sums_) {
      if (sum.count < 2) continue;
      const double position = sum.position / sum.count;
      const Duration at = kPointEvery * static_cast<std::int64_t>(sum.slot);
      points.push_back({at, position, position + sum.force / sum.count / stiffness_, sum.place});
    }
    const Duration first = points.empty() ? Duration{} : points.front().at;
    for (HandPoint& point : points) point.at -= first;
    return points;
  }

 private:
  struct Sum {
    std::size_t slot{};
    double count{};
    double position{};  ///< [m]
    double force{};     ///< [N]
    Place place;
  };

  void sum(std::size_t slot, double position, const SiteTick& tick) {
    auto found = sums_.end();
    for (auto back = sums_.rbegin(); back != sums_.rend() && back->slot >= slot; ++back) {
      if (back->slot == slot) found = std::prev(back.base());
    }
    if (found == sums_.end()) {
      sums_.push_back({.slot = slot, .place = tick.place});
      found = std::prev(sums_.end());
    }
    found->count += 1;
    found->position += position;
    found->force += tick.force;
  }

  double surface_;    ///< [m]
  double stiffness_;  ///< [N/m]
  std::optional<TimePoint> began_at_;
  Duration newest_{};
  std::vector<Sum> sums_;
};

/// A recording in pieces: what lies in the tissue, and what lies between.
class RecordedPhases {
 public:
  explicit RecordedPhases(const std::vector<HandPoint>& points) : points_{points} {
    std::size_t begin = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      if (inside(k) == inside(begin) && k + 1 < points.size()) continue;
      add(begin, k);
      begin = k;
    }
  }
  [[nodiscard]] std::vector<Stretch> stretches() { return std::move(stretches_); }
  [[nodiscard]] std::vector<ScriptPhase> phases() { return std::move(phases_); }

 private:
  [[nodiscard]] bool inside(std::size_t k) const { return points_[k].position > kInTissue; }

  void add(std::size_t begin, std::size_t end) {
    Stretch stretch;
    stretch.kind = StretchKind::Replay;
    stretch.began_at = points_[begin].at;
    stretch.duration = points_[end].at - points_[begin].at;
    stretch.from = points_[begin].intent;
    stretch.to = points_[end].intent;
    stretch.place = points_[begin].place;
    stretch.to_place = points_[end].place;
    double deepest = 0;
    for (std::size_t k = begin; k < end; ++k) deepest = std::max(deepest, points_[k].position);
    const bool stroke = inside(begin) && deepest > kStrokeDepth;
    if (stroke && stretch.duration <= kTapLongest) stretch.kind = StretchKind::Tap;
    // A phase ends with its stroke: whoever is interrupted comes back for the whole of it.
    if (phases_.empty() || phase_over_) {
      phases_.push_back({"recorded " + std::to_string(phases_.size() + 1), stretch.began_at});
    }
    phase_over_ = stroke;
    stretch.phase = static_cast<std::uint32_t>(phases_.size());
    stretches_.push_back(stretch);
  }

  const std::vector<HandPoint>& points_;
  std::vector<Stretch> stretches_;
  std::vector<ScriptPhase> phases_;
  bool phase_over_{};
};

/// [m]; a file without it was made with the surface at 0.
double surface_of(const record::SessionReader& reader) {
  const auto text = reader.metadata("palp", "surface_offset_mm");
  double value{};
  if (!text) return 0;
  const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  const bool sound = error == std::errc{} && std::abs(value) <= kMeantMax * 1e3;
  return sound ? value * 1e-3 : 0;
}

}  // namespace

Result<GestureScript> parse_recording(const record::FileBytes& file, double hand_stiffness) {
  record::SessionReader reader{file};
  std::optional<HandMeans> means;
  while (const auto entry = reader.next()) {
    if (entry->site != link::Role::Surgeon) return fail("it is not the surgeon's session file");
    const auto* tick = std::get_if<SiteTick>(&entry->record);
    if (tick == nullptr) continue;
    if (!means) means.emplace(surface_of(reader), hand_stiffness);
    if (tick->state != SiteState::Engaged && tick->state != SiteState::Hold) continue;
    if (!means->add(*tick)) return fail("its hand moves as none can, or for more than 4 hours");
  }
  if (!reader.report().faults.empty() && !means) return fail(reader.report().faults.front().text);
  const std::vector<HandPoint> points = means ? means->points() : std::vector<HandPoint>{};
  if (points.size() < 2) return fail("the hand was never engaged in it");
  RecordedPhases phases{points};
  std::vector<ReplayPoint> replay;
  replay.reserve(points.size());
  for (const HandPoint& point : points) replay.push_back({point.at, point.intent, point.place});
  return GestureScript{std::move(replay), phases.stretches(), phases.phases()};
}

Result<GestureScript> load_recording(const std::string& path, double hand_stiffness) {
  const auto file = record::MappedFile::open(path);
  if (!file) return fail("recording", file.error());
  auto script = parse_recording(file->bytes(), hand_stiffness);
  if (!script) return fail(path, script.error());
  return script;
}

}  // namespace palp::surgeon
