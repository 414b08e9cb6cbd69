#pragma once

#include <ostream>
#include <string_view>

#include "tests/house/source.h"

/// Rules about one file. Pure: text in, violations out.
namespace palp::house {

struct Rule {
  std::string_view name;
  Violations (*check)(const Source& source);
};
/// How a failing test names its rule.
inline std::ostream& operator<<(std::ostream& out, const Rule& rule) { return out << rule.name; }

[[nodiscard]] Violations clocks_and_sleeps(const Source& source);
[[nodiscard]] Violations randomness(const Source& source);
[[nodiscard]] Violations threads(const Source& source);
[[nodiscard]] Violations shared_ownership(const Source& source);
[[nodiscard]] Violations temporary_files(const Source& source);
[[nodiscard]] Violations using_namespace(const Source& source);
[[nodiscard]] Violations conditional_code(const Source& source);
[[nodiscard]] Violations throw_on_rt(const Source& source);
[[nodiscard]] Violations members_without_unit(const Source& source);
[[nodiscard]] Violations missing_pragma_once(const Source& source);
[[nodiscard]] Violations long_files(const Source& source);
[[nodiscard]] Violations long_lines(const Source& source);
[[nodiscard]] Violations heavy_files(const Source& source);
[[nodiscard]] Violations unwanted_words(const Source& source);

}  // namespace palp::house
