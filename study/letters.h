#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "study/study_file.h"

/// Which condition has which letter. The schedule is about letters and anybody may read it; this is
/// the secret, and code/key.json alone holds it. Pure.
namespace palp::study {

/// Conditions by their numbers in the study file, in the order of the letters.
using Letters = std::vector<std::size_t>;

/// Dealt out by `number`, which nobody is to know.
[[nodiscard]] Letters drawn_letters(std::size_t conditions, std::uint64_t number);

/// code/key.json. `salt`: what nobody can guess, for the few orders that there are would else be
/// found by the registered hash of this text.
[[nodiscard]] std::string key_text(const Study& study,
                                   const Letters& letters,
                                   const std::string& salt);

/// `study` as its file has it, `name` of the key's file. The sentence says what does not fit.
[[nodiscard]] Result<Letters> parse_key(std::string_view text,
                                        const std::string& name,
                                        const Study& study);

/// The study with its conditions in the order of the letters: all that is drawn, fitted and shown
/// goes by them.
[[nodiscard]] Study lettered(Study study, const Letters& letters);

}  // namespace palp::study
