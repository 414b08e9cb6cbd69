#pragma once

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

namespace palp {

/// A row of the fault table of docs/hardware.md, as it was measured: "| device | fault | state |
/// 15 ms | 1.5 mm |". Whole milliseconds, tenths of a millimetre.
inline std::string fault_row(const std::string& device,
                             const std::string& fault,
                             const std::string& state,
                             double after_ms,
                             const std::string& beyond) {
  return "| " + device + " | " + fault + " | " + state + " | " +
         std::to_string(std::lround(after_ms)) + " ms | " + beyond + " |";
}

/// "fault: emergency stop" as a table says it.
inline std::string in_words(std::string state) {
  const std::size_t at = state.find(": ");
  if (at + 2 == state.size()) return state.substr(0, at);
  return state.replace(at, 1, ",");
}

/// Whether the page has this very line: what is measured is what is promised.
inline bool is_documented(const std::string& row) {
  std::ifstream file{PALP_TREE "/docs/hardware.md"};
  const std::string page{std::istreambuf_iterator<char>{file}, {}};
  return page.find(row + "\n") != std::string::npos;
}

/// How many rows the page has of this device: what is promised is what is measured.
inline int documented_rows(const std::string& device) {
  std::ifstream file{PALP_TREE "/docs/hardware.md"};
  int rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("| " + device + " | ", 0) == 0) ++rows;
  }
  return rows;
}

}  // namespace palp
