#pragma once

#include <string>

#include "study/study_file.h"

namespace palp::study {

/// SHA-256 of what is registered, in hexadecimal digits.
struct Fingerprints {
  std::string study{};     ///< the study file
  std::string schedule{};  ///< schedule.json
  std::string key{};       ///< key.json
};

/// What is registered before anybody is asked: question, conditions, measure, numbers and why,
/// order, exclusions, analysis, seed, fingerprints. `study` as its file has it, so that the order
/// of its conditions tells no letter; `made_by`: version and commit of the program. Pure.
[[nodiscard]] std::string preregistration(const Study& study,
                                          const Fingerprints& fingerprints,
                                          const std::string& made_by);

}  // namespace palp::study
