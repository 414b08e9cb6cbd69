#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "netem/impairment.h"

namespace palp::netem {
namespace {

constexpr std::string_view kBlank = " \t\r\n";
constexpr std::string_view kClauses = "delay, loss, duplicate, blackout or order";

struct Word {
  std::string_view text;  ///< empty: the end
  std::size_t column{};   ///< from 1
};

std::string quoted(std::string_view text) {
  return text.empty() ? std::string{"the end"} : "'" + std::string{text} + "'";
}

/// Nanoseconds in one unit of tc's spelling `unit`; nullopt: no such unit.
std::optional<double> unit_size(std::string_view unit) {
  struct Unit {
    std::string_view name;
    double nanoseconds;
  };
  constexpr std::array<Unit, 12> kUnits{{{"s", 1e9},
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
  std::string lower{unit};
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  for (const Unit& candidate : kUnits) {
    if (candidate.name == lower) return candidate.nanoseconds;
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

/// Reads word by word; after the first refusal everything else is skipped and harmless.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_{text} { advance(); }

  Result<Impairment> parse() {
    if (word_.text == "none") {
      take();
      if (!at_end()) refuse(word_, "nothing after 'none'");
    }
    while (!error_ && !at_end()) clause(take());
    if (error_) return tl::unexpected<Error>(*error_);
    return impairment_;
  }

 private:
  void advance() {
    const std::size_t begin = std::min(text_.find_first_not_of(kBlank, position_), text_.size());
    const std::size_t end = std::min(text_.find_first_of(kBlank, begin), text_.size());
    word_ = {text_.substr(begin, end - begin), begin + 1};
    position_ = end;
  }

  Word take() {
    const Word word = word_;
    advance();
    return word;
  }

  [[nodiscard]] bool at_end() const { return word_.text.empty(); }

  [[nodiscard]] bool next_is_number() const {
    return !at_end() && std::isalpha(static_cast<unsigned char>(word_.text.front())) == 0;
  }

  void refuse(const Word& word, const std::string& expected) {
    if (error_) return;
    error_ = Error{"impairment, column " + std::to_string(word.column) + ": found " +
                   quoted(word.text) + ", expected " + expected};
  }

  void clause(const Word& word) {
    if (word.text == "delay") return delay(word);
    if (word.text == "loss") return loss();
    if (word.text == "duplicate") {
      once(word, seen_duplicate_);
      impairment_.duplicate = share("the probability of a copy");
      return;
    }
    if (word.text == "blackout") return blackout(word);
    if (word.text == "order") return order(word);
    refuse(word, std::string{kClauses});
  }

  void delay(const Word& word) {
    once(word, seen_delay_);
    DelayLaw& law = impairment_.delay;
    law.mean = time("the mean delay");
    bool jitter_given = false;
    if (next_is_number()) {
      law.jitter = time("the jitter");
      jitter_given = true;
    }
    bool correlated = false;
    if (jitter_given && next_is_number()) {
      law.correlation = share("the correlation of successive delays");
      correlated = true;
    }
    bool shaped = false;
    bool floored = false;
    for (; !error_;) {
      if (word_.text == "distribution") {
        const Word option = take();
        once(option, shaped);
        needs_jitter(option, jitter_given);
        law.shape = shape();
      } else if (word_.text == "floor") {
        once(take(), floored);
        law.floor = share("the least delay as a share of the mean");
      } else if (word_.text == "correlation-time") {
        const Word option = take();
        needs_jitter(option, jitter_given);
        if (correlated) refuse(option, "one correlation only: per datagram or in time");
        correlated = true;
        law.correlation_time = positive_time("the correlation time");
      } else {
        return;
      }
    }
  }

  void needs_jitter(const Word& option, bool jitter_given) {
    if (!jitter_given) refuse(option, "a jitter before it, as in 'delay 50ms 10ms'");
  }

  DelayShape shape() {
    const Word word = take();
    if (word.text == "normal") return DelayShape::Normal;
    if (word.text != "uniform") refuse(word, "uniform or normal");
    return DelayShape::Uniform;
  }

  void loss() {
    const Word kind = word_;
    if (kind.text == "burst") {
      once(take(), seen_burst_);
      impairment_.burst.rate = rate("the rate of bursts");
      impairment_.burst.length = positive_time("the length of a burst");
    } else if (kind.text == "gilbert-time") {
      once(take(), seen_gilbert_);
      GilbertLaw& law = impairment_.gilbert;
      law.good = stay("the mean stay in the good state");
      law.bad = stay("the mean stay in the bad state");
      if (next_is_number()) law.loss_bad = share("the loss in the bad state");
      if (next_is_number()) law.loss_good = share("the loss in the good state");
    } else {
      if (kind.text == "random") take();
      if (!next_is_number() && kind.text != "random") {
        return refuse(kind, "a share as 5%, or random, burst or gilbert-time");
      }
      once(kind, seen_loss_);
      impairment_.loss = share("the probability of loss");
    }
  }

  void blackout(const Word& word) {
    if (impairment_.blackouts.size() == kBlackoutsMax) {
      refuse(word, "at most " + std::to_string(kBlackoutsMax) + " blackouts");
    }
    Blackout window;
    window.from = time("the begin of the blackout");
    window.length = positive_time("the length of the blackout");
    impairment_.blackouts.push_back(window);
  }

  void order(const Word& word) {
    once(word, seen_order_);
    const Word policy = take();
    if (policy.text == "free") {
      impairment_.order = Order::Free;
    } else if (policy.text != "keep") {
      refuse(policy, "keep or free");
    }
  }

  void once(const Word& word, bool& seen) {
    if (seen) refuse(word, "it only once");
    seen = true;
  }

  Duration time(std::string_view what) {
    const Word word = take();
    const auto quantity = split(word.text);
    const auto size = quantity ? unit_size(quantity->unit) : std::nullopt;
    if (!size) {
      refuse(word, std::string{what} + " with its unit us, ms or s");
      return {};
    }
    const double nanoseconds = quantity->value * *size;
    if (!(nanoseconds >= 0 && nanoseconds <= static_cast<double>(kTimeMax.count()))) {
      refuse(word, std::string{what} + " from 0s to 1000000s");
      return {};
    }
    return Duration{std::llround(nanoseconds)};
  }

  Duration positive_time(std::string_view what) {
    const Word word = word_;
    const Duration span = time(what);
    if (span <= Duration{}) refuse(word, std::string{what} + " above 0");
    return span;
  }

  Duration stay(std::string_view what) {
    const Word word = word_;
    const Duration span = time(what);
    if (span < kStayMin) refuse(word, std::string{what} + " of at least 0.1ms");
    return span;
  }

  double share(std::string_view what) {
    const Word word = take();
    const auto quantity = split(word.text);
    if (!quantity || quantity->unit != "%") {
      refuse(word, std::string{what} + " with a % sign");
      return 0;
    }
    if (!(quantity->value >= 0 && quantity->value <= 100)) {
      refuse(word, std::string{what} + " from 0% to 100%");
      return 0;
    }
    return percent_to_share(quantity->digits);
  }

  double rate(std::string_view what) {
    const Word word = take();
    const auto quantity = split(word.text);
    if (!quantity || quantity->unit != "/s" || !(quantity->value >= 0) ||
        quantity->value > kBurstRateMax) {
      refuse(word, std::string{what} + " per second, as 0.2/s, from 0/s to 1000000/s");
      return 0;
    }
    return quantity->value;
  }

  std::string_view text_;
  std::size_t position_{};
  Word word_;  ///< the next one
  Impairment impairment_;
  std::optional<Error> error_;
  bool seen_delay_{};
  bool seen_loss_{};
  bool seen_burst_{};
  bool seen_gilbert_{};
  bool seen_duplicate_{};
  bool seen_order_{};
};

}  // namespace

Result<Impairment> parse_impairment(std::string_view text) { return Parser{text}.parse(); }

}  // namespace palp::netem
