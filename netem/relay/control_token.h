#pragma once

#include <string>
#include <string_view>

#include "common/core/result.h"

/// What a caller of the live control by TCP shows first: any user of the machine reaches a port.
namespace palp::netem {

/// Fewer characters could be guessed.
inline constexpr std::size_t kTokenMin = 16;

/// The first line of the file, at least kTokenMin printable characters without quotes, or where
/// there is no file yet a new one of 128 random bits, for its owner to read (0600).
/// @returns or the sentence that says why not; a file that others may read is refused.
[[nodiscard]] Result<std::string> read_or_make_token(const std::string& path);

/// Whether `line` is {"token":"TOKEN"} with this one. Takes as long wherever they differ.
[[nodiscard]] bool shows_token(std::string_view line, std::string_view token);

}  // namespace palp::netem
