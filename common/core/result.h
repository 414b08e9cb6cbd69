#pragma once

#include <string>

#include <tl/expected.hpp>

namespace palp {

/// Bad input in one clear sentence: what, the value, the limit.
struct Error {
  std::string text;
  bool unreachable{};  ///< nothing was read: a file that cannot be opened, a host nobody knows
};

/// A value, or the sentence that says why there is none.
template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(std::string text) {
  return tl::unexpected<Error>(Error{std::move(text)});
}

[[nodiscard]] inline tl::unexpected<Error> fail_to_reach(std::string text) {
  return tl::unexpected<Error>(Error{std::move(text), true});
}

/// The same fault, seen from further out: `where` comes before the sentence.
[[nodiscard]] inline tl::unexpected<Error> fail(const std::string& where, const Error& fault) {
  return tl::unexpected<Error>(Error{where + ": " + fault.text, fault.unreachable});
}

}  // namespace palp
