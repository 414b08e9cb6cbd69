#include "lab/plan/set_case.h"

#include "common/core/formatted.h"

namespace palp::lab {
namespace {

/// In the words of the emulator.
std::string path_words(const SetDraw& draw) {
  std::string words = formatted("delay %.9gms", draw.round_trip * 500);
  if (draw.jitter > 0) {
    words += formatted(" %.9gms distribution normal floor 20%% order free",
                       draw.round_trip * 500 * draw.jitter);
  }
  if (draw.loss > 0) words += formatted(" loss %.9g%%", draw.loss * 100);
  if (draw.burst_rate > 0) {
    words += formatted(" loss burst %.9g/s %.9gms", draw.burst_rate, draw.burst_length * 1e3);
  }
  if (draw.duplicate > 0) words += formatted(" duplicate %.9g%%", draw.duplicate * 100);
  return words;
}

std::string phantom_words(const std::string& tissue, double inclusion) {
  if (tissue == "fe") return formatted("paper-%.0fmm", inclusion);
  if (tissue.find(':') != std::string::npos || tissue == "none" || tissue.rfind("paper", 0) == 0) {
    return tissue;
  }
  return formatted("%s:%.9g", tissue.c_str(), inclusion);
}

Case make_one(std::uint64_t index, std::uint64_t seed, const SetDraw& draw, const PlanAsk& ask) {
  const std::string path = path_words(draw);
  Case one;
  one.index = index;
  one.seed = seed;
  one.settings = {{"coupling.name", ask.coupling},
                  {"surgeon.engagement.forced", "true"},
                  {"up.spec", path},
                  {"down.spec", path},
                  {"surgeon.hand.grip", std::string{draw.grip}},
                  {"patient.simulated_phantom.servo_hz", nine_digit_text(draw.servo)},
                  {"patient.simulated_phantom.phantom", phantom_words(ask.tissue, draw.inclusion)}};
  one.labels = {nine_digit_text(draw.round_trip * 1e3),
                nine_digit_text(draw.jitter),
                nine_digit_text(draw.loss),
                nine_digit_text(draw.burst_rate),
                nine_digit_text(draw.duplicate),
                std::string{draw.grip},
                nine_digit_text(draw.servo),
                nine_digit_text(draw.inclusion)};
  return one;
}

}  // namespace

const std::vector<std::string>& set_labels() {
  static const std::vector<std::string> labels{
      "rtt_ms", "jitter", "loss", "burst_per_s", "duplicate", "grip", "servo_hz", "inclusion_mm"};
  return labels;
}

std::string nine_digit_text(double value) { return formatted("%.9g", value); }

void add_case(Plan& plan, std::uint64_t seed, const SetDraw& draw, const PlanAsk& ask) {
  plan.cases.push_back(make_one(plan.cases.size(), seed, draw, ask));
}
}  // namespace palp::lab
