#pragma once

#include <optional>
#include <string>

#include "common/core/time.h"
#include "surgeon_site/devices/hid_master.h"
#include "surgeon_site/devices/master_plan.h"

namespace palp::surgeon {

struct MasterNews {
  std::string sentence;  ///< "master (Teensy paddle): absent, cannot be opened"
  bool fit{};
};

/// The master of a site on its thread, and what the site sees of it.
/// Thread: main; device(): rt.
class MasterRig {
 public:
  /// Starts the thread; it is not ready yet. `priority` of it: SCHED_FIFO, 0: none.
  MasterRig(const MasterPlan& plan, int priority);

  [[nodiscard]] bool ready() noexcept { return thread_.status().state == MasterState::Ready; }
  /// Why it will not be ready any more, `waited` after its making: it reports a fault, is not there
  /// for 5 s, or starts for 10 s.
  [[nodiscard]] std::optional<std::string> hopeless(Duration waited);
  /// Where it changed its state since the last call.
  [[nodiscard]] std::optional<MasterNews> news();
  /// The answer, from 1, whose button was pressed since the last call: the last one.
  [[nodiscard]] std::optional<std::uint32_t> take_answer();
  /// Out of a fault, from the beginning of its start.
  void restart() noexcept { thread_.restart(); }
  [[nodiscard]] HapticDevice& device() noexcept { return device_; }

 private:
  [[nodiscard]] std::string sentence();

  std::string product_;
  MasterThread thread_;
  HidMaster device_;
  MasterState state_{};      ///< as told last
  std::string_view why_;     ///< as told last
  std::uint32_t answers_{};  ///< as taken last
};

}  // namespace palp::surgeon
