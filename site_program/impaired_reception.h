#pragma once

#include <cstdint>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/secure/session_server.h"
#include "common/settings/site_settings.h"
#include "netem/model/impairment_model.h"

namespace palp::site_program {

/// Impairs what a site receives, inside the program. Empty where nothing is asked for; a sentence
/// for words that netem does not know. A new connection starts a new channel with the same seed.
/// `start`: where the times of blackouts begin.
[[nodiscard]] Result<io::TransportWrap> impaired_reception(
    const settings::ImpairmentSettings& impairment,
    netem::Direction direction,
    std::uint64_t seed,
    TimePoint start);

}  // namespace palp::site_program
