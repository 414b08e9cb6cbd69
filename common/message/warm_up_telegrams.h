#pragma once

#include <array>
#include <variant>

#include "common/message/telegram.h"

namespace palp::message {

/// For each kind of payload a telegram with all that a node can say, and nothing in it 0: a codec
/// that is warmed up on it goes every way that it may have to go with this payload.
[[nodiscard]] const std::array<Telegram, std::variant_size_v<CouplingPayload>>&
warm_up_telegrams() noexcept;

}  // namespace palp::message
