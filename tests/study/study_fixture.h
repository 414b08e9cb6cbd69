#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "study/plan_command.h"
#include "study/run_command.h"
#include "tests/support/own_path.h"

namespace palp::study::test {

inline constexpr const char* kStudyText = R"(
name: "small" question: "Which?" seed: 5 participants: 3 trials: 8
practice { right: 3 of: 4 trials_max: 12 }
condition { name: "silk" } condition { name: "wool" taps: 1 } condition { name: "felt" }
)";

inline void one_after_the_other(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
}

inline Study small_study() { return *parse_study(kStudyText, "small"); }

inline std::string content_of(const std::string& path) {
  std::ifstream file{path};
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A planned study in a folder of its own.
class PlannedFolder {
 public:
  explicit PlannedFolder(const std::string& text = kStudyText)
      : root_{palp::test::own_path("study" + std::to_string(++count()))} {
    std::filesystem::create_directories(root_);
    std::ofstream{root_ / "study.textproto"} << text;
    planned_ = run_plan({.file = root_ / "study.textproto", .folder = folder(), .letters = 1},
                        "a test",
                        [] { return std::uint64_t{7}; });
  }
  ~PlannedFolder() { std::filesystem::remove_all(root_); }
  PlannedFolder(const PlannedFolder&) = delete;
  PlannedFolder& operator=(const PlannedFolder&) = delete;

  [[nodiscard]] std::string folder() const { return root_ / "out"; }
  [[nodiscard]] std::string beside(const std::string& name) const { return root_ / name; }
  [[nodiscard]] const config::ExitStatus& planned() const { return planned_; }

  /// Everybody, or until an observer throws.
  [[nodiscard]] config::ExitStatus run(
      const MakeObserver& make = formula(),
      std::optional<std::uint64_t> participant = std::nullopt) const {
    return run_run({.folder = folder(), .participant = participant},
                   make,
                   one_after_the_other,
                   [](const std::string&) {});
  }
  /// As a person at the page, whoever answers.
  [[nodiscard]] config::ExitStatus run_person(const MakeObserver& make,
                                              std::uint64_t participant) const {
    return run_run(
        {.folder = folder(), .participant = participant, .observer = std::string{kPerson}},
        make,
        one_after_the_other,
        [](const std::string&) {});
  }
  [[nodiscard]] static MakeObserver formula() {
    return [](const Study& study) -> Result<Observer> {
      return formula_participants(study, PeopleTraits{});
    };
  }
  /// Every file of answers, one after the other.
  [[nodiscard]] std::string answers() const {
    const auto planned = *open_study(folder());
    std::string text;
    const auto ids = *planned.data.participants();
    for (const std::string& id : ids) {
      for (std::size_t block = 1; block <= planned.study.conditions.size(); ++block) {
        text += content_of(planned.data.trials(id, task_name(planned.study), block));
      }
    }
    return text;
  }

 private:
  static int& count() {
    static int made = 0;
    return made;
  }
  std::filesystem::path root_;
  config::ExitStatus planned_;
};

}  // namespace palp::study::test
