#include "site_program/impaired_reception.h"

#include <utility>

#include "netem/model/impaired_transport.h"
#include "netem/model/impairment.h"

namespace palp::site_program {
namespace {

/// The longest delay there is, 5 s, at 1 kHz and as much again for its jitter and copies.
constexpr std::size_t kInFlightMax = 16384;

}  // namespace

Result<io::TransportWrap> impaired_reception(const settings::ImpairmentSettings& impairment,
                                             netem::Direction direction,
                                             std::uint64_t seed,
                                             TimePoint start) {
  if (!impairment.any()) return io::TransportWrap{};
  const Result<netem::Impairment> law =
      impairment.spec.empty()
          ? netem::impairment_from_delay(impairment.delay, impairment.jitter, impairment.loss)
          : netem::parse_impairment(impairment.spec);
  if (!law) return fail("--impair: " + law.error().text);
  return [law = *law, direction, seed, start](std::unique_ptr<link::Transport> socket) {
    return std::make_unique<netem::ImpairedTransport>(
        std::move(socket), netem::Channel{law, seed, direction, kInFlightMax, start});
  };
}

}  // namespace palp::site_program
