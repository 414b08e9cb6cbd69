#include "netem/syntax/impairment_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "common/core/printable.h"

namespace palp::netem {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

std::string quoted(std::string_view text) {
  return text.empty() ? std::string{"the end"} : "'" + palp::printable(text) + "'";
}

std::string lower(std::string_view text) {
  std::string small{text};
  std::transform(small.begin(), small.end(), small.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return small;
}

struct Unit {
  std::string_view name;
  double size;
};

template <std::size_t N>
std::optional<double> find_unit(const std::array<Unit, N>& units, std::string_view name) {
  const std::string small = lower(name);
  for (const Unit& unit : units) {
    if (unit.name == small) return unit.size;
  }
  return std::nullopt;
}

/// A number and what stands glued behind it.
struct Quantity {
  double value{};
  std::string_view digits;
  std::string_view unit;
};

std::optional<Quantity> split(std::string_view text) {
  Quantity quantity;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, quantity.value);
  if (read.ec != std::errc{} || !std::isfinite(quantity.value)) return std::nullopt;
  const auto length = static_cast<std::size_t>(read.ptr - text.data());
  quantity.digits = text.substr(0, length);
  quantity.unit = text.substr(length);
  return quantity;
}

/// 5% -> the number nearest to 0.05: two is taken from the exponent in the text, so that a share
/// written by to_string reads back without rounding.
double percent_to_share(std::string_view digits) {
  std::string text{digits};
  long exponent = 0;
  if (const std::size_t e = text.find_first_of("eE"); e != std::string::npos) {
    exponent = std::strtol(text.c_str() + e + 1, nullptr, 10);
    text.erase(e);
  }
  // strtol stops at its least number, behind which two less would be undefined.
  exponent = std::max(exponent, std::numeric_limits<long>::min() + 2);
  text += "e" + std::to_string(exponent - 2);
  double share = 0;
  std::from_chars(text.data(), text.data() + text.size(), share);
  return share;
}

/// Bits per second in a unit of a rate; tc's "bps" are bytes.
std::optional<double> rate_unit(std::string_view unit) {
  constexpr std::array<Unit, 19> kUnits{{{"", 1},
                                         {"bit", 1},
                                         {"kibit", 1024.0},
                                         {"kbit", 1e3},
                                         {"mibit", 1048576.0},
                                         {"mbit", 1e6},
                                         {"gibit", 1073741824.0},
                                         {"gbit", 1e9},
                                         {"tibit", 1099511627776.0},
                                         {"tbit", 1e12},
                                         {"bps", 8},
                                         {"kibps", 8 * 1024.0},
                                         {"kbps", 8e3},
                                         {"mibps", 8 * 1048576.0},
                                         {"mbps", 8e6},
                                         {"gibps", 8 * 1073741824.0},
                                         {"gbps", 8e9},
                                         {"tibps", 8 * 1099511627776.0},
                                         {"tbps", 8e12}}};
  return find_unit(kUnits, unit);
}

std::optional<double> size_unit(std::string_view unit) {
  constexpr std::array<Unit, 11> kUnits{{{"", 1},
                                         {"b", 1},
                                         {"k", 1024.0},
                                         {"kb", 1024.0},
                                         {"m", 1048576.0},
                                         {"mb", 1048576.0},
                                         {"g", 1073741824.0},
                                         {"gb", 1073741824.0},
                                         {"kbit", 128.0},
                                         {"mbit", 131072.0},
                                         {"gbit", 134217728.0}}};
  return find_unit(kUnits, unit);
}

std::string plain(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

}  // namespace

std::optional<double> time_unit(std::string_view unit) {
  constexpr std::array<Unit, 13> kUnits{{{"", 1e3},
                                         {"s", 1e9},
                                         {"sec", 1e9},
                                         {"secs", 1e9},
                                         {"ms", 1e6},
                                         {"msec", 1e6},
                                         {"msecs", 1e6},
                                         {"us", 1e3},
                                         {"usec", 1e3},
                                         {"usecs", 1e3},
                                         {"ns", 1},
                                         {"nsec", 1},
                                         {"nsecs", 1}}};
  return find_unit(kUnits, unit);
}

void WordReader::advance() {
  const std::size_t begin = std::min(text_.find_first_not_of(kBlank, position_), text_.size());
  const std::size_t end = std::min(text_.find_first_of(kBlank, begin), text_.size());
  word_ = {text_.substr(begin, end - begin), begin + 1};
  position_ = end;
}

Word WordReader::take() {
  const Word word = word_;
  advance();
  return word;
}

bool WordReader::take_if(std::string_view text) {
  if (error_ || word_.text != text) return false;
  advance();
  return true;
}

bool WordReader::next_is_number() const {
  return !error_ && !at_end() && std::isalpha(static_cast<unsigned char>(word_.text.front())) == 0;
}

void WordReader::refuse(const Word& word, const std::string& expected) {
  refuse(word, Error{"found " + quoted(word.text) + ", expected " + expected});
}

void WordReader::refuse(const Word& word, const Error& why) {
  if (error_) return;
  error_ = Error{"impairment, column " + std::to_string(word.column) + ": " + why.text};
}

void WordReader::once(const Word& word, const std::string& what) {
  if (!said_.insert(what).second) refuse(word, "it only once");
}

Duration WordReader::time(std::string_view what) {
  const Word word = take();
  const auto quantity = split(word.text);
  const auto unit = quantity ? time_unit(quantity->unit) : std::nullopt;
  if (!unit) {
    refuse(word, std::string{what} + " as 20ms: s, ms, us, ns, or bare microseconds");
    return {};
  }
  const double nanoseconds = quantity->value * *unit;
  if (!(nanoseconds >= 0 && nanoseconds <= static_cast<double>(kTimeMax.count()))) {
    refuse(word, std::string{what} + " from 0s to 1000000s");
    return {};
  }
  return Duration{std::llround(nanoseconds)};
}

Duration WordReader::positive_time(std::string_view what) {
  const Word word = word_;
  const Duration span = time(what);
  if (span <= Duration{}) refuse(word, std::string{what} + " above 0");
  return span;
}

double WordReader::share(std::string_view what) {
  const Word word = take();
  const auto quantity = split(word.text);
  if (!quantity || (quantity->unit != "%" && !quantity->unit.empty())) {
    refuse(word, std::string{what} + " in per cent, as 5%");
    return 0;
  }
  if (!(quantity->value >= 0 && quantity->value <= 100)) {
    refuse(word, std::string{what} + " from 0% to 100%");
    return 0;
  }
  return percent_to_share(quantity->digits);
}

Chance WordReader::chance(std::string_view what) {
  Chance chance;
  chance.share = share(what);
  if (next_is_number()) chance.correlation = share("the correlation of successive datagrams");
  return chance;
}

double WordReader::frequency(std::string_view what) {
  const Word word = take();
  const auto quantity = split(word.text);
  const double per = !quantity ? 0 : quantity->unit == "/s" ? 1 : quantity->unit == "/min" ? 60 : 0;
  if (per == 0 || !(quantity->value >= 0) || quantity->value / per > kBurstRateMax) {
    refuse(word, std::string{what} + ", as 0.2/s or 3/min, from 0/s to 1000000/s");
    return 0;
  }
  return quantity->value / per;
}

std::uint64_t WordReader::rate(std::string_view what) {
  const Word word = take();
  const auto quantity = split(word.text);
  const auto unit = quantity ? rate_unit(quantity->unit) : std::nullopt;
  const double bits = unit ? quantity->value * *unit : 0;
  if (!(bits >= 8 && bits <= 8e15)) {
    refuse(word, std::string{what} + " as 2mbit or 250kbps (bytes), from 8bit to 8000tbit");
    return 8;
  }
  return static_cast<std::uint64_t>(bits / 8);
}

std::uint64_t WordReader::size(std::string_view what, std::uint64_t most) {
  const Word word = take();
  const auto quantity = split(word.text);
  const auto unit = quantity ? size_unit(quantity->unit) : std::nullopt;
  const double value = unit ? quantity->value * *unit : -1;
  if (!(value >= 1 && value <= static_cast<double>(most))) {
    refuse(word, std::string{what} + " from 1 to " + std::to_string(most));
    return 1;
  }
  return static_cast<std::uint64_t>(value);
}

std::int64_t WordReader::count(std::string_view what, std::int64_t least, std::int64_t most) {
  const Word word = take();
  std::int64_t value = 0;
  const char* const end = word.text.data() + word.text.size();
  const auto read = std::from_chars(word.text.data(), end, value);
  if (word.text.empty() || read.ec != std::errc{} || read.ptr != end || value < least ||
      value > most) {
    refuse(word,
           std::string{what} + ", a whole number from " + std::to_string(least) + " to " +
               std::to_string(most));
    return least;
  }
  return value;
}

double WordReader::number(std::string_view what, double least, double most) {
  const Word word = take();
  const auto quantity = split(word.text);
  if (!quantity || !quantity->unit.empty() || !(quantity->value >= least) ||
      !(quantity->value <= most)) {
    refuse(word, std::string{what} + ", a number from " + plain(least) + " to " + plain(most));
    return least;
  }
  return quantity->value;
}

}  // namespace palp::netem
