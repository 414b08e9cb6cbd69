#pragma once

#include <string_view>

#include "common/core/check.h"
#include "netem/model/impairment.h"

/// Impairments for tests.
namespace palp::netem {

/// The impairment that `words` say; they must be sound.
inline Impairment impaired(std::string_view words) {
  const auto impairment = parse_impairment(words);
  PALP_CHECK(impairment.has_value(), impairment.error().text.c_str());
  return *impairment;
}

}  // namespace palp::netem
