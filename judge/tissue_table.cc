#include "judge/tissue_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "common/core/byte_order_mark.h"

namespace palp::judge {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\"");
  const auto end = text.find_last_not_of(" \t\r\"");
  return begin == std::string_view::npos ? "" : text.substr(begin, end - begin + 1);
}

/// The text up to the separator, which is cut from `rest` with it.
std::string_view cut(std::string_view& rest, char separator) {
  const auto end = std::min(rest.find(separator), rest.size());
  const std::string_view piece = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return trimmed(piece);
}

std::optional<double> number(std::string_view text) {
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional{value} : std::nullopt;
}

std::optional<Place> named_place(std::string_view site) {
  if (site == "A") return kSiteA;
  if (site == "B") return kSiteB;
  return std::nullopt;
}

/// Where a row lies: by two columns, or by one with a name.
std::optional<Place> take_place(std::string_view& line, bool named) {
  const auto first = cut(line, ',');
  if (named) return named_place(first);
  const auto x = number(first);
  const auto y = number(cut(line, ','));
  if (!x || !y) return std::nullopt;
  return Place{*x * 1e-3, *y * 1e-3};
}

}  // namespace

Result<TissueTable> TissueTable::parse(std::string_view csv) {
  TissueTable table;
  int line_number = 0;
  bool named = false;
  bool header_seen = false;
  std::ptrdiff_t commas = 0;
  csv = without_byte_order_mark(csv);
  while (!csv.empty()) {
    std::string_view line = cut(csv, '\n');
    ++line_number;
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const std::ptrdiff_t commas_here = std::ranges::count(line, ',');
    if (!header_seen) {
      commas = commas_here;
      const auto first = cut(line, ',');
      named = first == "site";
      const bool placed = first == "x_mm" && cut(line, ',') == "y_mm";
      if (!(named || placed) || cut(line, ',') != "d_mm" || cut(line, ',') != "F_N") {
        return fail("the tissue table's columns are not x_mm,y_mm,d_mm,F_N");
      }
      header_seen = true;
      continue;
    }
    const auto place = take_place(line, named);
    const auto indentation = number(cut(line, ','));
    const auto force = number(cut(line, ','));
    if (!place || !indentation || !force || commas_here > commas) {
      return fail("line " + std::to_string(line_number) + " of the tissue table is not " +
                  (named ? "A or B and two numbers" : "four numbers"));
    }
    auto curve = std::find_if(table.curves_.begin(), table.curves_.end(), [&](const Curve& one) {
      return one.place == *place;
    });
    if (curve == table.curves_.end()) {
      curve = table.curves_.insert(curve, {*place, {}});
    }
    const double metres = *indentation * 1e-3;
    if (!curve->rows.empty() && metres <= curve->rows.back().indentation) {
      return fail("d_mm in line " + std::to_string(line_number) +
                  " of the tissue table does not rise");
    }
    curve->rows.push_back({.indentation = metres, .force = *force});
  }
  return table;
}

void TissueTable::add(const Place& place, std::vector<Row> rows) {
  const bool known = std::any_of(curves_.begin(), curves_.end(), [&](const Curve& one) {
    return distance(one.place, place) <= kSamePlace;
  });
  if (!known) curves_.push_back({place, std::move(rows)});
}

std::optional<double> TissueTable::force(const Place& place, double indentation) const {
  const auto curve =
      std::min_element(curves_.begin(), curves_.end(), [&](const Curve& a, const Curve& b) {
        return distance(a.place, place) < distance(b.place, place);
      });
  if (curve == curves_.end() || distance(curve->place, place) > kSamePlace) {
    return std::nullopt;
  }
  const std::vector<Row>& rows = curve->rows;
  const auto above =
      std::lower_bound(rows.begin(), rows.end(), indentation, [](const Row& row, double value) {
        return row.indentation < value;
      });
  if (above == rows.end()) {
    return std::nullopt;
  }
  if (above == rows.begin()) {
    return above->indentation == indentation ? std::optional{above->force} : std::nullopt;
  }
  const Row& below = *std::prev(above);
  const double share = (indentation - below.indentation) / (above->indentation - below.indentation);
  return below.force + share * (above->force - below.force);
}

}  // namespace palp::judge
