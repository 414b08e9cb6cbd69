#include "judge/tissue_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

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

}  // namespace

Result<TissueTable> TissueTable::parse(std::string_view csv) {
  TissueTable table;
  int line_number = 0;
  bool header_seen = false;
  while (!csv.empty()) {
    std::string_view line = cut(csv, '\n');
    ++line_number;
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const auto site = cut(line, ',');
    const auto indentation_text = cut(line, ',');
    const auto force_text = cut(line, ',');
    if (!header_seen) {
      if (site != "site" || indentation_text != "d_mm" || force_text != "F_N") {
        return fail("the tissue table's columns are not site,d_mm,F_N");
      }
      header_seen = true;
      continue;
    }
    const auto indentation = number(indentation_text);
    const auto force = number(force_text);
    if ((site != "A" && site != "B") || !indentation || !force) {
      return fail("line " + std::to_string(line_number) +
                  " of the tissue table is not A or B and two numbers");
    }
    auto& rows = table.rows_[site == "A" ? 0 : 1];
    const double metres = *indentation * 1e-3;
    if (!rows.empty() && metres <= rows.back().indentation) {
      return fail("d_mm in line " + std::to_string(line_number) +
                  " of the tissue table does not rise");
    }
    rows.push_back({.indentation = metres, .force = *force});
  }
  return table;
}

std::optional<double> TissueTable::force(Site site, double indentation) const {
  const auto& rows = rows_[static_cast<std::size_t>(site)];
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
