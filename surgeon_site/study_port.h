#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "common/core/time.h"
#include "common/io/process/message_pipe.h"
#include "monitor/study_screen.h"
#include "site_program/recording.h"
#include "surgeon_site/placed_hand.h"
#include "surgeon_site/surgeon_status.h"

namespace palp::surgeon {

/// What a site says to the study that started it, and what the study asks of it. JSON, a message
/// each:
///
///     site to study  {"at_ns", "engaged", "force_n", "contact_n", "x_mm", "y_mm"}    each look
///                    {"page": "http://..."}                                           once
///                    {"answer": 2, "trial": 5, "at_ns"}    of the page
///                    {"answer": 2, "at_ns"}                of a button, to the trial that asks
///     study to site  {"place": {"x_mm", "y_mm", "reach_mm"}}      where the stage is to stand, and
///                    how far to all sides the hand may leave that; no reach: not at all
///                    {"show": {...}}                  for the participant's page, unread here
///                    {"note": 56, "detail": 5, "at_ns"}        a note of a study's (notes.h)
///
/// `at_ns` is of the machine's steady clock, which both programs share. The study moves nothing:
/// the stage goes to its place while the participant holds the pedal, by the gates of both sites.
/// Thread: main.
class StudyPort {
 public:
  /// `hand` outlives it.
  StudyPort(io::MessagePipe pipe, HapticDevice& hand) noexcept
      : pipe_{std::move(pipe)}, hand_{hand} {}

  /// The hand that the node is given.
  [[nodiscard]] PlacedHand& hand() noexcept { return hand_; }
  /// For the page.
  [[nodiscard]] monitor::StudyScreen& screen() noexcept { return screen_; }
  /// Where the participant's page is.
  void tell_page(const std::string& address);
  /// A button of the device was pressed that stands for that answer, from 1.
  void tell_answer(std::uint32_t choice, TimePoint now);
  /// @returns false: the study has ended, and so should the site.
  [[nodiscard]] bool look(const SurgeonStatus& status,
                          site_program::Recording& recording,
                          TimePoint now);

 private:
  void obey(const std::string& message, site_program::Recording& recording, TimePoint now);

  io::MessagePipe pipe_;
  PlacedHand hand_;
  monitor::StudyScreen screen_;
  std::uint64_t wishes_{};  ///< for places so far
};

}  // namespace palp::surgeon
