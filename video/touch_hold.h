#pragma once

#include <cstddef>
#include <deque>

#include "common/core/time.h"

namespace palp::video {

/// How long touch is to be held back so that it is as old as the picture: by what 19 of 20 pictures
/// of the last 10 s took longer than a force telegram, and by what a browser takes to show one. The
/// page keeps a picture that came sooner until touch is as old.
/// A value. Thread: one.
class TouchHold {
 public:
  static constexpr Duration kShowing = std::chrono::milliseconds{8};  ///< decoding and drawing
  static constexpr Duration kMax = std::chrono::milliseconds{100};    ///< of what it says

  /// A picture of that age was delivered; a force telegram takes `way`.
  void add(Duration age, Duration way);
  /// 0 where no picture came for 2 s: there is nothing to be in step with.
  [[nodiscard]] Duration wanted(TimePoint now);

 private:
  static constexpr std::size_t kPictures = 300;  ///< 10 s of 30 a second
  static constexpr Duration kAnew = std::chrono::seconds{1};
  static constexpr Duration kNone = std::chrono::seconds{2};

  std::deque<Duration> behind_;  ///< the newest last
  bool fresh_{};                 ///< one came since the last look
  TimePoint fresh_at_{};
  TimePoint anew_at_{};
  Duration wanted_{};
};

}  // namespace palp::video
