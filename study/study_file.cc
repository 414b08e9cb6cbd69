#include "study/study_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "common/config/document.h"
#include "common/config/settings_text.h"
#include "common/core/printable.h"
#include "proto/config.pb.h"

namespace palp::study {
namespace {

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
             "Press the place, then say whether something hard lies under it."}};

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

std::vector<double> levels_of(const proto::config::StudyLevels& message, bool two_sided) {
  if (!two_sided) return even_levels(message.from_ln(), message.to_ln(), message.count());
  std::vector<double> levels;
  const double step = 2 * message.to_ln() / (message.count() - 1);
  for (std::uint32_t i = 0; i < message.count(); ++i) levels.push_back(-message.to_ln() + step * i);
  return levels;
}

/// The deepest first.
std::vector<BallDepth> depths_of(const proto::config::Study& message) {
  std::vector<BallDepth> depths;
  for (const auto& one : message.depth()) depths.push_back({one.top_mm() / 1e3, one.contrast_ln()});
  std::ranges::sort(depths, std::greater{}, &BallDepth::depth);
  return depths;
}

/// Of a task of detection.
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
  if (message.intervals() != 2) return fail("intervals must be 2 where task is detect or detect2");
  if (message.task() == "detect" && message.method() != "constant") {
    return fail("method " + message.method() +
                " finds no criterion, for it asks where nothing lies when it likes: constant does");
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
                  ": feedback depth says where a ball lies: it needs task detect or detect2 and "
                  "ball, the radius and ratio of one");
    }
    for (int j = 0; j < i; ++j) {
      if (message.condition(j).name() == name) return fail("two conditions are called " + name);
    }
  }
  const bool two_sided = message.task() == "bias";
  const bool detects = message.task().starts_with("detect");
  if (detects) {
    if (auto checked = check_depths(message); !checked) return checked;
  } else if (message.depth_size() > 0 || message.has_ball()) {
    return fail("depths and a ball are of the tasks detect and detect2");
  }
  if (!two_sided && message.levels().from_ln() <= 0) {
    return fail("levels.from_ln must be above 0 where task is stiffness");
  }
  if (message.levels().from_ln() >= message.levels().to_ln()) {
    return fail("levels.from_ln must be below levels.to_ln");
  }
  if (two_sided && message.method() != "quest-plus" && message.method() != "constant") {
    return fail("method " + message.method() + " finds no bias: quest-plus or constant does");
  }
  if (two_sided && message.intervals() != 2) {
    return fail("intervals must be 2 where task is bias");
  }
  if (message.practice().right() > message.practice().of()) {
    return fail("practice.right must not be above practice.of");
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
              .ethics_body = message.ethics().body(),
              .ethics_number = message.ethics().number(),
              .seed = message.seed(),
              .participants = message.participants(),
              .asks = word_of(message.task()).task,
              .task = {.intervals = static_cast<int>(message.intervals()),
                       .two_sided = message.task() == "bias" || message.task() == "detect",
                       .yes_no = message.task() == "detect"},
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
  study.depths = depths_of(message);
  if (message.has_ball()) {
    study.ball = {.radius = message.ball().radius_mm() / 1e3, .ratio = message.ball().ratio()};
  }
  if (study.depths.empty()) {
    study.levels = levels_of(message.levels(), study.task.two_sided);
  } else {
    if (study.task.yes_no) study.levels.push_back(0);
    for (const BallDepth& one : study.depths) study.levels.push_back(one.contrast);
  }
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
  return depth_of(study, study.task.yes_no ? jnd / kQuartile : jnd);
}

AnswerTable table_of(const Study& study) { return {study.task, {}, {}, study.levels}; }

}  // namespace palp::study
