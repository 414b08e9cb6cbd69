#pragma once

#include <string>
#include <vector>

#include "common/core/time.h"
#include "common/io/realtime/periodic_loop.h"

/// Whether this machine can run a site on time, and what to change where it cannot.
namespace palp::io {

/// One thing looked at. Sentences are for people.
struct MachineFinding {
  std::string what;    ///< "timer lateness"
  std::string found;   ///< "99 % of the ticks within 12 us, the worst 80 us late, none missed"
  bool good{};         ///< nothing to change
  std::string advice;  ///< what to change; empty where good
};

/// What was read from the system; a text is empty where there was nothing to read.
struct MachineFacts {
  LoopStats loop;             ///< of an idle loop at the site's rate
  std::string clock_source;   ///< of the kernel's clock: "tsc"
  std::string governor;       ///< of the first processor's frequency: "performance"
  int processors{};           ///< usable ones
  int receive_buffer{};       ///< [bytes], of a site's socket, as the kernel gave it
  int receive_buffer_want{};  ///< [bytes], as a site asks for it
};

/// Runs an idle loop with the rights of a site for `span` and reads the rest.
[[nodiscard]] MachineFacts read_machine(const LoopConfig& loop, Duration span);

/// What the facts mean for a loop of `period`.
[[nodiscard]] std::vector<MachineFinding> judge_machine(const MachineFacts& facts, Duration period);

}  // namespace palp::io
