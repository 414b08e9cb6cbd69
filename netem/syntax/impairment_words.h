#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "common/core/result.h"
#include "common/core/time.h"
#include "netem/model/impairment.h"

namespace palp::netem {

struct Word {
  std::string_view text;  ///< empty: the end
  std::size_t column{};   ///< from 1
};

/// Reads an impairment's text word by word and its quantities in tc's units. After the first
/// refusal everything else is skipped and harmless.
class WordReader {
 public:
  explicit WordReader(std::string_view text) : text_{text} { advance(); }

  [[nodiscard]] const Word& peek() const { return word_; }
  Word take();
  /// Takes the next word if it is this one.
  bool take_if(std::string_view text);
  [[nodiscard]] bool at_end() const { return word_.text.empty(); }
  /// Not a letter in front, so nothing but a number can be meant.
  [[nodiscard]] bool next_is_number() const;

  void refuse(const Word& word, const std::string& expected);
  void refuse(const Word& word, const Error& why);
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  /// Refuses `word` when `what` was said before.
  void once(const Word& word, const std::string& what);
  [[nodiscard]] bool said(const std::string& what) const { return said_.contains(what); }

  /// A time; bare: microseconds.
  Duration time(std::string_view what);
  Duration positive_time(std::string_view what);
  /// A share; bare: per cent.
  double share(std::string_view what);
  /// A share and, if a number follows, a correlation.
  Chance chance(std::string_view what);
  /// How often, "0.2/s" or "3/min" [1/s].
  double frequency(std::string_view what);
  /// A rate, "2mbit", "250kbps" (bytes); bare: bit/s. [bytes/s]
  std::uint64_t rate(std::string_view what);
  /// A size, "10k" [bytes] or a plain count.
  std::uint64_t size(std::string_view what, std::uint64_t most);
  std::int64_t count(std::string_view what, std::int64_t least, std::int64_t most);
  double number(std::string_view what, double least, double most);

 private:
  void advance();

  std::string_view text_;
  std::size_t position_{};
  Word word_;  ///< the next one
  std::optional<Error> error_;
  std::set<std::string> said_;
};

/// Nanoseconds in one unit of tc's spelling; nullopt: no such unit. Empty: microseconds.
[[nodiscard]] std::optional<double> time_unit(std::string_view unit);

/// Reads one of tc's clauses if `word`, just taken, begins one: its name, or the beginning of it,
/// as tc allows. @returns false: it is none.
bool read_tc_clause(const Word& word, WordReader& words, Impairment& into, const FileReader& read);

/// Reads one of our own clauses. @returns false: it is none.
bool read_own_clause(const Word& word, WordReader& words, Impairment& into, const FileReader& read);

/// The content of the file that `name`, just taken, says; refused where there is none.
[[nodiscard]] std::optional<std::string> read_named(const Word& name,
                                                    WordReader& words,
                                                    const std::string& expected,
                                                    const FileReader& read);

/// The shape that follows `distribution`: one of ours, or a table of that name in tc's folder.
void read_shape(WordReader& words, Mode mode, DelayLaw& law, const FileReader& read);

}  // namespace palp::netem
