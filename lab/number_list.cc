#include "lab/number_list.h"

#include "common/config/number.h"
#include "common/core/printable.h"

namespace palp::lab {

Result<std::vector<double>> parse_numbers(const std::string& flag,
                                          const std::string& text,
                                          double least,
                                          double most) {
  std::vector<double> numbers;
  std::string part;
  for (const char c : text + ",") {
    if (c != ',') {
      part += c;
      continue;
    }
    const auto value = config::parse_number(part);
    if (!value || !(*value >= least && *value <= most)) {
      return fail(flag + " is \"" + printable(text) + "\", expected numbers from " +
                  config::number_text(least) + " to " + config::number_text(most) +
                  " with commas between");
    }
    numbers.push_back(*value);
    part.clear();
  }
  return numbers;
}

}  // namespace palp::lab
