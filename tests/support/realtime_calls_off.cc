#include "tests/support/realtime_calls.h"

// Under a sanitizer malloc and the locks belong to the sanitizer: nothing is watched.
namespace palp::test {

void prepare_realtime_calls() noexcept {}

}  // namespace palp::test
