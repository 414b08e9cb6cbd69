#pragma once

#include <algorithm>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "common/coupling/any_coupling.h"
#include "common/link/codec.h"
#include "common/link/link.h"
#include "common/record/recorder.h"
#include "surgeon_site/script_builder.h"

namespace palp::surgeon {

/// A delay line for datagrams: nothing is lost or reordered unless it is cut.
class Wire {
 public:
  Duration delay{};
  bool cut{};

  void push(std::span<const std::byte> bytes, TimePoint now) {
    if (!cut) under_way_.push_back({now + delay, {bytes.begin(), bytes.end()}});
  }
  std::optional<link::Datagram> pop(std::span<std::byte> buffer, TimePoint now) {
    if (under_way_.empty() || under_way_.front().due > now) return std::nullopt;
    const Packet packet = std::move(under_way_.front());
    under_way_.pop_front();
    std::memcpy(buffer.data(), packet.bytes.data(), std::min(buffer.size(), packet.bytes.size()));
    return link::Datagram{packet.bytes.size(), packet.due};
  }

 private:
  struct Packet {
    TimePoint due;
    std::vector<std::byte> bytes;
  };
  std::deque<Packet> under_way_;
};

class WireEnd final : public link::Transport {
 public:
  WireEnd(Wire& out, Wire& in) : out_{out}, in_{in} {}
  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override {
    out_.push(datagram, now);
    return true;
  }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    return in_.pop(buffer, now);
  }

 private:
  Wire& out_;
  Wire& in_;
};

inline void open_session(link::Link& link, Wire& out, Wire& in, std::uint64_t id, TimePoint now) {
  link::LinkUpdate link_update;
  link_update.transport = std::make_unique<WireEnd>(out, in);
  link_update.protection = std::make_unique<link::PlainProtection>();
  link_update.send_connection = 1;
  link_update.receive_connection = 1;
  link_update.session_id = id;
  static_cast<void>(link.adopt(std::move(link_update), now));
}

/// Keeps all that is recorded.
class Keeper final : public record::Recorder {
 public:
  bool record(const Record& record) noexcept override {
    kept.push_back(record);
    return true;
  }
  template <class T>
  [[nodiscard]] std::vector<T> all() const {
    std::vector<T> found;
    for (const Record& one : kept) {
      if (const T* match = std::get_if<T>(&one)) found.push_back(*match);
    }
    return found;
  }

  std::vector<Record> kept;
};

/// A patient's site as the surgeon's needs it: a perfect stage on the tissue scripts assume. It
/// follows every engagement and holds in a gap; the test moves it to any other state.
class PlainPatient {
 public:
  explicit PlainPatient(Wire& out, Wire& in) : out_{out}, in_{in} { restart(1, TimePoint{}); }

  /// Another process: knows nothing of what was.
  void restart(std::uint64_t session_id, TimePoint now) {
    link_ = std::make_unique<link::Link>(link::LinkConfig{}, std::make_unique<link::RawCodec>());
    open_session(*link_, out_, in_, session_id, now);
    report = {};
    report.state = SiteState::Clutched;
    position = -10e-3;
  }

  void tick(TimePoint now) {
    const link::Arrivals arrived = link_->receive(now);
    if (follows && arrived.peer_heard && arrived.peer.epoch > report.epoch) {
      report.epoch = arrived.peer.epoch;
      report.state = SiteState::Engaged;
      coupling::begin_epoch(law_, position);
    }
    if (report.state == SiteState::Engaged && arrived.peer.state == SiteState::Clutched) {
      report.state = SiteState::Clutched;
    }
    coupling::PatientInput in;
    in.now = now;
    in.state = report.state;
    in.position = position;
    in.contact_force = plain_force(std::max(0.0, position));
    in.arrived = arrived.samples;
    const coupling::PatientOutput out = coupling::step(law_, in, std::chrono::milliseconds{1});
    if (report.state == SiteState::Engaged) position = out.target_position;
    link_->send({report, out.to_surgeon}, now);
  }

  SiteReport report;
  double position{-10e-3};  ///< [m]
  bool follows{true};

 private:
  Wire& out_;
  Wire& in_;
  std::unique_ptr<link::Link> link_;
  coupling::PatientCoupling law_{coupling::DirectPatient{{}}};
};

}  // namespace palp::surgeon
