#pragma once

#include <cstdint>
#include <cstdlib>

#include "common/core/random.h"

namespace palp {

/// What run number `run` of a test draws from. The same runs each time, so that a red one can be
/// repeated; PALP_SEED=N in the environment makes others of them.
inline RandomStream random_run(std::uint64_t test, std::uint64_t run) {
  const char* const seed = std::getenv("PALP_SEED");  // NOLINT(concurrency-mt-unsafe)
  return {test + (seed == nullptr ? 0 : 1000 * std::strtoull(seed, nullptr, 10)), run};
}

}  // namespace palp
