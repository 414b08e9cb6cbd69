// What video does to force and how it gets through losses, in virtual time with the true encoder:
// video_bench [SECONDS]. Targets beside the figures.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/video/model_encoder.h"
#include "tests/video/video_path.h"
#include "video/encoders.h"
#include "video/picture.h"

namespace palp::video {
namespace {

constexpr Duration kOneWay = std::chrono::microseconds{37'500};

VideoPathResult run(VideoPathSetup setup, Duration length) {
  setup.length = length;
  const auto encoder = make_h264_encoder(PhantomPicture::kWidth, PhantomPicture::kHeight);
  if (encoder == nullptr) return run_video_path(setup);
  PhantomPicture phantom;
  return run_video_path(
      setup,
      *encoder,
      [&](std::uint32_t, Duration at) -> const Picture& {
        const double t = seconds(at);
        return phantom.draw(
            {.x = 0.01 * std::sin(0.5 * t), .depth = 0.004 * std::sin(3 * t), .surface = 0});
      },
      [](const ReceivedFrame&) { return true; });
}

void show(const std::string& name, const VideoPathResult& result, const char* target) {
  std::printf(
      "%-28s force +%5.2f ms p99, %5.1f most, %llu dropped; picture %5.1f/%5.1f ms p50/p95, "
      "frozen %5.2f %%, %4.0f kbit/s, %4.1f fps   %s\n",
      name.c_str(),
      quantile_of(result.force_excess_ms, 0.99),
      quantile_of(result.force_excess_ms, 1),
      static_cast<unsigned long long>(result.force_dropped),
      quantile_of(result.frame_delay_ms, 0.5),
      quantile_of(result.frame_delay_ms, 0.95),
      100 * result.frozen_share,
      result.wire_kbps,
      result.fps,
      target);
}

void run_all(Duration length) {
  for (const auto& [rate, target] : {std::pair{100.0, ""},
                                     {10.0, "M5: p99 1.5"},
                                     {5.0, "M5: p99 4"},
                                     {3.0, "M5: p99 8"},
                                     {2.5, "M5: p99 15"},
                                     {2.2, ""},
                                     {2.0, ""}}) {
    show(std::to_string(rate).substr(0, 5) + " Mbit/s",
         run(video_path("", kOneWay, rate), length),
         target);
  }
  for (const char* words : {"loss 1%", "loss 3%", "loss 5%"}) {
    for (const int round_trip : {20, 75, 250}) {
      const Duration one_way = std::chrono::milliseconds{round_trip} / 2;
      show(std::string{words} + ", RTT " + std::to_string(round_trip),
           run(video_path(words, one_way, 10), length),
           "M7: frozen 1");
    }
  }
  VideoPathSetup beginning = video_path("loss 2%", kOneWay, 100);
  beginning.judged_from = Duration{0};
  show("2 %, the first 5 s", run(beginning, std::chrono::seconds{5}), "M2: p95 25");
  show("2 % in runs of 3",
       run(video_path("loss gemodel 0.68% 33.3% 100% 0%", kOneWay, 10), length),
       "M8: frozen 4");
}

}  // namespace
}  // namespace palp::video

int main(int argc, char** argv) {
  palp::video::run_all(std::chrono::seconds{argc > 1 ? std::atoi(argv[1]) : 60});
}
