#include "common/core/denormals.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace palp {
namespace {

#if defined(__x86_64__)
// MXCSR, Intel SDM volume 1, 10.2.3: bit 15 flush to zero (results), bit 6 denormals are zero
// (operands).
constexpr std::uint64_t kFlush = (1U << 15U) | (1U << 6U);
std::uint64_t control_word() noexcept { return _mm_getcsr(); }
void set_control_word(std::uint64_t word) noexcept { _mm_setcsr(static_cast<std::uint32_t>(word)); }
#elif defined(__aarch64__)
// FPCR bit 24, Arm Architecture Reference Manual: flush to zero, operands and results.
constexpr std::uint64_t kFlush = 1U << 24U;
std::uint64_t control_word() noexcept {
  std::uint64_t word = 0;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return word;
}
void set_control_word(std::uint64_t word) noexcept { asm volatile("msr fpcr, %0" : : "r"(word)); }
#else
constexpr std::uint64_t kFlush = 0;
std::uint64_t control_word() noexcept { return 0; }
void set_control_word(std::uint64_t /*word*/) noexcept {}
#endif

}  // namespace

DenormalFlush::DenormalFlush() noexcept : previous_{control_word()} {
  set_control_word(previous_ | kFlush);
}

DenormalFlush::~DenormalFlush() { set_control_word(previous_); }

}  // namespace palp
