#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/core/time.h"
#include "netem/model/path_plan.h"
#include "video/receiver.h"
#include "video/sender.h"

namespace palp::video {

/// Video and force telegrams over one emulated path, in virtual time.
struct VideoPathSetup {
  netem::PathPlan up;     ///< surgeon to patient
  netem::PathPlan down;   ///< patient to surgeon: pictures and force
  double rate_mbps{100};  ///< [Mbit/s] of `down` at the start, for what force has without video
  Duration one_way{};     ///< of `down`, without queue
  Duration length{std::chrono::seconds{60}};
  Duration judged_from{std::chrono::seconds{3}};
  std::uint64_t seed{1};
  RateConfig rate{};
  bool with_video{true};
  bool with_control{true};  ///< false: full rate, whatever force says
};

struct VideoPathResult {
  std::vector<double> force_excess_ms;  ///< one a telegram, from judged_from on; by time
  std::vector<double> force_arrived_s;  ///< beside it
  std::uint64_t force_dropped{};        ///< by the full queue, telegrams and fragments alike
  std::vector<double> frame_delay_ms;   ///< capture to whole, less the line, likewise
  double frozen_share{};                ///< of time, in pauses above 100 ms
  double fps{};
  double wire_kbps{};     ///< [kbit/s], with heads
  std::uint64_t wrong{};  ///< frames shown that could not be decoded rightly
  double off_share{};     ///< of time: video has stopped, for force
  SenderCounts sent;
  ReceiverCounts received;
};

/// `picture_of`: what the camera sees as frame `number`; `is_right`: a delivered frame, decoded.
using PictureOf = std::function<const Picture&(std::uint32_t number, Duration at)>;
using IsRight = std::function<bool(const ReceivedFrame& frame)>;

[[nodiscard]] VideoPathResult run_video_path(const VideoPathSetup& setup,
                                             Encoder& encoder,
                                             const PictureOf& picture_of,
                                             const IsRight& is_right);
/// With a ModelEncoder.
[[nodiscard]] VideoPathResult run_video_path(const VideoPathSetup& setup);

/// The same words for both ways, `down` behind a line of that rate with a queue of 200 ms; 0: none.
[[nodiscard]] VideoPathSetup video_path(const std::string& words,
                                        Duration one_way,
                                        double rate_mbps);

/// `share` [0, 1].
[[nodiscard]] double quantile_of(std::vector<double> values, double share);

}  // namespace palp::video
