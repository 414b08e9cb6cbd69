#include "site_program/address_proof.h"

namespace palp::site_program {

std::optional<std::uint64_t> AddressProof::hear(const io::Endpoint& from,
                                                std::uint64_t echo,
                                                TimePoint now) {
  if (from == proven_) {
    heard_at_ = now;
    return std::nullopt;
  }
  if (!silent(now)) return std::nullopt;
  if (from == asked_ && challenge_ != 0 && echo == challenge_) {
    proven_ = from;
    heard_at_ = now;
    challenge_ = 0;
    return std::nullopt;
  }
  if (from == asked_ && now - asked_at_ < kAskEvery) return std::nullopt;
  // A question that is repeated stays the same: the answer to the first one counts.
  if (!(from == asked_) || challenge_ == 0) challenge_ = draw_() | 1U;
  asked_ = from;
  asked_at_ = now;
  return challenge_;
}

}  // namespace palp::site_program
