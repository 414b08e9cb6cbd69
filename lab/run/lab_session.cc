#include "lab/run/lab_session.h"

#include <algorithm>
#include <array>
#include <optional>
#include <variant>

#include "common/link/header.h"
#include "common/link/packet_protection.h"

namespace palp::lab {

LabSession::LabSession(const link::SessionConfig& config,
                       std::uint64_t entropy,
                       link::Transport& end,
                       const LocalClock& clock,
                       link::Link& link)
    : session_{config, entropy}, end_{end}, clock_{clock}, link_{link} {}

bool LabSession::DataWay::send(std::span<const std::byte> datagram, TimePoint now) noexcept {
  return owner_.end_.send(datagram, owner_.clock_.world(now));
}

std::optional<link::Datagram> LabSession::DataWay::receive(
    std::span<std::byte, link::kDatagramSizeMax> buffer, TimePoint now) noexcept {
  if (owner_.data_.empty()) owner_.drain(owner_.clock_.world(now));
  if (owner_.data_.empty()) return std::nullopt;
  const Waiting& next = owner_.data_.front();
  const link::Datagram datagram{next.bytes.size(), next.arrived_at};
  std::copy(next.bytes.begin(), next.bytes.end(), buffer.begin());
  owner_.data_.pop_front();
  return datagram;
}

/// What arrived goes to whom its first byte names, as the kernel's two sockets would do it.
void LabSession::drain(TimePoint now) {
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  while (const auto got = end_.receive(buffer, now)) {
    const std::span bytes{buffer.data(), std::min(got->size, buffer.size())};
    const auto header = link::parse_header(bytes);
    if (!header) continue;
    auto& inbox = header->type == link::PacketType::Data ? data_ : control_;
    inbox.push_back({{bytes.begin(), bytes.end()}, clock_.local(got->arrived_at)});
  }
}

void LabSession::carry_out(const link::SessionOutput& output, TimePoint now) {
  for (const link::ControlBytes& datagram : output.datagrams) {
    (void)end_.send(datagram.view(), now);
  }
  if (!output.event) return;
  if (const auto* met = std::get_if<link::Established>(&*output.event)) {
    link::LinkUpdate next{.transport = std::make_unique<DataWay>(*this),
                          .protection = std::make_unique<link::PlainProtection>(),
                          .send_connection = met->send_connection,
                          .receive_connection = met->receive_connection,
                          .session_id = met->session_id,
                          .peer_devices = met->peer_devices};
    (void)link_.adopt(std::move(next), clock_.local(now));
  } else if (std::holds_alternative<link::Closed>(*output.event)) {
    (void)link_.adopt({}, clock_.local(now));
  }
}

void LabSession::step(TimePoint now) {
  drain(now);
  // Without a session nobody reads data: what belongs to none is thrown away, as io does.
  if (!session_.established()) data_.clear();
  while (!control_.empty()) {
    const Waiting next = std::move(control_.front());
    control_.pop_front();
    carry_out(session_.on_datagram(next.bytes, clock_.local(now)), now);
  }
  const LinkHealth health = link_.health(clock_.local(now));
  carry_out(session_.tick(clock_.local(now), health.state, health.session_id), now);
}

}  // namespace palp::lab
