#pragma once

#include <string>
#include <vector>

#include "common/core/result.h"

namespace palp::lab {

/// "5,10,15" of a flag, each from `least` to `most`. The sentence begins with the flag.
[[nodiscard]] Result<std::vector<double>> parse_numbers(const std::string& flag,
                                                        const std::string& text,
                                                        double least,
                                                        double most);

}  // namespace palp::lab
