#pragma once

#include <string_view>

#include "common/core/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

/// Single fields by path, for --set and for flags.
namespace palp::config {

/// "motion_gate.force_limit_n=2.5". A text is given without quotes and may be empty; a boolean is
/// true or false. Ranges and choices are checked; on an error `settings` is unchanged. Lists are
/// for files.
[[nodiscard]] Result<void> apply_override(std::string_view assignment,
                                          google::protobuf::Message& settings);

/// The same in parts; the sentence calls the field `name` ("--force-limit-n").
[[nodiscard]] Result<void> apply_value(std::string_view path,
                                       std::string_view value,
                                       std::string_view name,
                                       google::protobuf::Message& settings);

}  // namespace palp::config
