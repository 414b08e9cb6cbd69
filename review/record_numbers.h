#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "common/link/telegram.h"
#include "common/record/recorder.h"

namespace palp::review {

/// A number of a record under the name that the schema gives it, unit included.
struct NamedNumber {
  std::string name;
  std::variant<double, std::int64_t, std::uint64_t> value;

  /// Equal to the bit: a NaN is itself, and -0 is not 0.
  [[nodiscard]] bool operator==(const NamedNumber& other) const;
  [[nodiscard]] double number() const;
  [[nodiscard]] std::string text() const;  ///< reads back as the same number
};
using NamedNumbers = std::vector<NamedNumber>;

/// All numbers of a record, in the order of its list of fields; instants as `at_ns`.
[[nodiscard]] NamedNumbers numbers_of(const Record& record, link::Role site);

/// The record's own instant.
[[nodiscard]] TimePoint instant_of(const Record& record);

}  // namespace palp::review
