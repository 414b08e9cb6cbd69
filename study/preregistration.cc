#include "study/preregistration.h"

#include <algorithm>
#include <cmath>

#include "common/config/number.h"
#include "common/core/formatted.h"
#include "study/compare.h"

namespace palp::study {
namespace {

using config::number_text;

std::string per_cent(double share) { return formatted("%.0f %%", 100 * share); }

std::string power_table(const Study& study) {
  std::string text = "| ratio of JNDs | participants needed at 80 % power |\n| --- | --- |\n";
  for (const double ratio : {1.15, study.ratio_expected, 1.5}) {
    text += "| " + number_text(ratio) + " | " +
            std::to_string(participants_needed(std::log(ratio), study.sd_expected)) + " |\n";
  }
  return text;
}

/// Whoever breaks a line would write one of the registration's own.
std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, ' ');
  return text;
}

}  // namespace

std::string preregistration(const Study& study,
                            const Fingerprints& fingerprints,
                            const std::string& made_by) {
  std::string text = "# Pre-registration: " + study.name + "\n\n";
  const auto say = [&](const std::string& what, const std::string& is) {
    text += "- " + what + ": " + (is.empty() ? "missing" : one_line(is)) + "\n";
  };
  say("Question", study.question);
  say("Task",
      std::string{task_name(study)} + ", " +
          (study.task.places > 0
               ? "an area of " + number_text(1e3 * study.search.side) + " mm, found within " +
                     number_text(1e3 * study.search.within) + " mm of the axis"
               : std::to_string(felt_intervals(study.task)) + " intervals"));
  std::string conditions;
  for (const Condition& one : study.conditions) {
    conditions += (conditions.empty() ? "" : "; ") + one.name;
  }
  say("Conditions, all for everybody", conditions);
  say("Measure",
      study.task.yes_no      ? "d', criterion, and the depth at d' = 1"
      : study.task.two_sided ? "PSE and ln JND"
                             : (study.depths.empty() ? "ln JND, " : "depth and ln JND, ") +
                                   per_cent((1 + chance(study.task)) / 2) + " right");
  say("Primary comparison", study.primary);
  say("Participants",
      std::to_string(study.participants) + "; expected sd of differences of ln JND " +
          number_text(study.sd_expected));
  say("Method",
      std::string{to_string(study.method.kind)} + ", " + std::to_string(study.trials) +
          " trials in " + std::to_string(study.tracks) +
          " interleaved tracks; it stops after this number");
  say("Catch trials", per_cent(study.catch_share) + " more, at the easiest level");
  say("Excluded",
      "fewer than " + per_cent(study.catch_right_min) +
          " of catch trials right; practice not done after " +
          std::to_string(study.practice.trials_max) + " trials");
  say("Order", "rows of a Williams square; stimuli balanced, 4 equal ones on end at most");
  say("Analysis",
      "posterior of each participant and condition (palp-study fit); paired t and signed ranks of "
      "ln JND, Holm over the family; equal only by two one-sided tests within " +
          number_text(study.margin));
  say("Ethics", study.ethics.body.empty() ? "" : study.ethics.body + ", " + study.ethics.number);
  say("Seed", std::to_string(study.seed));
  say("SHA-256 of the study file", fingerprints.study);
  say("SHA-256 of the schedule", fingerprints.schedule);
  say("SHA-256 of the key of the letters", fingerprints.key);
  say("Made by", made_by);
  return text + "\n" + power_table(study);
}

}  // namespace palp::study
