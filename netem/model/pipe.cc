#include "netem/model/pipe.h"

namespace palp::netem {
namespace {

class PipeEnd final : public link::Transport {
 public:
  PipeEnd(Channel& outgoing, Channel& incoming) : outgoing_{outgoing}, incoming_{incoming} {}

  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override {
    outgoing_.push(datagram, now);
    return true;
  }

  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    const auto released = incoming_.pop(buffer, now);
    if (!released) return std::nullopt;
    return link::Datagram{released->size, released->released_at};
  }

 private:
  Channel& outgoing_;
  Channel& incoming_;
};

}  // namespace

Pipe::Pipe(const Impairment& up,
           const Impairment& down,
           std::uint64_t seed,
           std::size_t in_flight_max,
           TimePoint start)
    : Pipe{PathPlan{.impairment = up}, PathPlan{.impairment = down}, seed, in_flight_max, start} {}

Pipe::Pipe(const PathPlan& up,
           const PathPlan& down,
           std::uint64_t seed,
           std::size_t in_flight_max,
           TimePoint start)
    : up_{up, seed, Direction::Up, in_flight_max, start, link::kDatagramSizeMax},
      down_{down, seed, Direction::Down, in_flight_max, start, link::kDatagramSizeMax} {}

std::unique_ptr<link::Transport> Pipe::surgeon_end() {
  return std::make_unique<PipeEnd>(up_, down_);
}

std::unique_ptr<link::Transport> Pipe::patient_end() {
  return std::make_unique<PipeEnd>(down_, up_);
}

}  // namespace palp::netem
