#include "study/closed_loop/felt_observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/core/random.h"
#include "study/orders.h"
#include "study/raster.h"
#include "study/stimulus.h"

namespace palp::study {
namespace {

constexpr double kPerSd = kQuartile * 1.41421356237309505;  // JND over the sd of one judgement
constexpr double kForceJnd = 0.07;                          // [-]
constexpr double kPositionJnd = 0.08;                       // [-]
constexpr double kReadJnd = 0.03;                           // [-], of a bar's length
constexpr int kTapsOfWeber = 3;
constexpr double kDepth = 4e-3;     // [m], of a tap
constexpr double kGainReach = 0.4;  // [-], of ln stiffness, where a gain is measured

// Draws of a trial; those of its session have streams of their own.
constexpr std::uint64_t kCoin = 2;
constexpr std::uint64_t kLapse = 3;
constexpr std::uint64_t kJudgements = 4;
constexpr std::uint64_t kSession = 4096;
constexpr std::uint64_t kDepths = 64;
constexpr std::uint64_t kTapsMost = 16;  // of an interval

constexpr std::uint64_t kGuess = 128;  // a stream apart from those of depths

constexpr std::uint64_t kPlain = 0x706c61696e000000;  // streams apart from those of trials
constexpr std::uint64_t kPlainTouches = 12;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// [m], aimed at in an interval.
std::vector<double> depths_drawn(int taps,
                                 double depth_sd,
                                 std::uint64_t seed,
                                 std::size_t interval) {
  std::vector<double> out;
  for (int tap = 0; tap < taps; ++tap) {
    const std::uint64_t index = kTapsMost * interval + static_cast<std::uint64_t>(tap);
    const double noise = std::clamp(depth_sd * random_normal(seed, kDepths, index), -0.3, 0.3);
    out.push_back(kDepth * (1 + noise));
  }
  return out;
}

/// By which an interval is judged.
int taps_of(const FeltInterval& felt) noexcept {
  return static_cast<int>(std::max({std::size_t{1}, felt.ln_slopes.size(), felt.ln_drawn.size()}));
}

}  // namespace

double Judgement::sd(int taps) const noexcept {
  if (feedback == Feedback::Depth) return 0;
  const double judged = judgement_sd * judgement_sd;
  const double common = position_sd * position_sd / taps + (reads_exactly ? 0 : judged);
  const double felt = force_sd * force_sd / taps + (reads_exactly ? judged : 0);
  const double drawn = read_sd * read_sd / taps;
  const double share = drawn_share(taps);
  return level_unit({.delays = delays}) *
         std::sqrt(common + (1 - share) * (1 - share) * felt + share * share * drawn);
}

double Judgement::drawn_share(int taps) const noexcept {
  if (feedback != Feedback::Both) return feedback == Feedback::Drawn ? 1 : 0;
  // By the variances that the two do not have in common.
  const double felt =
      force_sd * force_sd / taps + (reads_exactly ? judgement_sd * judgement_sd : 0);
  return felt / (felt + read_sd * read_sd / taps);
}

double Judgement::jnd(const Task& task, int taps, double gain, double scatter) const {
  if (task.yes_no) return kQuartile * std::hypot(sd(taps), scatter) / gain;
  return d_prime_at_jnd(task) * std::hypot(sd(taps), scatter / std::sqrt(2.0)) / gain;
}

Judgement judgement_of(double weber, double lapse, double own_gain) noexcept {
  Judgement out{.lapse = lapse, .own_gain = own_gain};
  out.force_sd = kForceJnd / kPerSd;
  out.read_sd = kReadJnd / kPerSd;
  out.position_sd = kPositionJnd / kPerSd;
  const double all = std::log1p(weber) / kPerSd;
  const double tap_sd = std::hypot(out.force_sd, out.position_sd);
  out.judgement_sd = std::sqrt(std::max(0.0, all * all - tap_sd * tap_sd / kTapsOfWeber));
  return out;
}

Judgement judgement_for(const FeltSession& session, const Task& task, double weber, double lapse) {
  const std::vector<double> depth(static_cast<std::size_t>(session.taps()), kDepth);
  // Of plain tissue made stiffer by so much: a ball's levels are contrasts of its own depths alone.
  const FeltTrial felt =
      session.touch({.places = {{-kGainReach / 2, depth}, {kGainReach / 2, depth}}, .plain = true});
  const FeltInterval& soft = felt.intervals[0];
  const FeltInterval& stiff = felt.intervals[1];
  Judgement out =
      judgement_of(weber, lapse, (mean(stiff.ln_slopes) - mean(soft.ln_slopes)) / kGainReach);
  out.feedback = session.feedback();
  out.delays = task.delays;
  // A hand that is given no force gives way to none.
  if (out.feedback == Feedback::Both) {
    out.drawn_gain = (mean(stiff.ln_drawn) - mean(soft.ln_drawn)) / kGainReach;
  }
  return out;
}

std::optional<double> impression(const FeltInterval& felt, const Judgement& judgement) noexcept {
  if (judgement.feedback == Feedback::Depth) {
    return felt.ball_depth ? -*felt.ball_depth : kNoBall;
  }
  if (judgement.delays) return felt.lag;
  std::optional<double> by_hand;
  std::optional<double> by_eye;
  if (!felt.ln_slopes.empty()) by_hand = mean(felt.ln_slopes) / judgement.own_gain;
  if (!felt.ln_drawn.empty()) by_eye = mean(felt.ln_drawn) / judgement.drawn_gain;
  const double share = judgement.drawn_share(taps_of(felt));
  if (by_hand && by_eye) return std::lerp(*by_hand, *by_eye, share);
  if (by_hand && share < 1) return by_hand;
  return share > 0 ? by_eye : std::nullopt;
}

std::size_t chosen(const std::vector<FeltInterval>& felt,
                   const Task& task,
                   const Judgement& judgement,
                   std::uint64_t seed,
                   std::uint64_t stream) noexcept {
  const std::size_t all = choices(task);
  const double coin = random_uniform(seed, stream, kCoin) * static_cast<double>(all);
  const std::size_t guess = all - 1 - static_cast<std::size_t>(coin);
  if (random_uniform(seed, stream, kLapse) < judgement.lapse) return guess;
  std::vector<double> seems;
  for (const FeltInterval& one : felt) {
    const std::optional<double> left = impression(one, judgement);
    if (!left) return guess;
    const double noise = random_normal(seed, stream, kJudgements + seems.size());
    seems.push_back(*left + judgement.sd(taps_of(one)) * noise);
  }
  if (task.yes_no) {
    const double from = judgement.criterion * judgement.sd(taps_of(felt.front()));
    return seems.front() > judgement.plain + from ? 1 : 0;
  }
  const auto most = std::ranges::max_element(seems);
  if (std::ranges::count(seems, *most) > 1) return guess;
  if (!task.ranks) return static_cast<std::size_t>(most - seems.begin());
  const std::array<double, kRanked> three{seems[0], seems[1], seems[2]};
  const bool told = three[0] != three[1] && three[1] != three[2] && three[0] != three[2];
  return told ? order_of(three) : guess;
}

FeltSetting setting_of(
    const TrialAsk& ask, const Task& task, int taps, double depth_sd, std::uint64_t seed) {
  FeltSetting setting{.seed = seed};
  for (const Stimulus& one : stimuli_of(ask, task)) {
    setting.places.push_back({.ln_stiffness = one.level, .delay = one.delay});
  }
  for (std::size_t interval = 0; interval < setting.places.size(); ++interval) {
    setting.places[interval].depth = depths_drawn(taps, depth_sd, seed, interval);
  }
  return setting;
}

FeltTrial feel_trial(const FeltSession& session, const FeltSetting& setting, const Task& task) {
  FeltTrial felt = session.feel(setting);
  const bool bias = task.two_sided && !task.yes_no;
  if (bias) felt.intervals.front() = session.touch(setting).intervals.front();
  return felt;
}

double felt_plain(const FeltSession& session, const Judgement& judgement, std::uint64_t seed) {
  const Task task{.two_sided = true, .yes_no = true};
  if (judgement.feedback == Feedback::Depth) return kNoBall;
  double sum = 0;
  double count = 0;
  for (std::uint64_t i = 0; i < kPlainTouches; ++i) {
    const FeltTrial felt = session.feel(setting_of({.level = 0},
                                                   task,
                                                   session.taps(),
                                                   judgement.depth_sd,
                                                   random_bits(seed, kPlain, i) >> 16));
    const auto left = impression(felt.intervals.front(), judgement);
    sum += left.value_or(0);
    count += left ? 1 : 0;
  }
  return count > 0 ? sum / count : 0;
}

FeltSearch search(const FeltSession& session,
                  const SearchArea& area,
                  const TrialAsk& ask,
                  const Judgement& judgement,
                  std::uint64_t seed,
                  std::uint64_t stream) {
  const std::vector<Place> cells = raster_in_time(area, FeltSession::place_time(session.taps()));
  FeltSetting setting{.seed = seed, .hidden = HiddenBall{ask.level, ask.hidden}};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    setting.places.push_back(
        {.depth = depths_drawn(session.taps(), judgement.depth_sd, seed, i), .at = cells[i]});
  }
  FeltSearch out{.felt = session.feel(setting), .path = length_of(cells)};
  out.said = drawn_place(area, seed, kGuess, 0);
  if (random_uniform(seed, stream, kLapse) < judgement.lapse) return out;
  std::optional<double> most;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const FeltInterval& one = out.felt.intervals[i];
    const auto left = impression(one, judgement);
    if (!left) continue;
    const double seems =
        *left + judgement.sd(taps_of(one)) * random_normal(seed, stream, kJudgements + i);
    if (most && seems <= *most) continue;
    most = seems;
    out.said = cells[i];
  }
  return out;
}

FeltParticipants::FeltParticipants(const Study& study,
                                   const PeopleTraits& people,
                                   std::vector<FeltSession> sessions)
    : seed_{study.seed},
      task_{study.task},
      area_{study.search},
      people_{people},
      sessions_{std::move(sessions)} {
  for (const FeltSession& session : sessions_) {
    judgements_.push_back(judgement_for(session, study.task, people.weber, people.lapse));
    Judgement& judgement = judgements_.back();
    judgement.plain = task_.yes_no ? felt_plain(session, judgement, seed_) : 0;
  }
}

Result<FeltParticipants> FeltParticipants::make(const Study& study, const PeopleTraits& people) {
  const auto curves = LevelCurves::make(study);
  if (!curves) return tl::unexpected(curves.error());
  std::vector<FeltSession> sessions;
  for (const Condition& condition : study.conditions) {
    auto session = FeltSession::make(condition, *curves);
    if (!session) return tl::unexpected(session.error());
    sessions.push_back(std::move(*session));
  }
  return FeltParticipants{study, people, std::move(sessions)};
}

TrialOutcome FeltParticipants::answer(const TrialPlace& place, const TrialAsk& ask) const {
  const FeltSession& session = sessions_[place.condition];
  const std::uint64_t stream = trial_stream(place, ask.number);
  const double weber = std::expm1(std::exp(drawn_ln_jnd(people_, seed_, place.participant)));
  Judgement judgement = judgements_[place.condition];
  judgement.judgement_sd = judgement_of(weber, people_.lapse, 1).judgement_sd;
  judgement.criterion = drawn_criterion(seed_, place.participant);
  const std::uint64_t seed = random_bits(seed_, stream, kSession) >> 16;
  if (task_.places > 0) {
    const FeltSearch one = search(session, area_, ask, judgement, seed, stream);
    const double error = distance(one.said, ask.hidden);
    return {.chosen = error <= area_.within ? std::size_t{0} : 1,
            .onset = 0,
            .duration = one.felt.duration,
            .response_time = one.felt.duration,
            .taps = one.felt.taps,
            .force_max = one.felt.force_max,
            .contact = one.felt.contact,
            .error = error,
            .path = one.path,
            .force_mean = one.felt.force_mean};
  }
  const FeltSetting setting = setting_of(ask, task_, session.taps(), judgement.depth_sd, seed);
  const FeltTrial felt = feel_trial(session, setting, task_);
  const double response = drawn_response_time(seed_, place, ask.number);
  return {.chosen = chosen(felt.intervals, task_, judgement, seed_, stream),
          .onset = 0,
          .duration = felt.duration + response,
          .response_time = response,
          .taps = felt.taps,
          .force_max = felt.force_max,
          .contact = felt.contact};
}

}  // namespace palp::study
