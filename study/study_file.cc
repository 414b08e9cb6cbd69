#include "study/study_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "common/config/document.h"
#include "common/config/settings_text.h"
#include "common/core/formatted.h"
#include "common/core/printable.h"
#include "common/core/random.h"
#include "proto/config.pb.h"
#include "study/orders.h"

namespace palp::study {
namespace {

constexpr double kPlacesLeast = 2;   // [-], or a guess were nearly right
constexpr double kTravelFar = 4;     // [s], from one hidden ball to the next
constexpr double kWithinLeast = 1;   // [mm], or a search were never done
constexpr double kDelayComes = 1.2;  // [s], a ramp of a second, and the way of the tip

struct TaskWord {
  StudyTask task;
  std::string_view name;
  std::string_view instructions;  ///< where the author gives none
};
constexpr std::array kTasks{
    TaskWord{StudyTask::Stiffness,
             "stiffness",
             "Press each place with the same hand, then say which was the stiffest."},
    TaskWord{StudyTask::Bias,
             "bias",
             "Press each place with the same hand, then say which was the stiffest."},
    TaskWord{StudyTask::Detect2,
             "detect2",
             "Press each place with the same hand, then say over which something hard lies."},
    TaskWord{StudyTask::Detect,
             "detect",
             "Press the place, then say whether something hard lies under it."},
    TaskWord{StudyTask::Rank,
             "rank",
             "Press each place with the same hand, then say in which order they are, the softest "
             "first."},
    TaskWord{StudyTask::Delay,
             "delay",
             "Press each place with the same hand, then say which one answered late."},
    TaskWord{StudyTask::Locate,
             "locate",
             "Search the area with the same hand for something hard, and say so when you are over "
             "it."}};

const TaskWord& word_of(std::string_view name) {
  return *std::ranges::find(kTasks, name, &TaskWord::name);
}

/// Letters, digits and '-': for names of files and for BIDS.
bool short_name(std::string_view text) {
  return !text.empty() && text.size() <= 40 && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

Feedback feedback_of(std::string_view name) {
  if (name == "none") return Feedback::None;
  if (name == "drawn") return Feedback::Drawn;
  if (name == "both") return Feedback::Both;
  return name == "depth" ? Feedback::Depth : Feedback::Force;
}

Condition condition_of(const proto::config::StudyCondition& message) {
  return {.name = message.name(),
          .coupling = message.coupling(),
          .up = config::settings_text(message.up()),
          .down = config::settings_text(message.down()),
          .grip = message.grip(),
          .feedback = feedback_of(message.feedback()),
          .taps = static_cast<int>(message.taps()),
          .unjudged = static_cast<int>(message.taps_unjudged())};
}

/// Half of the way from the deepest ball to the least deep one [-].
double reach_of(const std::vector<BallDepth>& depths) noexcept {
  return (depths.back().contrast - depths.front().contrast) / 2;
}

/// Where `study` has its task and its depths. A ranking of balls goes no farther than these do.
std::vector<double> levels_of(const proto::config::Study& message, const Study& study) {
  const auto& levels = message.levels();
  std::vector<double> out;
  if (study.task.delays) {
    const auto& delays = message.delays();
    return even_levels(delays.from_ms(), delays.to_ms(), delays.count());
  }
  if (!study.depths.empty() && !study.task.ranks) {
    if (study.task.yes_no) out.push_back(0);
    for (const BallDepth& one : study.depths) out.push_back(one.contrast);
    return out;
  }
  if (study.asks != StudyTask::Bias) {
    const double reach = study.depths.empty() ? levels.to_ln() : reach_of(study.depths);
    return even_levels(levels.from_ln(), std::min(levels.to_ln(), reach), levels.count());
  }
  const double step = 2 * levels.to_ln() / (levels.count() - 1);
  for (std::uint32_t i = 0; i < levels.count(); ++i) out.push_back(-levels.to_ln() + step * i);
  return out;
}

Task task_of(const proto::config::Study& message) {
  const StudyTask asks = word_of(message.task()).task;
  Task task{.intervals = static_cast<int>(message.intervals()),
            .two_sided = asks == StudyTask::Bias || asks == StudyTask::Detect,
            .yes_no = asks == StudyTask::Detect,
            .ranks = asks == StudyTask::Rank,
            .delays = asks == StudyTask::Delay};
  if (task.ranks) task.intervals = static_cast<int>(kRanked);
  if (asks == StudyTask::Locate) task.intervals = 1;
  return task;
}

SearchArea search_of(const proto::config::Study& message) {
  const auto& search = message.search();
  const double within = search.within_mm() > 0 ? search.within_mm() : message.ball().radius_mm();
  return {.side = search.side_mm() / 1e3, .within = within / 1e3, .limit = search.limit_s()};
}

/// Discs of what counts as found, in the area.
double places_of(const SearchArea& search) noexcept {
  return search.side * search.side / (std::numbers::pi * search.within * search.within);
}

/// The deepest first.
std::vector<BallDepth> depths_of(const proto::config::Study& message) {
  std::vector<BallDepth> depths;
  for (const auto& one : message.depth()) depths.push_back({one.top_mm() / 1e3, one.contrast_ln()});
  std::ranges::sort(depths, std::greater{}, &BallDepth::depth);
  return depths;
}

/// Depths whose contrasts are the levels, or of a ranking say what lies where.
Result<void> check_depths(const proto::config::Study& message) {
  const std::vector<BallDepth> depths = depths_of(message);
  if (depths.size() < 2 || depths.size() > 60) {
    return fail("there are " + std::to_string(depths.size()) + " depths, expected 2 to 60");
  }
  for (std::size_t i = 1; i < depths.size(); ++i) {
    if (depths[i].depth >= depths[i - 1].depth || depths[i].contrast <= depths[i - 1].contrast) {
      return fail("of two depths the deeper one must have the smaller contrast_ln");
    }
  }
  if (message.task() == "detect" && message.method() != "constant") {
    return fail("method " + message.method() +
                " finds no criterion, for it asks where nothing lies when it likes: constant does");
  }
  return {};
}

/// What goes with which task.
Result<void> check_task(const proto::config::Study& message, StudyTask task) {
  const auto is = [task](auto... one) { return ((task == one) || ...); };
  const bool needs_depths = is(StudyTask::Detect, StudyTask::Detect2, StudyTask::Locate);
  const bool takes_depths = needs_depths || task == StudyTask::Rank;
  if (needs_depths || (takes_depths && message.depth_size() > 0)) {
    if (auto checked = check_depths(message); !checked) return checked;
  } else if (message.depth_size() > 0) {
    return fail("depths are of the tasks detect, detect2, locate and rank");
  }
  if (message.has_ball() && message.depth_size() == 0) return fail("a ball needs depths");
  if (task == StudyTask::Rank && message.depth_size() > 0) {
    if (!message.has_ball()) return fail("depths of a ranking need a ball");
    const double reach = reach_of(depths_of(message));
    const auto& levels = message.levels();
    if (levels.from_ln() >= reach || (levels.has_to_ln() && levels.to_ln() > reach)) {
      return fail(
          "levels of a ranking of balls must lie within half of the way from the least to "
          "the greatest contrast_ln");
    }
  }
  if (task == StudyTask::Locate && !message.has_ball()) {
    return fail("task locate hides a ball: it needs ball, the radius and ratio of one");
  }
  if (message.has_search() && task != StudyTask::Locate) {
    return fail("search is of the task locate");
  }
  if (message.has_delays() && task != StudyTask::Delay) return fail("delays are of the task delay");
  const bool free = is(StudyTask::Stiffness, StudyTask::Delay);
  if (!free && message.has_intervals() && message.intervals() != (is(StudyTask::Rank) ? 3u : 2u)) {
    return fail("intervals are of the tasks stiffness and delay");
  }
  if (message.delays().from_ms() >= message.delays().to_ms()) {
    return fail("delays.from_ms must be below delays.to_ms");
  }
  if (message.search().within_mm() > 0 && message.search().within_mm() < kWithinLeast) {
    return fail("search.within_mm must be 0 or " + formatted("%g", kWithinLeast) + " at least");
  }
  for (const auto& one : message.condition()) {
    const double link = (one.up().delay_ms() + one.down().delay_ms()) / 1e3;
    const double needed = kDelayComes + link + message.delays().to_ms() / 1e3;
    if (task == StudyTask::Delay && message.travel_s() < needed) {
      return fail("condition " + one.name() + ": travel_s must be " + formatted("%.2f", needed) +
                  " at least, for a delay comes within a second and the stage's place is told as "
                  "late as the link and the delay are");
    }
    if (task == StudyTask::Delay && one.feedback() != "force" && one.feedback() != "none") {
      return fail("condition " + one.name() +
                  ": task delay is answered by what the hand is given: feedback force or none");
    }
  }
  return {};
}

/// What the schema cannot say.
Result<void> check_study(const proto::config::Study& message) {
  if (!short_name(message.name())) {
    return fail("name is \"" + printable(message.name()) +
                "\", expected 1 to 40 of a to z, 0 to 9 and -");
  }
  const int count = message.condition_size();
  if (count < 1 || count > static_cast<int>(kConditionsMax)) {
    return fail("there are " + std::to_string(count) + " conditions, expected 1 to 6");
  }
  for (int i = 0; i < count; ++i) {
    const std::string& name = message.condition(i).name();
    if (name.empty() || printable(name) != name) {
      return fail("condition[" + std::to_string(i) + "].name is \"" + printable(name) +
                  "\", expected 1 to 80 printable letters");
    }
    if (message.condition(i).taps_unjudged() >= message.condition(i).taps()) {
      return fail("condition " + name + ": taps_unjudged must be below taps");
    }
    if (message.condition(i).feedback() == "depth" && !message.has_ball()) {
      return fail("condition " + name +
                  ": feedback depth says where a ball lies: it needs a task with depths and ball, "
                  "the radius and ratio of one");
    }
    for (int j = 0; j < i; ++j) {
      if (message.condition(j).name() == name) return fail("two conditions are called " + name);
    }
  }
  const bool two_sided = message.task() == "bias";
  if (auto checked = check_task(message, word_of(message.task()).task); !checked) return checked;
  if (!two_sided && message.levels().from_ln() <= 0) {
    return fail("levels.from_ln must be above 0 where task is " + message.task());
  }
  if (message.levels().from_ln() >= message.levels().to_ln()) {
    return fail("levels.from_ln must be below levels.to_ln");
  }
  if (two_sided && message.method() != "quest-plus" && message.method() != "constant") {
    return fail("method " + message.method() + " finds no bias: quest-plus or constant does");
  }
  if (message.practice().right() > message.practice().of()) {
    return fail("practice.right must not be above practice.of");
  }
  if (message.practice().right() > message.practice().trials_max()) {
    return fail("practice.right must not be above practice.trials_max");
  }
  if (message.trials() < message.tracks()) return fail("trials must not be fewer than tracks");
  return {};
}

}  // namespace

Result<Study> parse_study(std::string_view text, const std::string& name) {
  config::Document document = config::study_document();
  if (auto merged = document.merge(text, name); !merged) return tl::unexpected(merged.error());
  if (auto checked = document.check(); !checked) return fail(name, checked.error());
  const auto& message = document.as<proto::config::Study>();
  if (auto checked = check_study(message); !checked) return fail(name, checked.error());
  Study study{.name = message.name(),
              .question = message.question(),
              .instructions = message.has_instructions()
                                  ? message.instructions()
                                  : std::string{word_of(message.task()).instructions},
              .primary = message.analysis().primary(),
              .ethics = {message.ethics().body(), message.ethics().number()},
              .seed = message.seed(),
              .participants = message.participants(),
              .asks = word_of(message.task()).task,
              .task = task_of(message),
              .trials = message.trials(),
              .tracks = message.tracks(),
              .catch_share = message.catch_share(),
              .rest = message.rest_s(),
              .travel = message.travel_s(),
              .practice = {.level = message.practice().level_ln(),
                           .right = message.practice().right(),
                           .of = message.practice().of(),
                           .trials_max = message.practice().trials_max()},
              .margin = message.analysis().margin_ln(),
              .catch_right_min = message.analysis().catch_right_min(),
              .ratio_expected = message.analysis().ratio_expected(),
              .sd_expected = message.analysis().sd_expected_ln()};
  study.method.kind = *std::ranges::find(kMethods,
                                         std::string_view{message.method()},
                                         [](MethodKind kind) { return to_string(kind); });
  study.method.staircase.start *= level_unit(study.task);
  study.depths = depths_of(message);
  if (message.has_ball()) {
    study.ball = {.radius = message.ball().radius_mm() / 1e3, .ratio = message.ball().ratio()};
  }
  if (study.asks == StudyTask::Locate) {
    study.search = search_of(message);
    study.task.places = places_of(study.search);
    if (study.task.places < kPlacesLeast) {
      return fail(name,
                  Error{"search.within_mm is too wide for search.side_mm: who guesses finds"});
    }
    if (!message.has_travel_s()) study.travel = kTravelFar;
  }
  if (study.task.delays) study.practice.level = message.delays().practice_ms();
  study.levels = levels_of(message, study);
  for (const auto& one : message.condition()) study.conditions.push_back(condition_of(one));
  return study;
}

std::string_view task_name(const Study& study) noexcept {
  return std::ranges::find(kTasks, study.asks, &TaskWord::task)->name;
}

std::optional<double> depth_of(const Study& study, double contrast) noexcept {
  for (std::size_t i = 1; i < study.depths.size(); ++i) {
    const BallDepth& deeper = study.depths[i - 1];
    const BallDepth& other = study.depths[i];
    if (contrast < deeper.contrast || contrast > other.contrast) continue;
    const double share =
        std::log(contrast / deeper.contrast) / std::log(other.contrast / deeper.contrast);
    return std::lerp(deeper.depth, other.depth, share);
  }
  return std::nullopt;
}

std::optional<double> depth_found(const Study& study, double jnd) noexcept {
  if (study.depths.empty()) return std::nullopt;
  if (study.task.ranks) return depth_of(study, middle_contrast(study) + jnd);
  return depth_of(study, study.task.yes_no ? jnd / kQuartile : jnd);
}

double middle_contrast(const Study& study) noexcept {
  return (study.depths.front().contrast + study.depths.back().contrast) / 2;
}

Place drawn_place(const SearchArea& area,
                  std::uint64_t seed,
                  std::uint64_t stream,
                  std::uint64_t index) noexcept {
  const auto along = [&](std::uint64_t i) {
    return area.side * (random_uniform(seed, stream, i) - 0.5);
  };
  return {along(index), along(index + 1)};
}

AnswerTable table_of(const Study& study) { return {study.task, {}, {}, study.levels}; }

}  // namespace palp::study
