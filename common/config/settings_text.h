#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

/// Settings as text. `settings` is any message of proto/config.proto: an absent field means its
/// default, everything else goes by the rules in the schema. Foreign text never crashes anything
/// here. Nothing of this is for a control thread.
namespace palp::config {

/// Lays the fields that `text` (protobuf text format) names over `settings`. On an error `settings`
/// is unchanged and the sentence begins "NAME:LINE:COLUMN: ". Ranges and choices are checked here,
/// where the line is known; relations between fields only in check_settings().
[[nodiscard]] Result<void> merge_text(std::string_view text,
                                      std::string_view name,
                                      google::protobuf::Message& settings);

/// Everything the schema demands: ranges, choices, relations. The sentence names the first field
/// that does not hold, as --set would.
[[nodiscard]] Result<void> check_settings(const google::protobuf::Message& settings);

/// Makes every default explicit.
void fill_defaults(google::protobuf::Message& settings);

/// The effective settings, every default written out; merge_text() reads it back.
[[nodiscard]] std::string settings_text(const google::protobuf::Message& settings);

/// For a file that a program makes of a person's, `from`, whose fields `settings` holds: only what
/// was given stands in it, below a line that says what it was made of and that its comments, which
/// the parser drops, are not there.
[[nodiscard]] std::string changed_settings_text(const google::protobuf::Message& settings,
                                                std::string_view from);

/// A hash of the effective settings: equal on every machine, whether a default is written out or
/// absent; any other value or name of a field changes it. Not for secrets (FNV-1a).
[[nodiscard]] std::uint64_t settings_hash(const google::protobuf::Message& settings);

}  // namespace palp::config
