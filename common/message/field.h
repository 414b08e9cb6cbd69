#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>

/// The words in which a struct says what its fields are. Behind each struct that crosses the wire
/// or goes to the log stands one list:
///
///   template <std::same_as<SiteReport> S>
///   inline constexpr auto fields<S> =
///       list({.wire = "Site"},
///            field<1, &S::state>("state"),
///            field<2, &S::epoch>("epoch"),
///            field<3, &S::place, &Place::x>("x_m", wire<float>, limit(kLengthMax)));
///
/// Bytes, range checks, digests, schemas, tests and text are made from the lists; the authority is
/// proto/, which a test holds every list against. A time point or span is told as whole
/// nanoseconds. A member that is in no list turns a test red. Lists are templates so that they cost
/// nothing where only the structs are used.
namespace palp::message {

/// Where a struct's bytes go: numbers may be narrower on the wire, and fields numbered otherwise.
enum class Form : std::uint8_t { Wire, Log };

/// The names of a struct's message in proto/; empty where there is none.
struct Names {
  std::string_view wire{};         ///< in link.proto
  std::string_view log{};          ///< in session_log.proto
  std::string_view log_patient{};  ///< there, where the patient's has another name
  std::string_view shared{};       ///< in shared.proto: the same bytes on the wire and in the log
  bool one_site{};                 ///< only the site whose name stands in `log...` has it
};

/// The name of a field, of which the unit may differ between the sites.
struct FieldName {
  std::string_view surgeon;
  std::string_view patient;
  // NOLINTNEXTLINE(google-explicit-constructor): most names are the same at both sites
  constexpr FieldName(const char* both) noexcept : surgeon{both}, patient{both} {}
  constexpr FieldName(const char* at_surgeon, const char* at_patient) noexcept
      : surgeon{at_surgeon}, patient{at_patient} {}
};

/// A member, or a member or element of one: At<&S::c, 0>.
template <auto kStep, auto... kRest>
struct At {
  static constexpr auto& of(auto& object) noexcept {
    if constexpr (sizeof...(kRest) > 0) {
      return At<kRest...>::of(At<kStep>::of(object));
    } else if constexpr (std::is_member_object_pointer_v<decltype(kStep)>) {
      return object.*kStep;
    } else {
      return object[kStep];
    }
  }
};

// What a field may say of itself behind its name.

/// On the wire it is a number of this type; in the log it is as wide as ours.
template <class Number>
struct OnWire {
  using Narrow = Number;
};
template <class Number>
inline constexpr OnWire<Number> wire{};

/// It is a number of this type on the wire and in the log.
template <class Number>
struct Everywhere {
  using Narrow = Number;
  static constexpr bool kInLog = true;
};
template <class Number>
inline constexpr Everywhere<Number> narrow{};

/// A whole number in as many bytes as it has, always.
struct FixedWidth {};
inline constexpr FixedWidth fixed_width{};

/// In the log it has another number than on the wire.
template <unsigned kOther>
struct LogNumber {
  static constexpr unsigned kLogNumber = kOther;
};
template <unsigned kOther>
inline constexpr LogNumber<kOther> log_number{};

/// On the wire its amount is at most this; NaN never is.
template <class Number>
struct Limit {
  Number most;
};
template <class Number>
constexpr Limit<Number> limit(Number most) noexcept {
  return {most};
}

/// Text of at most so many bytes.
template <std::size_t kMost>
struct TextLimit {
  static constexpr std::size_t kTextMax = kMost;
};
template <std::size_t kMost>
inline constexpr TextLimit<kMost> text_limit{};

/// Written also when it is 0, so that its absence says something.
struct Always {};
inline constexpr Always always{};

/// A value that stands for none, and is never written.
template <class Number>
struct NoneIs {
  Number none;
};
template <class Number>
constexpr NoneIs<Number> none_is(Number none) noexcept {
  return {none};
}

/// There while the count is above `kIndex`; beyond it nobody looks.
template <auto kCount, unsigned kIndex>
struct Counted {
  static constexpr bool exists(const auto& object) noexcept { return object.*kCount > kIndex; }
};
template <auto kCount, unsigned kIndex>
inline constexpr Counted<kCount, kIndex> counted{};

/// A message that says nothing where this number of its own is 0.
template <auto kNumber>
struct NothingIfZero {
  static constexpr bool says_nothing(const auto& part) noexcept { return part.*kNumber == 0; }
};
template <auto kNumber>
inline constexpr NothingIfZero<kNumber> nothing_if_zero{};

/// A payload that later datagrams repeat: it is short, and without it the sample is of no use.
struct RepeatedLater {};
inline constexpr RepeatedLater repeated_later{};

/// A running count of a link, for people and pages; the other: of what was refused.
struct Counts {};
inline constexpr Counts counts{};
struct CountsRefusals {};
inline constexpr CountsRefusals counts_refusals{};

// What a list is made of.

template <unsigned kItsNumber, class Where, class... Options>
struct Field : Where, Options... {
  static constexpr unsigned kNumber = kItsNumber;
  FieldName name;
};
template <unsigned kNumber, auto... kPath, class... Options>
constexpr auto field(FieldName name, Options... options) noexcept {
  return Field<kNumber, At<kPath...>, Options...>{{}, options..., name};
}

/// A member that is in no bytes: it stays here, or travels otherwise.
template <class Where>
struct Aside : Where {
  FieldName name;
};
template <auto... kPath>
constexpr auto aside(FieldName name) noexcept {
  return Aside<At<kPath...>>{{}, name};
}

/// The fields of a struct within, as if they were of the struct around it: numbers by `kBase`
/// higher, names behind a prefix. Of an optional one the first field is `always`, and tells that it
/// is there.
template <unsigned kItsBase, class Where>
struct Spread : Where {
  static constexpr unsigned kBase = kItsBase;
  std::string_view prefix;
};
template <unsigned kBase, auto... kPath>
constexpr auto spread(std::string_view prefix) noexcept {
  return Spread<kBase, At<kPath...>>{{}, prefix};
}

template <unsigned kItsNumber, class Chosen, class... Options>
struct Choice : Options... {
  using Type = Chosen;
  static constexpr unsigned kNumber = kItsNumber;
  std::string_view name;
};
template <unsigned kNumber, class Chosen, class... Options>
constexpr auto choice(std::string_view name, Options... options) noexcept {
  return Choice<kNumber, Chosen, Options...>{options..., name};
}

/// A variant: nothing, or one of the choices, which are in its order.
template <class Where, class... Choices>
struct OneOf : Where {
  std::string_view name;
  std::tuple<Choices...> choices;
};
template <auto kMember, class... Choices>
constexpr auto one_of(std::string_view name, Choices... choices) noexcept {
  return OneOf<At<kMember>, Choices...>{{}, name, {choices...}};
}

template <class... Items>
struct List {
  Names names;
  std::tuple<Items...> items;
};
template <class... Items>
constexpr auto list(Names names, Items... items) noexcept {
  return List<Items...>{names, {items...}};
}

/// The list of a struct. Fields stand in the order of their numbers: so they are written.
struct NoList {};
template <class Struct>
inline constexpr NoList fields{};
template <class Struct>
concept Described = !std::is_same_v<decltype(fields<Struct>), const NoList>;

/// The enumerators of an enum as proto/ names them: 0, 1, ...
template <std::size_t kCount>
struct Enumeration {
  std::string_view name;
  std::string_view within;  ///< the message of the log in which it stands; empty: shared.proto
  std::array<std::string_view, kCount> values;
};
template <class... Values>
constexpr auto enumeration(std::string_view name,
                           std::string_view within,
                           Values... values) noexcept {
  return Enumeration<sizeof...(Values)>{name, within, {values...}};
}
template <class Enum>
inline constexpr NoList enumerators{};

/// Calls `visit` with each item of a list, or each choice of a oneof.
template <class... Items>
constexpr void each(const std::tuple<Items...>& items, auto&& visit) {
  std::apply([&](const auto&... item) { (visit(item), ...); }, items);
}
/// The same until one call says false.
template <class... Items>
constexpr bool all(const std::tuple<Items...>& items, auto&& visit) {
  return std::apply([&](const auto&... item) { return (visit(item) && ...); }, items);
}

}  // namespace palp::message
