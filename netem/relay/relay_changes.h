#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/time.h"
#include "netem/relay/relay.h"
#include "netem/syntax/timeline.h"

namespace palp::netem {

/// The changes that live control asked for, from the line to the answer: holds each until its time
/// has come, hands it to the relay and hears when it was applied. Which law holds it knows from the
/// relay. Thread: the one that serves the control; the relay's is another.
class RelayChanges {
 public:
  using Reply = std::function<void(std::uint64_t number, const std::string& text)>;

  /// All outlive this object; the plans are the relay's. `read`: the files that words may name.
  RelayChanges(Relay& relay, const PathPlan& up, const PathPlan& down, FileReader read)
      : relay_{relay}, plans_{&up, &down}, read_{std::move(read)} {}

  /// The laws that hold now; on a ramp the one where it leads.
  [[nodiscard]] ControlContext laws() const;
  /// What `line` asks for.
  [[nodiscard]] Result<ControlRequest> read(std::string_view line) const {
    return parse_control_line(line, laws(), read_);
  }
  /// `request` is what `line` says. @returns false: too many wait.
  [[nodiscard]] bool hold(const ControlRequest& request,
                          std::string_view line,
                          std::uint64_t number);
  /// Hands over what is due, and replies to what has been applied.
  void work(TimePoint now, const Reply& reply);
  /// What was applied, a line each, since the last call.
  [[nodiscard]] std::vector<std::string> take_log();

 private:
  struct Waiting {
    TimePoint at{};
    std::uint64_t number{};
    std::string line;
    bool now{};
    bool stands_on_law{};
  };
  struct Underway {
    std::size_t ways{};  ///< directions that have not applied it yet
    std::optional<double> asked_s;
  };
  [[nodiscard]] const Impairment& law(std::size_t way) const;
  [[nodiscard]] Result<void> hand_over(const Waiting& change);
  [[nodiscard]] bool enqueue(const Change& change, Direction direction, const Waiting& waiting);
  void hear(const Reply& reply);

  Relay& relay_;
  std::array<const PathPlan*, 2> plans_;
  FileReader read_;
  std::vector<Waiting> waiting_;  ///< by time, then as they came
  std::map<std::uint64_t, Underway> underway_;
  std::size_t commands_underway_{};
  std::array<std::map<std::uint64_t, Impairment>, 2> own_laws_;  ///< of changes, by law number
  std::uint64_t own_laws_made_{};
  std::vector<std::string> log_;
};

}  // namespace palp::netem
