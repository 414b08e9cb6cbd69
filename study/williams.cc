#include "study/williams.h"

#include <algorithm>

namespace palp::study {

std::vector<std::vector<std::size_t>> williams_square(std::size_t conditions) {
  // 0, 1, n-1, 2, n-2, ...
  std::vector<std::size_t> first{0};
  for (std::size_t i = 1; first.size() < conditions; ++i) {
    first.push_back(i);
    if (first.size() < conditions) first.push_back(conditions - i);
  }
  std::vector<std::vector<std::size_t>> rows;
  for (std::size_t shift = 0; shift < conditions; ++shift) {
    std::vector<std::size_t> row;
    for (const std::size_t one : first) row.push_back((one + shift) % conditions);
    rows.push_back(std::move(row));
  }
  if (conditions % 2 == 1 && conditions > 1) {
    for (std::size_t i = 0; i < conditions; ++i) {
      rows.emplace_back(rows[i].rbegin(), rows[i].rend());
    }
  }
  return rows;
}

}  // namespace palp::study
