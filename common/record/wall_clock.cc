#include "common/record/wall_clock.h"

#include <array>
#include <chrono>
#include <cstdio>

namespace palp::record {

std::string session_id_text(std::uint64_t session_id) {
  std::array<char, 24> text{};
  const int size = std::snprintf(
      text.data(), text.size(), "%016llx", static_cast<unsigned long long>(session_id));
  return {text.data(), static_cast<std::size_t>(size)};
}

std::string utc_text(std::uint64_t stamp) {
  using std::chrono::days;
  using std::chrono::sys_days;
  constexpr std::uint64_t kNanoseconds = 1'000'000'000;
  constexpr std::uint64_t kDay = 86'400;
  const std::uint64_t whole = stamp / kNanoseconds;
  const std::chrono::year_month_day date{sys_days{days{static_cast<std::int64_t>(whole / kDay)}}};
  const std::uint64_t second = whole % kDay;
  std::array<char, 64> text{};
  const int size = std::snprintf(text.data(),
                                 text.size(),
                                 "%04d-%02u-%02uT%02u:%02u:%02u.%09uZ",
                                 static_cast<int>(date.year()),
                                 static_cast<unsigned>(date.month()),
                                 static_cast<unsigned>(date.day()),
                                 static_cast<unsigned>(second / 3600),
                                 static_cast<unsigned>(second / 60 % 60),
                                 static_cast<unsigned>(second % 60),
                                 static_cast<unsigned>(stamp % kNanoseconds));
  return {text.data(), static_cast<std::size_t>(size)};
}

}  // namespace palp::record
