#include "netem/model/delay_data.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "common/core/byte_order_mark.h"
#include "common/core/random.h"
#include "netem/model/verdict.h"

namespace palp::netem {
namespace {

constexpr std::size_t kShippedEntries = 4096;
constexpr double kTableScale = 8192;

/// Line by line, field by field, with the place for a refusal.
class Lines {
 public:
  Lines(std::string_view name, std::string_view text)
      : name_{name}, rest_{without_byte_order_mark(text)} {}

  /// Goes to the next line that is neither empty nor a comment. @returns false: there is none.
  bool next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
      ++number_;
      position_ = 0;
      if (line_.find_first_not_of(" \t") != std::string_view::npos && line_.front() != '#') {
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] bool at_end() const { return position_ >= line_.size(); }

  /// The next field up to a comma or blanks; empty at the end of the line, or between commas.
  std::string_view field() {
    begin_ = std::min(line_.find_first_not_of(" \t", position_), line_.size());
    const std::size_t end = std::min(line_.find_first_of(", \t", begin_), line_.size());
    position_ = std::min(line_.find_first_not_of(" \t", end), line_.size());
    if (position_ < line_.size() && line_[position_] == ',') ++position_;
    return line_.substr(begin_, end - begin_);
  }

  template <class Number>
  std::optional<Number> number() {
    const std::string_view text = field();
    Number value{};
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || read.ec != std::errc{} || read.ptr != text.data() + text.size()) {
      return std::nullopt;
    }
    return value;
  }

  /// About the field that was read last.
  [[nodiscard]] tl::unexpected<Error> wrong(const std::string& expected) const {
    return fail(std::string{name_} + ":" + std::to_string(number_) + ":" +
                std::to_string(begin_ + 1) + ": expected " + expected);
  }
  [[nodiscard]] tl::unexpected<Error> missing(const std::string& expected) const {
    return fail(std::string{name_} + ": it is empty, expected " + expected);
  }

 private:
  std::string_view name_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_{};
  std::size_t position_{};
  std::size_t begin_{};
};

std::int16_t table_entry(double value) {
  return static_cast<std::int16_t>(
      std::clamp(std::nearbyint(value * kTableScale), -32768.0, 32767.0));
}

std::optional<std::uint8_t> verdict_of(std::string_view name) {
  const auto found = std::find(kVerdictNames.begin(), kVerdictNames.end(), name);
  if (found == kVerdictNames.end()) return std::nullopt;
  return static_cast<std::uint8_t>(found - kVerdictNames.begin());
}

/// One line of a recording; the header's order of the columns is the only one.
Result<Recording::Row> read_row(Lines& lines) {
  Recording::Row row;
  const auto index = lines.number<std::uint64_t>();
  if (!index) return lines.wrong("the index of a datagram");
  row.index = *index;
  const auto sent = lines.number<std::int64_t>();
  if (!sent) return lines.wrong("sent_ns, a whole number");
  const std::string_view arrived_text = lines.field();
  std::int64_t arrived = 0;
  const char* const end = arrived_text.data() + arrived_text.size();
  const bool arrives = !arrived_text.empty();
  if (arrives && std::from_chars(arrived_text.data(), end, arrived).ptr != end) {
    return lines.wrong("arrived_ns, a whole number or nothing");
  }
  std::int64_t delay = 0;
  if (arrives && (__builtin_sub_overflow(arrived, *sent, &delay) || delay < 0)) {
    return lines.wrong("arrived_ns not before sent_ns");
  }
  row.delay = Duration{delay};
  const auto copy = lines.number<std::uint32_t>();
  constexpr std::uint32_t kCopyMax = 16;
  if (!copy || *copy > kCopyMax) return lines.wrong("a copy from 0 to 16");
  row.copy = *copy;
  const auto verdict = verdict_of(lines.field());
  if (!verdict) return lines.wrong("delivered, lost, header_hit, over_limit or blackout");
  row.verdict = *verdict;
  if (arrives != (*verdict == static_cast<std::uint8_t>(Verdict::Delivered))) {
    return lines.wrong("arrived_ns if and only if delivered");
  }
  const std::string_view bit = lines.field();
  if (!bit.empty()) {
    const auto read = std::from_chars(bit.data(), bit.data() + bit.size(), row.flipped_bit);
    if (read.ec != std::errc{} || read.ptr != bit.data() + bit.size() || row.flipped_bit < 0) {
      return lines.wrong("the number of a bit, or nothing");
    }
  }
  return row;
}

}  // namespace

Result<DelayTable> parse_delay_table(std::string_view name, std::string_view text) {
  DelayTable table{.name = std::string{name}, .entries = {}};
  Lines lines{name, text};
  while (lines.next()) {
    while (!lines.at_end()) {
      const auto value = lines.number<int>();
      if (!value || *value < -32768 || *value > 32767) {
        return lines.wrong("whole numbers from -32768 to 32767");
      }
      if (table.entries.size() == kTableEntriesMax) return lines.wrong("at most 16384 numbers");
      table.entries.push_back(static_cast<std::int16_t>(*value));
    }
  }
  if (table.entries.empty()) return lines.missing("whole numbers");
  return table;
}

Result<DelayHistogram> parse_delay_histogram(std::string_view name, std::string_view text) {
  DelayHistogram histogram{.name = std::string{name}, .bins = {}};
  Lines lines{name, text};
  double total = 0;
  while (lines.next()) {
    const auto lower = lines.number<double>();
    const double least = histogram.bins.empty() ? 0 : histogram.bins.back().lower_ms;
    const bool rises = lower && (histogram.bins.empty() ? *lower >= 0 : *lower > least);
    if (!rises || !(*lower <= 1e9)) return lines.wrong("rising lower edges of bins in ms, from 0");
    const auto count = lines.number<double>();
    if (!count || !(*count >= 0) || !(*count <= 1e15)) return lines.wrong("a count of 0 or above");
    if (!lines.at_end()) {
      (void)lines.field();
      return lines.wrong("two columns");
    }
    total += *count;
    histogram.bins.push_back({*lower, *count});
    if (histogram.bins.size() > kTracePointsMax) return lines.wrong("fewer lines");
  }
  if (histogram.bins.size() < 2 || !(total > 0)) {
    return lines.missing("two bins or more and something counted");
  }
  return histogram;
}

Result<DelayTrace> parse_delay_trace(std::string_view name, std::string_view text) {
  DelayTrace trace{.name = std::string{name}, .points = {}};
  Lines lines{name, text};
  if (!lines.next()) return lines.missing("the header t_ms,delay_ms");
  if (lines.line() != "t_ms,delay_ms") return lines.wrong("the header t_ms,delay_ms");
  constexpr double kMost = 1e9;  // [ms], as kTimeMax
  while (lines.next()) {
    const auto sent = lines.number<double>();
    if (!sent || !(*sent >= 0 && *sent <= kMost)) return lines.wrong("t_ms from 0 to 1e9");
    const Duration at{std::llround(*sent * 1e6)};
    if (!trace.points.empty() && at <= trace.points.back().sent) return lines.wrong("a later t_ms");
    const auto delay = lines.number<double>();
    if (!delay || !(*delay >= 0 && *delay <= kMost)) return lines.wrong("delay_ms from 0 to 1e9");
    const DelayTrace::Point point{at, Duration{std::llround(*delay * 1e6)}};
    if (!trace.points.empty() &&
        point.sent + point.delay < trace.points.back().sent + trace.points.back().delay) {
      return lines.wrong("an arrival that does not overtake the one before");
    }
    if (!lines.at_end()) {
      (void)lines.field();
      return lines.wrong("two columns");
    }
    trace.points.push_back(point);
    if (trace.points.size() > kTracePointsMax) return lines.wrong("at most 2000000 lines");
  }
  if (trace.points.size() < 2) return lines.missing("two lines or more");
  return trace;
}

Result<Recording> parse_recording(std::string_view name, std::string_view text) {
  constexpr std::string_view kHeader = "index,sent_ns,arrived_ns,copy,verdict,flipped_bit";
  Recording recording{.name = std::string{name}, .rows = {}};
  Lines lines{name, text};
  if (!lines.next()) return lines.missing("the header " + std::string{kHeader});
  if (!lines.line().starts_with(kHeader)) return lines.wrong("the header " + std::string{kHeader});
  while (lines.next()) {
    const auto row = read_row(lines);
    if (!row) return tl::unexpected<Error>(row.error());
    if (!recording.rows.empty()) {
      const Recording::Row& last = recording.rows.back();
      const bool next_copy = row->index == last.index && row->copy == last.copy + 1;
      const bool next_index = row->index > last.index && row->copy == 0;
      if (!next_copy && !next_index) return lines.wrong("rows by index, then copy from 0");
    } else if (row->copy != 0) {
      return lines.wrong("rows by index, then copy from 0");
    }
    recording.rows.push_back(*row);
    if (recording.rows.size() > kTracePointsMax) return lines.wrong("at most 2000000 lines");
  }
  if (recording.rows.empty()) return lines.missing("a line or more");
  return recording;
}

Result<LossBitmap> parse_loss_bitmap(std::string_view name, std::string_view text) {
  LossBitmap bitmap{.name = std::string{name}, .lost = {}};
  Lines lines{name, text};
  while (lines.next()) {
    while (!lines.at_end()) {
      for (const char c : lines.field()) {
        if (c != '0' && c != '1') return lines.wrong("0 or 1");
        bitmap.lost.push_back(c == '1');
      }
      if (bitmap.lost.size() > 64 * kTracePointsMax) return lines.wrong("less of it");
    }
  }
  if (bitmap.lost.empty()) return lines.missing("0 or 1");
  return bitmap;
}

DelayTable normal_table() {
  DelayTable table{.name = "normal", .entries = {}};
  for (std::size_t i = 0; i < kShippedEntries; ++i) {
    const double p = (static_cast<double>(i) + 0.125) / kShippedEntries;
    table.entries.push_back(table_entry(normal_quantile(p)));
  }
  table.entries.front() = -32768;  // as shipped
  return table;
}

DelayTable pareto_table() {
  DelayTable table{.name = "pareto", .entries = {}};
  for (int rank = 65536; rank > 0; rank -= 16) {
    const double u = rank / 65536.0;
    table.entries.push_back(table_entry(4.0 / 3.0 * (1 / std::cbrt(u) - 1.5)));
  }
  return table;
}

DelayTable paretonormal_table() {
  const DelayTable normal = normal_table();
  const DelayTable pareto = pareto_table();
  DelayTable table{.name = "paretonormal", .entries = {}};
  for (std::size_t i = 0; i < kShippedEntries; ++i) {
    table.entries.push_back(
        table_entry((0.25 * normal.entries[i] + 0.75 * pareto.entries[i]) / kTableScale));
  }
  return table;
}

}  // namespace palp::netem
