#pragma once

namespace palp::test {

/// Looks up all functions that realtime_calls.cc passes calls on to, so that none is looked up,
/// with locks and allocation, inside guarded code.
void prepare_realtime_calls() noexcept;

}  // namespace palp::test
