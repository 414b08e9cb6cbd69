#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace palp::config {

/// What a report says, until it is text: null, a truth, a number, text, a list, or members in the
/// order in which they were named. Written down like JSON: Json{{"sent", 3}, {"lost", nullptr}}.
/// Which library reads and writes the text, json.cc alone knows: its headers cost seconds in each
/// source. Allocates.
class Json {
 public:
  // NOLINTBEGIN(google-explicit-constructor): values are written down as they are
  Json(std::nullptr_t = nullptr) {}
  template <std::integral Whole>
  Json(Whole value) {
    if constexpr (std::is_same_v<Whole, bool>) {
      value_ = value;
    } else if constexpr (std::is_signed_v<Whole>) {
      value_ = std::int64_t{value};
    } else {
      value_ = std::uint64_t{value};
    }
  }
  Json(double value) : value_{value} {}  ///< null in the text where it is not finite
  Json(std::string text) : value_{std::move(text)} {}
  Json(std::string_view text) : value_{std::string{text}} {}
  Json(const char* text) : value_{std::string{text}} {}
  template <class Element>
  Json(const std::vector<Element>& list) : value_{Array(list.begin(), list.end())} {}
  /// An object where each part is a pair that begins with text, else a list.
  Json(std::initializer_list<Json> parts);
  // NOLINTEND(google-explicit-constructor)

  [[nodiscard]] static Json array();
  [[nodiscard]] static Json object();
  /// Null for what is no JSON.
  [[nodiscard]] static Json parse(std::string_view text);

  [[nodiscard]] bool is_null() const noexcept;
  [[nodiscard]] bool is_object() const noexcept;
  [[nodiscard]] bool is_unsigned() const noexcept;  ///< a whole number from 0
  /// What it is, or nothing.
  [[nodiscard]] std::optional<double> number() const noexcept;
  [[nodiscard]] std::optional<bool> truth() const noexcept;
  [[nodiscard]] std::optional<std::string_view> text() const noexcept;
  [[nodiscard]] std::span<const Json> parts() const noexcept;  ///< of a list; else none

  /// Of an object; null becomes one.
  [[nodiscard]] bool contains(std::string_view name) const noexcept;
  Json& operator[](std::string_view name);
  [[nodiscard]] const Json& operator[](std::string_view name) const;  ///< contains() it
  [[nodiscard]] const Json& at_or_null(std::string_view name) const noexcept;
  [[nodiscard]] std::span<const std::string> names() const noexcept;  ///< of an object; else none
  void update(const Json& other);                                     ///< takes all members over

  /// Of a list; null becomes one. What is missing before `index` is null.
  Json& operator[](std::size_t index);
  void push_back(Json part);

  /// Members and parts one a line, each level `indent` spaces further in; on one line without.
  /// Bytes that are no UTF-8 are replaced.
  [[nodiscard]] std::string dump(int indent = -1) const;

 private:
  friend struct JsonText;
  using Array = std::vector<Json>;
  struct Object {
    std::vector<std::string> names;
    std::vector<Json> values;
  };

  [[nodiscard]] const Json* find(std::string_view name) const noexcept;
  Object& as_object();

  std::
      variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object>
          value_;
};

}  // namespace palp::config
