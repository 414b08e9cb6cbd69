#include "review/record_numbers.h"

#include <bit>
#include <concepts>
#include <type_traits>

#include "common/config/number.h"
#include "common/message/each_value.h"

namespace palp::review {
namespace {

template <class Item>
std::string name_of(std::string_view prefix, const Item& item, link::Role site) {
  const std::string name{site == link::Role::Patient ? item.name.patient : item.name.surgeon};
  const bool apart = prefix.empty() || prefix.ends_with('_');
  return std::string{prefix} + (apart ? "" : "_") + name;
}

template <class Number>
NamedNumber named(std::string name, Number number) {
  if constexpr (std::floating_point<Number>) {
    return {std::move(name), static_cast<double>(number)};
  } else if constexpr (std::signed_integral<Number>) {
    return {std::move(name), static_cast<std::int64_t>(number)};
  } else {
    return {std::move(name), static_cast<std::uint64_t>(number)};
  }
}

}  // namespace

bool NamedNumber::operator==(const NamedNumber& other) const {
  if (name != other.name || value.index() != other.value.index()) return false;
  if (const auto* real = std::get_if<double>(&value)) {
    return std::bit_cast<std::uint64_t>(*real) ==
           std::bit_cast<std::uint64_t>(*std::get_if<double>(&other.value));
  }
  return value == other.value;
}

double NamedNumber::number() const {
  return std::visit([](auto number) { return static_cast<double>(number); }, value);
}

std::string NamedNumber::text() const {
  if (const auto* real = std::get_if<double>(&value)) return config::number_text(*real);
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  return std::to_string(*std::get_if<std::uint64_t>(&value));
}

NamedNumbers numbers_of(const Record& record, link::Role site) {
  NamedNumbers numbers;
  const auto add = [&](std::string_view prefix, const auto& item, auto number) {
    numbers.push_back(named(name_of(prefix, item, site), number));
  };
  std::visit([&](const auto& one) { message::each_value(one, add); }, record);
  return numbers;
}

TimePoint instant_of(const Record& record) {
  if (const auto* estimate = std::get_if<DepthEstimate>(&record)) return estimate->stroke_ended_at;
  TimePoint at{};
  std::visit(
      [&](const auto& one) {
        if constexpr (requires { one.at; }) at = one.at;
      },
      record);
  return at;
}

}  // namespace palp::review
