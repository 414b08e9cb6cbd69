#include "study/study_file.h"

#include <algorithm>
#include <array>

#include "common/config/document.h"
#include "common/config/settings_text.h"
#include "common/core/printable.h"
#include "proto/config.pb.h"

namespace palp::study {
namespace {

constexpr std::array kMethods{
    MethodKind::Constant, MethodKind::Staircase, MethodKind::Quest, MethodKind::QuestPlus};

/// Letters, digits and '-': for names of files and for BIDS.
bool short_name(std::string_view text) {
  return !text.empty() && text.size() <= 40 && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

Condition condition_of(const proto::config::StudyCondition& message) {
  return {.name = message.name(),
          .coupling = message.coupling(),
          .up = config::settings_text(message.up()),
          .down = config::settings_text(message.down()),
          .grip = message.grip(),
          .force = message.feedback() == "force",
          .taps = static_cast<int>(message.taps())};
}

std::vector<double> levels_of(const proto::config::StudyLevels& message, bool two_sided) {
  if (!two_sided) return even_levels(message.from_ln(), message.to_ln(), message.count());
  std::vector<double> levels;
  const double step = 2 * message.to_ln() / (message.count() - 1);
  for (std::uint32_t i = 0; i < message.count(); ++i) levels.push_back(-message.to_ln() + step * i);
  return levels;
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
    for (int j = 0; j < i; ++j) {
      if (message.condition(j).name() == name) return fail("two conditions are called " + name);
    }
  }
  const bool two_sided = message.task() == "bias";
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
              .instructions = message.instructions(),
              .primary = message.analysis().primary(),
              .ethics_body = message.ethics().body(),
              .ethics_number = message.ethics().number(),
              .seed = message.seed(),
              .participants = message.participants(),
              .task = {.intervals = static_cast<int>(message.intervals()),
                       .two_sided = message.task() == "bias"},
              .trials = message.trials(),
              .tracks = message.tracks(),
              .catch_share = message.catch_share(),
              .rest = message.rest_s(),
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
  study.levels = levels_of(message.levels(), study.task.two_sided);
  for (const auto& one : message.condition()) study.conditions.push_back(condition_of(one));
  return study;
}

std::string_view task_name(const Study& study) noexcept {
  return study.task.two_sided ? "bias" : "stiffness";
}

AnswerTable table_of(const Study& study) { return {study.task, {}, {}, study.levels}; }

}  // namespace palp::study
