#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "common/core/time.h"

/// Measured data that an impairment may follow, as values, and the texts they are read from.
/// Every refusal names the line. Nothing here opens a file: that is data_files.h.
namespace palp::netem {

/// A distribution table of tc: entries scaled by 8192, of mean about 0 and spread about 1.
struct DelayTable {
  std::string name;
  std::vector<std::int16_t> entries;
  bool operator==(const DelayTable&) const = default;
};

/// Delays counted in bins; uniform within a bin.
struct DelayHistogram {
  struct Bin {
    double lower_ms{};
    double count{};  ///< [1], of any scale
    bool operator==(const Bin&) const = default;
  };
  std::string name;
  std::vector<Bin> bins;  ///< rising; the last is as wide as the one before
  bool operator==(const DelayHistogram&) const = default;
};

/// One-way delay by the time of sending, as somebody measured it.
struct DelayTrace {
  struct Point {
    Duration sent{};  ///< since the start of the trace
    Duration delay{};
    bool operator==(const Point&) const = default;
  };
  std::string name;
  std::vector<Point> points;  ///< arrivals (sent + delay) never go back
  bool loop{};                ///< begin again at the end; otherwise the last delay stays
  bool dither{};              ///< spread each delay by +-0.5 ms, as the trace has whole ones
  bool operator==(const DelayTrace&) const = default;
};

/// What happened to each datagram of an earlier run, by its number.
struct Recording {
  struct Row {
    std::uint64_t index{};
    std::uint32_t copy{};
    std::uint8_t verdict{};        ///< a Verdict
    std::int32_t flipped_bit{-1};  ///< from 0 at the first byte of the frame; -1: none
    Duration delay{};
    bool operator==(const Row&) const = default;
  };
  std::string name;
  std::vector<Row> rows;  ///< by index, then copy
  bool operator==(const Recording&) const = default;
};

/// Which datagrams are lost: one 0 or 1 each, repeated from the beginning at the end.
struct LossBitmap {
  std::string name;
  std::vector<bool> lost;
  bool operator==(const LossBitmap&) const = default;
};

inline constexpr std::size_t kTableEntriesMax = 16384;  ///< as in tc
inline constexpr std::size_t kTracePointsMax = 2'000'000;

/// Whitespace-separated whole numbers from -32768 to 32767; `#` begins a comment.
[[nodiscard]] Result<DelayTable> parse_delay_table(std::string_view name, std::string_view text);

/// Lines `LOWER_MS COUNT` (or with a comma), without header; the first edge at 0 or above.
[[nodiscard]] Result<DelayHistogram> parse_delay_histogram(std::string_view name,
                                                           std::string_view text);

/// CSV with the header t_ms,delay_ms; `#` begins a comment line.
[[nodiscard]] Result<DelayTrace> parse_delay_trace(std::string_view name, std::string_view text);

/// CSV with the header index,sent_ns,arrived_ns,copy,verdict,flipped_bit (more columns ignored).
[[nodiscard]] Result<Recording> parse_recording(std::string_view name, std::string_view text);

/// Characters 0 and 1; white space and `#` comments are skipped.
[[nodiscard]] Result<LossBitmap> parse_loss_bitmap(std::string_view name, std::string_view text);

/// The shipped tables of tc, made by their formulas: normal, pareto, paretonormal.
/// Normal: the quantiles at (i + 1/8)/4096. Pareto: (4/3) (u^(-1/3) - 1.5). Pareto-normal: a
/// quarter of the one and three of the other on equal ranks.
[[nodiscard]] DelayTable normal_table();
[[nodiscard]] DelayTable pareto_table();
[[nodiscard]] DelayTable paretonormal_table();

}  // namespace palp::netem
