#include "patient_site/force_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "common/core/byte_order_mark.h"
#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/formatted.h"
#include "common/core/whole_file.h"

namespace palp::patient {
namespace {

constexpr std::size_t kRowsMin = 4;
constexpr std::size_t kRowsMax = 20'000;
constexpr double kIndentationMax = 0.1;  // [m]; beyond it a table is not one of an indenter
constexpr double kForceMax = 1000;       // [N]; likewise
constexpr double kIntervalMin = 1e-7;    // [m]; closer rows make slopes of rounding errors

std::string number_text(double value) { return formatted("%.9g", value); }

std::string row_error(std::size_t index, const std::string& what) {
  return "row " + std::to_string(index + 1) + ": " + what;
}

/// Empty, or what is wrong with row `index`.
std::string check_row(std::span<const ForceRow> rows, std::size_t index) {
  const ForceRow& row = rows[index];
  if (!std::isfinite(row.indentation)) return "d_mm is not finite";
  if (!std::isfinite(row.force)) return "F_N is not finite";
  const std::string indentation_mm = number_text(row.indentation / kMillimetre);
  if (row.indentation < 0) return "d_mm = " + indentation_mm + " is negative";
  if (row.indentation > kIndentationMax) {
    return "d_mm = " + indentation_mm + " exceeds " + number_text(kIndentationMax / kMillimetre);
  }
  if (row.force < 0) return "F_N = " + number_text(row.force) + " is negative";
  if (row.force > kForceMax) {
    return "F_N = " + number_text(row.force) + " exceeds " + number_text(kForceMax);
  }
  if (index == 0 && row.indentation > 0 && row.indentation < kIntervalMin) {
    return "d_mm = " + indentation_mm + " is neither 0 nor at least " +
           number_text(kIntervalMin / kMillimetre);
  }
  if (index > 0 && row.indentation < rows[index - 1].indentation + kIntervalMin) {
    return "d_mm = " + indentation_mm + " does not rise above the row before (" +
           number_text(rows[index - 1].indentation / kMillimetre) + "): d_mm must be monotone";
  }
  return {};
}

/// The same of a file: what is computed may fall by a rounding error.
std::string check_force_rises(std::span<const ForceRow> rows, std::size_t index) {
  if (index == 0 || rows[index].force >= rows[index - 1].force) return {};
  return "F_N = " + number_text(rows[index].force) + " falls below the row before (" +
         number_text(rows[index - 1].force) + "): tissue that is pressed deeper pushes no less";
}

std::string too_few(std::size_t count) {
  return "there are " + std::to_string(count) + " rows; a table needs at least " +
         std::to_string(kRowsMin);
}

/// The one-sided three-point slope at an end, limited so that the end interval stays monotone.
double end_slope(double h0, double h1, double secant0, double secant1) noexcept {
  const double slope = ((2 * h0 + h1) * secant0 - h0 * secant1) / (h0 + h1);
  if (slope * secant0 <= 0) return 0;
  if (secant0 * secant1 < 0 && std::abs(slope) > 3 * std::abs(secant0)) return 3 * secant0;
  return slope;
}

/// The slope at d = 0 with which the first interval encloses the same area as the power law through
/// the first two rows: the contact of a round tip begins like d^1.5 (Hertz), which no polynomial
/// through rows this far apart would guess; a straight table stays straight.
double contact_slope(const ForceRow& first, const ForceRow& second, double slope_first) noexcept {
  if (!(first.force > 0) || !(second.force > first.force)) return 0;
  const double exponent =
      std::log(second.force / first.force) / std::log(second.indentation / first.indentation);
  const double secant = first.force / first.indentation;
  return std::clamp(slope_first + 12 * secant * (1 / (exponent + 1) - 0.5), 0.0, 3 * secant);
}

/// Slopes at the rows: weighted harmonic means of the neighbouring secants (Fritsch, Butland 1984).
std::vector<double> monotone_slopes(std::span<const ForceRow> rows) {
  const std::size_t last = rows.size() - 1;
  std::vector<double> widths(last);
  std::vector<double> secants(last);
  for (std::size_t i = 0; i < last; ++i) {
    widths[i] = rows[i + 1].indentation - rows[i].indentation;
    secants[i] = (rows[i + 1].force - rows[i].force) / widths[i];
  }
  std::vector<double> slopes(rows.size(), 0.0);
  slopes.front() = end_slope(widths[0], widths[1], secants[0], secants[1]);
  slopes.back() =
      end_slope(widths[last - 1], widths[last - 2], secants[last - 1], secants[last - 2]);
  for (std::size_t i = 1; i < last; ++i) {
    if (secants[i - 1] * secants[i] <= 0) continue;
    const double before = 2 * widths[i] + widths[i - 1];
    const double after = widths[i] + 2 * widths[i - 1];
    slopes[i] = (before + after) / (before / secants[i - 1] + after / secants[i]);
  }
  if (rows[0].force == 0) slopes[0] = contact_slope(rows[1], rows[2], slopes[1]);
  return slopes;
}

/// Walks over the lines of a text and the fields of a line.
std::string_view take_until(std::string_view& rest, char separator) noexcept {
  const std::size_t end = rest.find(separator);
  const std::string_view taken = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return taken;
}

std::string_view trimmed(std::string_view text) noexcept {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// What stands in a message: printable and short, whatever was in the file.
std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char letter : text.substr(0, 40)) {
    out += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return out + (text.size() > 40 ? "...'" : "'");
}

/// Cells of a line; empty ones at its end, as spreadsheets write them, are none.
std::size_t cells_in(std::string_view line) noexcept {
  const std::size_t last = line.find_last_not_of(", \t\r");
  if (last == std::string_view::npos) return 0;
  return 1 + static_cast<std::size_t>(std::ranges::count(line.substr(0, last), ','));
}

struct Columns {
  std::size_t count{};
  std::size_t indentation{};
  std::size_t force{};
  std::optional<std::size_t> x;
  std::optional<std::size_t> y;
  [[nodiscard]] bool placed() const noexcept { return x || y; }
};

Result<Columns> find_columns(std::string_view header) {
  std::optional<std::size_t> indentation;
  std::optional<std::size_t> force;
  Columns found;
  found.count = cells_in(header);
  for (std::size_t column = 0; !header.empty(); ++column) {
    const std::string_view field = trimmed(take_until(header, ','));
    if (field == "d_mm" && !indentation) indentation = column;
    if (field == "F_N" && !force) force = column;
    if (field == "x_mm" && !found.x) found.x = column;
    if (field == "y_mm" && !found.y) found.y = column;
  }
  if (!indentation) return fail("the header has no column d_mm");
  if (!force) return fail("the header has no column F_N");
  found.indentation = *indentation;
  found.force = *force;
  return found;
}

/// One field as a number; the whole field must be one.
Result<double> parse_number(std::string_view line, std::size_t column, std::string_view name) {
  const std::string where =
      "column " + std::to_string(column + 1) + " (" + std::string{name} + "): ";
  for (std::size_t i = 0; i < column && !line.empty(); ++i) take_until(line, ',');
  const std::string_view field = trimmed(take_until(line, ','));
  if (field.empty()) return fail(where + "the value is missing");
  const char* begin = field.data() + (field.size() > 1 && field.front() == '+' ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(begin, field.data() + field.size(), value);
  if (error == std::errc::result_out_of_range)
    return fail(where + quoted(field) + " is out of range");
  if (error != std::errc{} || end != field.data() + field.size()) {
    return fail(where + quoted(field) + " is not a number");
  }
  if (!std::isfinite(value)) return fail(where + quoted(field) + " is not finite");
  return value;
}

Result<ForceRow> parse_row(std::string_view line, const Columns& columns) {
  if (const std::size_t cells = cells_in(line); cells > columns.count) {
    return fail("there are " + std::to_string(cells) + " cells, the header has " +
                std::to_string(columns.count) + "; numbers are written with a point: 0.5");
  }
  const Result<double> indentation_mm = parse_number(line, columns.indentation, "d_mm");
  if (!indentation_mm) return tl::unexpected(indentation_mm.error());
  const Result<double> force = parse_number(line, columns.force, "F_N");
  if (!force) return tl::unexpected(force.error());
  return ForceRow{.indentation = *indentation_mm * kMillimetre, .force = *force};
}

Result<double> parse_coordinate(std::string_view line,
                                const std::optional<std::size_t>& column,
                                std::string_view name) {
  if (!column) return 0.0;
  const Result<double> value_mm = parse_number(line, *column, name);
  if (!value_mm) return tl::unexpected(value_mm.error());
  if (std::abs(*value_mm) > kPlaceMax / kMillimetre) {
    return fail(std::string{name} + " = " + number_text(*value_mm) + " lies beyond " +
                number_text(kPlaceMax / kMillimetre));
  }
  return *value_mm * kMillimetre;
}

Result<Place> parse_place(std::string_view line, const Columns& columns) {
  const Result<double> x = parse_coordinate(line, columns.x, "x_mm");
  if (!x) return tl::unexpected(x.error());
  const Result<double> y = parse_coordinate(line, columns.y, "y_mm");
  if (!y) return tl::unexpected(y.error());
  return Place{*x, *y};
}

std::string place_text(const Place& place) {
  return number_text(place.x / kMillimetre) + "," + number_text(place.y / kMillimetre);
}

/// Rows of one place after the other, as they are read.
struct PlacedRows {
  Place place;
  std::vector<ForceRow> rows;
};

/// Empty, or what is wrong with a row at `place` that comes next. A new place begins new rows.
std::string take_place(std::vector<PlacedRows>& all, const Place& place) {
  if (!all.empty() && all.back().place == place) return {};
  for (const PlacedRows& other : all) {
    if (distance(other.place, place) < kPlacesApart) {
      return "place " + place_text(place) + " mm comes again, or lies within " +
             number_text(kPlacesApart / kMillimetre) + " mm of " + place_text(other.place);
    }
  }
  if (all.size() == kPlacesMax) return "more than " + std::to_string(kPlacesMax) + " places";
  all.push_back({place, {}});
  return {};
}

/// All rows of a text; `placed` false: columns of places are as good as any others.
Result<std::vector<PlacedRows>> parse_rows(std::string_view text,
                                           const std::string& prefix,
                                           const Place& otherwise,
                                           bool placed) {
  if (text.size() > kTextSizeMax) {
    return fail(prefix + "the table has " + std::to_string(text.size()) + " bytes, more than " +
                std::to_string(kTextSizeMax));
  }
  text = without_byte_order_mark(text);
  std::optional<Columns> columns;
  std::vector<PlacedRows> all;
  std::size_t count = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string where = prefix + "line " + std::to_string(number) + ": ";
    const std::string_view line = trimmed(take_until(text, '\n'));
    if (line.empty() || line.front() == '#') continue;
    if (!columns) {
      const Result<Columns> found = find_columns(line);
      if (!found) return fail(where + found.error().text);
      columns = *found;
      continue;
    }
    Result<Place> place = otherwise;
    if (placed && columns->placed()) place = parse_place(line, *columns);
    if (!place) return fail(where + place.error().text);
    if (const std::string wrong = take_place(all, *place); !wrong.empty()) {
      return fail(where + wrong);
    }
    const Result<ForceRow> row = parse_row(line, *columns);
    if (!row) return fail(where + row.error().text);
    std::vector<ForceRow>& rows = all.back().rows;
    rows.push_back(*row);
    std::string wrong = check_row(rows, rows.size() - 1);
    if (wrong.empty()) wrong = check_force_rises(rows, rows.size() - 1);
    if (!wrong.empty()) return fail(where + wrong);
    if (++count > kRowsMax) return fail(where + "more than " + std::to_string(kRowsMax) + " rows");
  }
  if (!columns) return fail(prefix + "there is no header line with the columns d_mm and F_N");
  if (all.empty()) all.push_back({otherwise, {}});
  return all;
}

/// `of`: which of several, for the sentence.
Result<ForceTable> make_table(std::vector<ForceRow> rows, const std::string& of) {
  if (rows.size() < kRowsMin) return fail(of + too_few(rows.size()));
  return ForceTable::make(std::move(rows)).map_error([&](const Error& error) {
    return Error{of + error.text};
  });
}

}  // namespace

Result<ForceTable> ForceTable::make(std::vector<ForceRow> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string wrong = check_row(rows, i);
    if (!wrong.empty()) return fail(row_error(i, wrong));
  }
  if (rows.size() < kRowsMin) return fail(too_few(rows.size()));
  if (rows.front().indentation > 0) rows.insert(rows.begin(), ForceRow{});
  return ForceTable{std::move(rows)};
}

ForceTable::ForceTable(std::vector<ForceRow> rows)
    : rows_{std::move(rows)}, slopes_{monotone_slopes(rows_)} {
  PALP_CHECK(rows_.size() >= kRowsMin, "a force table has at least 4 rows");
  const std::size_t cells = 2 * rows_.size();
  cells_per_metre_ = static_cast<double>(cells) / depth_max();
  starts_.resize(cells);
  for (std::size_t cell = 0, row = 0; cell < cells; ++cell) {
    const double edge = static_cast<double>(cell) / cells_per_metre_;
    while (row + 2 < rows_.size() && rows_[row + 1].indentation <= edge) ++row;
    starts_[cell] = static_cast<std::uint32_t>(row);
  }
}

std::size_t ForceTable::interval(double indentation) const noexcept {
  const auto cell = static_cast<std::size_t>(indentation * cells_per_metre_);
  std::size_t row = starts_[std::min(cell, starts_.size() - 1)];
  while (row + 2 < rows_.size() && rows_[row + 1].indentation < indentation) ++row;
  return row;
}

double ForceTable::force(double indentation) const noexcept {
  if (!(indentation >= 0)) return 0;
  if (indentation >= depth_max()) return rows_.back().force;
  const std::size_t i = interval(indentation);
  const double width = rows_[i + 1].indentation - rows_[i].indentation;
  const double t = (indentation - rows_[i].indentation) / width;
  const double u = 1 - t;
  // Cubic Hermite form.
  return rows_[i].force * (1 + 2 * t) * u * u + rows_[i + 1].force * t * t * (3 - 2 * t) +
         width * t * u * (slopes_[i] * u - slopes_[i + 1] * t);
}

double ForceTable::derivative(double indentation) const noexcept {
  if (!(indentation >= 0) || indentation > depth_max()) return 0;
  const std::size_t i = interval(indentation);
  const double width = rows_[i + 1].indentation - rows_[i].indentation;
  const double t = (indentation - rows_[i].indentation) / width;
  const double u = 1 - t;
  return 6 * t * u * (rows_[i + 1].force - rows_[i].force) / width + slopes_[i] * u * (u - 2 * t) +
         slopes_[i + 1] * t * (t - 2 * u);
}

Result<ForceTable> parse_force_table(std::string_view text, std::string_view name) {
  const std::string prefix = std::string{name} + ": ";
  Result<std::vector<PlacedRows>> read = parse_rows(text, prefix, {}, false);
  if (!read) return tl::unexpected(read.error());
  return make_table(std::move(read->front().rows), prefix);
}

Result<std::vector<PlacedCurve>> parse_tissue_curves(std::string_view text,
                                                     std::string_view name,
                                                     const Place& otherwise) {
  const std::string prefix = std::string{name} + ": ";
  Result<std::vector<PlacedRows>> read = parse_rows(text, prefix, otherwise, true);
  if (!read) return tl::unexpected(read.error());
  std::vector<PlacedCurve> curves;
  for (PlacedRows& one : *read) {
    const std::string of =
        read->size() > 1 ? prefix + "place " + place_text(one.place) + " mm: " : prefix;
    Result<ForceTable> table = make_table(std::move(one.rows), of);
    if (!table) return tl::unexpected(table.error());
    curves.push_back({one.place, std::move(*table)});
  }
  return curves;
}

Result<std::vector<PlacedCurve>> load_tissue_curves(const std::string& path,
                                                    const Place& otherwise) {
  const Result<std::string> text = read_whole_file(path, kTextSizeMax);
  if (!text) return tl::unexpected<Error>(text.error());
  return parse_tissue_curves(*text, path, otherwise);
}

}  // namespace palp::patient
