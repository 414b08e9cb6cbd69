#include "common/core/depth_text.h"

#include <cmath>
#include <cstdio>

#include "common/core/conventions.h"

namespace palp {
namespace {

std::string millimetres(double metres, int decimals) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, metres / kMillimetre);
  return text;
}

}  // namespace

std::string depth_text(const DepthStatement& statement) {
  switch (statement.verdict) {
    case DepthVerdict::Found: {
      std::string text = millimetres(statement.depth, 1) + " mm";
      if (statement.high > statement.low) {
        text +=
            ", between " + millimetres(statement.low, 1) + " and " + millimetres(statement.high, 1);
      }
      return text;
    }
    case DepthVerdict::None:
      if (!(statement.low > 0)) return "no inclusion";
      // Rounded towards what is surely excluded.
      return "no inclusion of radius >= 5 mm above " +
             millimetres(std::floor(statement.low / kMillimetre) * kMillimetre, 0) + " mm";
    case DepthVerdict::Invalid:
      break;
  }
  return "? (" + std::string{to_string(statement.reason)} + ")";
}

}  // namespace palp
