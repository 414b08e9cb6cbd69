#include "study/closed_loop/felt_observer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr double kQuartile = 0.674489750196081743;  // 75 % of the normal distribution lie below
constexpr double kPerSd = kQuartile * 1.41421356237309505;  // JND over the sd of one judgement
constexpr double kForceJnd = 0.07;                          // [-]
constexpr double kPositionJnd = 0.08;                       // [-]
constexpr int kTapsOfWeber = 3;
constexpr double kDepth = 4e-3;     // [m], of a tap
constexpr double kGainReach = 0.4;  // [-], of ln stiffness, where a gain is measured

// Draws of a trial; those of its session have streams of their own.
enum : std::uint64_t { kCoin = 2, kLapse, kJudgements, kTaps = 16, kSession = 4096 };
constexpr std::uint64_t kDepths = 64;
constexpr std::uint64_t kTapsMost = 16;  // of an interval

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

double Judgement::difference_sd(int taps) const noexcept {
  return std::sqrt(2 * (tap_sd * tap_sd / taps + judgement_sd * judgement_sd));
}

double Judgement::jnd(int taps, double gain, double scatter) const noexcept {
  return kQuartile * std::hypot(difference_sd(taps), scatter) / gain;
}

Judgement judgement_of(double weber, double lapse, double own_gain) noexcept {
  Judgement out{.lapse = lapse, .own_gain = own_gain};
  out.tap_sd = std::hypot(kForceJnd, kPositionJnd) / kPerSd;
  const double all = std::log1p(weber) / kPerSd;
  const double left = all * all - out.tap_sd * out.tap_sd / kTapsOfWeber;
  out.judgement_sd = std::sqrt(std::max(0.0, left));
  return out;
}

bool judge_second(const std::array<std::vector<double>, 2>& ln_slopes,
                  const Judgement& judgement,
                  std::uint64_t seed,
                  std::uint64_t stream) noexcept {
  const bool coin = random_uniform(seed, stream, kCoin) < 0.5;
  const bool lapsed = random_uniform(seed, stream, kLapse) < judgement.lapse;
  if (lapsed || ln_slopes[0].empty() || ln_slopes[1].empty()) return coin;
  std::array<double, 2> seems{};
  for (std::size_t interval = 0; interval < 2; ++interval) {
    double noise = 0;
    for (std::size_t tap = 0; tap < ln_slopes[interval].size(); ++tap) {
      noise += judgement.tap_sd * random_normal(seed, stream, kTaps + kTapsMost * interval + tap) /
               static_cast<double>(ln_slopes[interval].size());
    }
    seems[interval] = mean(ln_slopes[interval]) / judgement.own_gain + noise +
                      judgement.judgement_sd * random_normal(seed, stream, kJudgements + interval);
  }
  return seems[1] > seems[0];
}

double own_gain(const FeltSession& session) {
  FeltSetting setting;
  for (auto& depth : setting.depth) {
    depth.assign(static_cast<std::size_t>(session.taps()), kDepth);
  }
  setting.ln_stiffness = {-kGainReach / 2, kGainReach / 2};
  const FeltTrial felt = session.touch(setting);
  return (mean(felt.ln_slopes[1]) - mean(felt.ln_slopes[0])) / kGainReach;
}

FeltSetting setting_of(
    const TrialAsk& ask, bool two_sided, int taps, double depth_sd, std::uint64_t seed) {
  FeltSetting setting{.seed = seed};
  const std::size_t stronger = two_sided ? 1 : ask.stronger;
  setting.ln_stiffness[stronger] = ask.level;
  for (std::size_t interval = 0; interval < 2; ++interval) {
    for (int tap = 0; tap < taps; ++tap) {
      const std::uint64_t index = kTapsMost * interval + static_cast<std::uint64_t>(tap);
      const double noise = std::clamp(depth_sd * random_normal(seed, kDepths, index), -0.3, 0.3);
      setting.depth[interval].push_back(kDepth * (1 + noise));
    }
  }
  return setting;
}

FeltParticipants::FeltParticipants(const Study& study,
                                   const PeopleTraits& people,
                                   std::vector<FeltSession> sessions)
    : seed_{study.seed},
      two_sided_{study.task.two_sided},
      people_{people},
      sessions_{std::move(sessions)},
      own_gain_{own_gain(sessions_.front())} {}

Result<FeltParticipants> FeltParticipants::make(const Study& study, const PeopleTraits& people) {
  if (study.task.intervals != 2) return fail("a felt trial has 2 places, intervals is not 2");
  std::vector<FeltSession> sessions;
  for (const Condition& condition : study.conditions) {
    auto session = FeltSession::make(condition);
    if (!session) return tl::unexpected(session.error());
    sessions.push_back(std::move(*session));
  }
  return FeltParticipants{study, people, std::move(sessions)};
}

TrialOutcome FeltParticipants::answer(const TrialPlace& place, const TrialAsk& ask) const {
  const FeltSession& session = sessions_[place.condition];
  const std::uint64_t stream = trial_stream(place, ask.number);
  const double weber = std::expm1(std::exp(drawn_ln_jnd(people_, seed_, place.participant)));
  const Judgement judgement = judgement_of(weber, people_.lapse, own_gain_);
  const std::uint64_t seed = random_bits(seed_, stream, kSession) >> 16;
  const FeltSetting setting = setting_of(ask, two_sided_, session.taps(), judgement.depth_sd, seed);
  FeltTrial felt = session.feel(setting);
  if (two_sided_) felt.ln_slopes[0] = session.touch(setting).ln_slopes[0];
  const double response = drawn_response_time(seed_, place, ask.number);
  return {.chosen = judge_second(felt.ln_slopes, judgement, seed_, stream) ? 1U : 0U,
          .onset = 0,
          .duration = felt.duration + response,
          .response_time = response,
          .taps = felt.taps,
          .force_max = felt.force_max,
          .contact = felt.contact};
}

}  // namespace palp::study
