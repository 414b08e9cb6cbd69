#include "surgeon_site/script_reader.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "common/core/conventions.h"

namespace palp::surgeon {
namespace {

constexpr double kScriptSecondsMax = 4 * 3600.0;  ///< [s], bounds the memory a file can ask for
constexpr double kPlaceMin = -60e-3;              ///< [m], travel of a hand
constexpr double kPlaceMax = 20e-3;               ///< [m]
constexpr double kReachMax = 200e-3;              ///< [m], along the surface, either way

/// One word of a line: what it means and what it may be.
struct Word {
  const char* name;  ///< as printed, its unit at the end
  double low;        ///< in that unit
  double high;       ///< in that unit
  bool above_low{};  ///< `low` itself is refused
  bool whole{};      ///< a whole number
};

constexpr Word kSeconds{"SECONDS", 0.02, 3600};
constexpr Word kMoveSeconds{"MOVE_SECONDS", 0.02, 3600};
constexpr Word kHoldSeconds{"HOLD_SECONDS", 0.02, 3600};
constexpr Word kPauseSeconds{"PAUSE_SECONDS", 0, 3600};
constexpr Word kDepth{"DEPTH_MM", 0, 20, true};
constexpr Word kPosition{"POSITION_MM", kPlaceMin / kMillimetre, kPlaceMax / kMillimetre};
constexpr Word kAmplitude{"AMPLITUDE_MM", 0, 30, true};
constexpr Word kFrequency{"FREQUENCY_HZ", 0, 10, true};
constexpr Word kCount{"COUNT", 1, 1000, false, true};
constexpr Word kX{"X_MM", -kReachMax / kMillimetre, kReachMax / kMillimetre};
constexpr Word kY{"Y_MM", -kReachMax / kMillimetre, kReachMax / kMillimetre};

constexpr std::size_t kWordsMax = 4;
constexpr double kStandardTap = 4e-3;  ///< [m], as deep as the standard palpation taps

struct Command {
  const char* name;
  std::array<const Word*, kWordsMax> words;  ///< nullptr: no more
};

constexpr std::array kCommands{
    Command{"hold", {&kSeconds}},
    Command{"air", {&kAmplitude, &kFrequency, &kSeconds}},
    Command{"move", {&kPosition, &kSeconds}},
    Command{"taps", {&kCount, &kDepth, &kSeconds, &kPauseSeconds}},
    Command{"press", {&kDepth, &kMoveSeconds, &kHoldSeconds}},
    Command{"lift", {&kMoveSeconds, &kHoldSeconds}},
};

std::string quoted(std::string_view text) {
  constexpr std::size_t kShown = 40;  // [bytes], a sentence stays a sentence
  std::string out{"'"};
  for (const char c : text.substr(0, kShown)) {
    out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  }
  return out + (text.size() > kShown ? "...'" : "'");
}

std::string shown(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

std::string usage(const Command& command) {
  std::string out = command.name;
  for (const Word* word : command.words) {
    if (word != nullptr) out.append(" ").append(word->name);
  }
  return out;
}

std::optional<double> number_in(std::string_view text) noexcept {
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// Pieces of one line that are looked at: more than any line may have, so that a long line takes no
/// more memory than its text.
constexpr std::size_t kPiecesMax = 16;

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kSpace = " \t\r";
  std::vector<std::string_view> words;
  line = line.substr(0, line.find('#'));
  std::size_t at = line.find_first_not_of(kSpace);
  while (at != std::string_view::npos && words.size() < kPiecesMax) {
    const std::size_t end = std::min(line.find_first_of(kSpace, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kSpace, end);
  }
  return words;
}

/// Takes the next line off `text`.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

Result<double> read_word(const Word& word, std::string_view text) {
  const std::optional<double> value = number_in(text);
  if (!value) return fail(std::string{word.name} + " " + quoted(text) + " is not a number");
  const bool too_low = word.above_low ? *value <= word.low : *value < word.low;
  if (too_low || *value > word.high || (word.whole && *value != std::floor(*value))) {
    return fail(std::string{word.name} + " " + shown(*value) + " must be " +
                (word.whole ? "a whole number " : "") + (word.above_low ? "above " : "from ") +
                shown(word.low) + (word.above_low ? " and at most " : " to ") + shown(word.high));
  }
  return *value;
}

/// The numbers of a line, in the order of the command's words.
Result<std::array<double, kWordsMax>> read_words(const Command& command,
                                                 const std::vector<std::string_view>& words) {
  std::size_t expected = 0;
  while (expected < kWordsMax && command.words[expected] != nullptr) ++expected;
  if (words.size() != expected + 1) {
    return fail("expected " + quoted(usage(command)) + ", found " +
                std::to_string(words.size() - 1) + " value(s)");
  }
  std::array<double, kWordsMax> values{};
  for (std::size_t i = 0; i < expected; ++i) {
    const Result<double> value = read_word(*command.words[i], words[i + 1]);
    if (!value) return fail(value.error().text + " in " + quoted(usage(command)));
    values[i] = *value;
  }
  return values;
}

double metres(double millimetres) noexcept { return millimetres * kMillimetre; }

Result<void> add_air(ScriptBuilder& script, const std::array<double, kWordsMax>& values) {
  const double amplitude = metres(values[0]);
  const double cycles = values[1] * values[2];
  if (std::abs(cycles - std::round(cycles)) > 1e-6 || cycles < 0.5) {
    return fail("'air' must last a whole number of cycles, FREQUENCY_HZ times SECONDS is " +
                shown(cycles));
  }
  if (script.position() + amplitude > 0 || script.position() - amplitude < kPlaceMin) {
    return fail("'air' must stay in free air, from -60 to 0 mm; it reaches " +
                shown((script.position() + amplitude) / kMillimetre) + " mm");
  }
  script.air(amplitude, values[1], from_seconds(values[2]));
  return {};
}

/// "A", "B", "12.5,3" or "12.5", which lies in the line of both.
Result<Place> read_place(std::string_view text) {
  if (text == "A") return kSiteA;
  if (text == "B") return kSiteB;
  const std::size_t comma = text.find(',');
  const bool alone = comma == std::string_view::npos;
  const Result<double> x = read_word(kX, text.substr(0, comma));
  if (alone && !number_in(text)) {
    return fail("PLACE " + quoted(text) + " is neither A, B nor X_MM,Y_MM");
  }
  if (!x) return tl::unexpected(x.error());
  const Result<double> y = alone ? Result<double>{0.0} : read_word(kY, text.substr(comma + 1));
  if (!y) return tl::unexpected(y.error());
  return Place{metres(*x), metres(*y)};
}

Result<void> needs_clear(const ScriptBuilder& script, const std::string& what) {
  if (script.position() <= 0) return {};
  return fail("'" + what + "' needs the hand clear of the tissue, but it is at " +
              shown(script.position() / kMillimetre) + " mm: lift first");
}

Result<void> add_site(ScriptBuilder& script, const std::vector<std::string_view>& words) {
  if (words.size() != 2) return fail("expected 'site PLACE'");
  if (const auto clear = needs_clear(script, "site"); !clear) return clear;
  const Result<Place> place = read_place(words[1]);
  if (!place) return tl::unexpected(place.error());
  script.site(*place);
  return {};
}

Result<void> add_travel(ScriptBuilder& script, const std::vector<std::string_view>& words) {
  if (words.size() != 3) return fail("expected 'move to PLACE'");
  if (const auto clear = needs_clear(script, "move to"); !clear) return clear;
  const Result<Place> place = read_place(words[2]);
  if (!place) return tl::unexpected(place.error());
  script.travel(*place);
  return {};
}

Result<void> add_taps_at(ScriptBuilder& script, const std::vector<std::string_view>& words) {
  const bool sentence =
      words.size() == 5 && (words[2] == "times" || words[2] == "time") && words[3] == "at";
  if (!sentence) return fail("expected 'tap COUNT times at PLACE'");
  if (const auto clear = needs_clear(script, "tap"); !clear) return clear;
  const Result<double> count = read_word(kCount, words[1]);
  if (!count) return tl::unexpected(count.error());
  const Result<Place> place = read_place(words[4]);
  if (!place) return tl::unexpected(place.error());
  script.travel(*place);
  if (script.position() != kNearPlace) script.move(kNearPlace, from_seconds(0.5));
  script.taps(static_cast<std::uint32_t>(*count), kStandardTap, from_seconds(1), from_seconds(0.5));
  return {};
}

Result<void> add_drag(ScriptBuilder& script, const std::vector<std::string_view>& words) {
  const bool sentence =
      words.size() == 6 && words[1] == "to" && words[3] == "in" && words[5] == "s";
  if (!sentence) return fail("expected 'drag to PLACE in SECONDS s'");
  if (script.position() <= 0) {
    return fail("'drag' needs the hand pressed into the tissue, but it is at " +
                shown(script.position() / kMillimetre) + " mm: press first");
  }
  const Result<Place> place = read_place(words[2]);
  if (!place) return tl::unexpected(place.error());
  const Result<double> span = read_word(kSeconds, words[4]);
  if (!span) return tl::unexpected(span.error());
  script.drag(*place, from_seconds(*span));
  return {};
}

Result<void> add_search(ScriptBuilder& script, const std::vector<std::string_view>& words) {
  if (words.size() != 5 || words[2] != "taps" || words[3] != "from") {
    return fail("expected 'search COUNT taps from PLACE'");
  }
  if (const auto clear = needs_clear(script, "search"); !clear) return clear;
  constexpr Word kTaps{"COUNT", 3, 100, false, true};
  const Result<double> count = read_word(kTaps, words[1]);
  if (!count) return tl::unexpected(count.error());
  const Result<Place> place = read_place(words[4]);
  if (!place) return tl::unexpected(place.error());
  script.search(static_cast<std::uint32_t>(*count), *place);
  return {};
}

Result<void> add_phase(ScriptBuilder& script, const std::vector<std::string_view>& words) {
  if (words[0] == "site") return add_site(script, words);
  if (words[0] == "tap") return add_taps_at(script, words);
  if (words[0] == "drag") return add_drag(script, words);
  if (words[0] == "search") return add_search(script, words);
  if (words[0] == "move" && words.size() > 1 && words[1] == "to") return add_travel(script, words);
  const Command* command = nullptr;
  for (const Command& known : kCommands) {
    if (words[0] == known.name) command = &known;
  }
  if (command == nullptr) {
    return fail("unknown phase " + quoted(words[0]) +
                ", expected hold, air, move, taps, press, lift, site, tap, drag or search");
  }
  const Result<std::array<double, kWordsMax>> read = read_words(*command, words);
  if (!read) return fail(read.error().text);
  const std::array<double, kWordsMax>& values = *read;
  if (words[0] == "hold") {
    script.hold(from_seconds(values[0]));
  } else if (words[0] == "air") {
    return add_air(script, values);
  } else if (words[0] == "move") {
    script.move(metres(values[0]), from_seconds(values[1]));
  } else if (words[0] == "taps") {
    script.taps(static_cast<std::uint32_t>(values[0]),
                metres(values[1]),
                from_seconds(values[2]),
                from_seconds(values[3]));
  } else if (words[0] == "press") {
    script.press(metres(values[0]), from_seconds(values[1]), from_seconds(values[2]));
  } else {
    script.lift(from_seconds(values[0]), from_seconds(values[1]));
  }
  return {};
}

tl::unexpected<Error> fail_in_line(std::size_t line, const std::string& text) {
  return fail("line " + std::to_string(line) + ": " + text);
}

/// The cells of a CSV row; an empty row has none.
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  while (!line.empty() && cells.size() < kPiecesMax) {
    const std::size_t end = std::min(line.find(','), line.size());
    cells.push_back(line.substr(0, end));
    if (end + 1 == line.size()) cells.push_back({});
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return cells;
}

struct ReplayRow {
  double time{};      ///< [s]
  double position{};  ///< [m]
  Place place{};
};

Result<ReplayRow> read_row(const std::vector<std::string_view>& cells, std::size_t columns) {
  constexpr double kReachMm = kReachMax / kMillimetre;
  const std::array<Word, 4> kColumns{
      Word{"t_s", -1e9, 1e9},
      Word{"position_mm", kPlaceMin / kMillimetre, kPlaceMax / kMillimetre},
      Word{columns == 3 ? "lateral_mm" : "x_mm", -kReachMm, kReachMm},
      Word{"y_mm", -kReachMm, kReachMm}};
  if (cells.size() != columns) {
    return fail("expected " + std::to_string(columns) + " columns, found " +
                std::to_string(cells.size()));
  }
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < columns; ++i) {
    const Result<double> value = read_word(kColumns[i], cells[i]);
    if (!value) return fail(value.error().text);
    values[i] = *value;
  }
  return ReplayRow{values[0], metres(values[1]), {metres(values[2]), metres(values[3])}};
}

}  // namespace

Result<GestureScript> parse_script(std::string_view text, double hand_stiffness) {
  ScriptBuilder script{hand_stiffness};
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::vector<std::string_view> words = words_of(next_line(text));
    if (words.empty()) continue;
    const Result<void> added = add_phase(script, words);
    if (!added) return fail_in_line(line, added.error().text);
    if (seconds(script.length()) > kScriptSecondsMax) {
      return fail_in_line(line, "the script is longer than 4 hours");
    }
  }
  if (script.length() == Duration{0}) return fail("the script has no phase");
  return script.build();
}

Result<GestureScript> parse_replay(std::string_view text) {
  const std::vector<std::string_view> header = cells_of(next_line(text));
  using Header = std::vector<std::string_view>;
  const bool known = header == Header{"t_s", "position_mm"} ||
                     header == Header{"t_s", "position_mm", "x_mm", "y_mm"} ||
                     header == Header{"t_s", "position_mm", "lateral_mm"};
  if (!known) {
    return fail(
        "line 1: expected the header 't_s,position_mm', 't_s,position_mm,x_mm,y_mm' or "
        "'t_s,position_mm,lateral_mm'");
  }
  std::vector<ReplayPoint> points;
  double first_time = 0;  // [s]
  for (std::size_t line = 2; !text.empty(); ++line) {
    const std::vector<std::string_view> cells = cells_of(next_line(text));
    if (cells.empty()) continue;
    const Result<ReplayRow> row = read_row(cells, header.size());
    if (!row) return fail_in_line(line, row.error().text);
    if (points.empty()) first_time = row->time;
    if (row->time - first_time > kScriptSecondsMax) {
      return fail_in_line(line, "the recording is longer than 4 hours");
    }
    const Duration at = from_seconds(row->time - first_time);
    if (!points.empty() && at <= points.back().at) {
      return fail_in_line(line, "t_s " + shown(row->time) + " does not rise");
    }
    points.push_back({at, row->position, row->place});
  }
  if (points.size() < 2) return fail("a recording needs two rows or more");
  return GestureScript{std::move(points)};
}

}  // namespace palp::surgeon
