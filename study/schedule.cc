#include "study/schedule.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/config/json.h"
#include "common/core/conventions.h"
#include "common/core/random.h"
#include "study/williams.h"

namespace palp::study {
namespace {

using config::Json;

constexpr std::size_t kRunMax = 4;
constexpr std::size_t kDecoys = 4;

// Streams of one study: some for all, then kStreams for each block of each participant.
constexpr std::uint64_t kBlocks = 16;
constexpr std::uint64_t kStreams = 16;
constexpr std::uint64_t kSides = 0;
constexpr std::uint64_t kPracticeSides = 1;
constexpr std::uint64_t kTracks = 2;
constexpr std::uint64_t kCatches = 3;
constexpr std::uint64_t kPlaces = 4;
constexpr std::uint64_t kLevels = 5;
constexpr std::uint64_t kHidden = 6;

std::uint64_t stream_of(std::size_t participant, std::size_t condition, std::uint64_t what) {
  return kBlocks + (participant * kConditionsMax + condition) * kStreams + what;
}

/// Which of the slots are catch trials: one in each equal stretch.
std::vector<bool> catches(const Study& study, std::uint64_t stream) {
  const auto count =
      static_cast<std::size_t>(std::lround(study.catch_share * static_cast<double>(study.trials)));
  const std::size_t all = study.trials + count;
  std::vector<bool> out(all);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * all / count;
    const std::size_t to = (i + 1) * all / count;
    const double share = random_uniform(study.seed, stream, i);
    out[from + static_cast<std::size_t>(share * static_cast<double>(to - from))] = true;
  }
  return out;
}

/// The tracks take turns in rounds, each of which has an order of its own.
std::size_t track_of(const Study& study, std::size_t trial, std::uint64_t stream) {
  const std::size_t round = trial / study.tracks;
  return drawn_order(study.tracks, random_bits(study.seed, stream, round), 0)[trial % study.tracks];
}

/// The kind but `other` of which most are left.
std::size_t most_left(const std::vector<std::size_t>& left, std::size_t other) {
  std::size_t most = other == 0 ? 1 : 0;
  for (std::size_t kind = 0; kind < left.size(); ++kind) {
    if (kind != other && left[kind] > left[most]) most = kind;
  }
  return most;
}

/// The kind at `place` [-] of all that are left, put in a row from the last kind to the first.
std::size_t drawn_kind(const std::vector<std::size_t>& left, double place) {
  std::size_t kind = left.size() - 1;
  for (; kind > 0 && place >= static_cast<double>(left[kind]); --kind) {
    place -= static_cast<double>(left[kind]);
  }
  return left[kind] > 0 ? kind : most_left(left, kind);
}

/// `drawn`: evenly, below the number of answers.
std::size_t stronger_of(const Task& task, TrialKind kind, std::size_t drawn) noexcept {
  if (task.places > 0) return 0;
  // A catch trial of "is there something?" always has something, or it were not easy.
  return task.yes_no && kind == TrialKind::Catch ? 1 : drawn;
}

Json slots_json(const std::vector<Slot>& slots, bool searches) {
  Json out = Json::array();
  for (const Slot& slot : slots) {
    Json one{{"type", to_string(slot.kind)},
             {"track", slot.track},
             {"interval", slot.stronger + 1},
             {"decoy", slot.decoy}};
    if (searches) {
      one["x_mm"] = slot.hidden.x / kMillimetre;
      one["y_mm"] = slot.hidden.y / kMillimetre;
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

std::vector<std::size_t> drawn_order(std::size_t count, std::uint64_t seed, std::uint64_t stream) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return random_bits(seed, stream, i); });
  return order;
}

std::vector<std::size_t> balanced_draw(std::size_t count,
                                       std::size_t kinds,
                                       std::uint64_t seed,
                                       std::uint64_t stream) {
  // Never a longer run than allowed, and never so many left of one that they could not be placed.
  std::vector<std::size_t> left(kinds, count / kinds);
  const std::size_t more = random_bits(seed, stream, count) % kinds;
  for (std::size_t i = 0; i < count % kinds; ++i) ++left[(more + i) % kinds];
  std::vector<std::size_t> out;
  std::size_t run = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t all = count - i;
    std::size_t one = drawn_kind(left, random_uniform(seed, stream, i) * static_cast<double>(all));
    for (std::size_t wanted = 0; wanted < kinds; ++wanted) {
      // Another one now, and what is left of `wanted` would not fit between what is left of those.
      if (left[wanted] > kRunMax * (all - left[wanted])) one = wanted;
    }
    if (!out.empty() && run == kRunMax && out.back() == one) one = most_left(left, one);
    run = !out.empty() && out.back() == one ? run + 1 : 1;
    --left[one];
    out.push_back(one);
  }
  return out;
}

std::vector<BlockPlan> participant_plan(const Study& study, std::size_t participant) {
  const auto square = williams_square(study.conditions.size());
  const std::size_t answers = choices(study.task);
  std::vector<BlockPlan> blocks;
  for (const std::size_t condition : square[participant % square.size()]) {
    const auto stream = [&](std::uint64_t what) { return stream_of(participant, condition, what); };
    const auto decoy = [&](std::size_t i) {
      return static_cast<std::size_t>(random_bits(study.seed, stream(kPlaces), i) % kDecoys);
    };
    const auto hidden = [&](std::size_t i) {
      return drawn_place(study.search, study.seed, stream(kHidden), 2 * i);
    };
    BlockPlan block{.condition = condition, .stream = stream(kLevels)};
    const std::vector<bool> is_catch = catches(study, stream(kCatches));
    const auto sides = balanced_draw(is_catch.size(), answers, study.seed, stream(kSides));
    std::size_t trial = 0;
    for (std::size_t i = 0; i < is_catch.size(); ++i) {
      const TrialKind kind = is_catch[i] ? TrialKind::Catch : TrialKind::Trial;
      const std::size_t track = is_catch[i] ? 0 : track_of(study, trial++, stream(kTracks));
      block.trials.push_back(
          {kind, track, stronger_of(study.task, kind, sides[i]), decoy(i), hidden(i)});
    }
    const std::size_t practice = study.practice.right > 0 ? study.practice.trials_max : 0;
    const auto others = balanced_draw(practice, answers, study.seed, stream(kPracticeSides));
    for (std::size_t i = 0; i < practice; ++i) {
      const std::size_t at = is_catch.size() + i;
      block.practice.push_back({TrialKind::Practice,
                                0,
                                stronger_of(study.task, TrialKind::Practice, others[i]),
                                decoy(at),
                                hidden(at)});
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::string condition_code(std::size_t condition) {
  return std::string(1, static_cast<char>('A' + condition));
}

std::string schedule_text(const Study& study) {
  Json out{{"schema", "palp.study_schedule/1"}, {"study", study.name}, {"seed", study.seed}};
  const bool searches = study.task.places > 0;
  out["participants"] = Json::array();
  for (std::size_t p = 0; p < study.participants; ++p) {
    Json blocks = Json::array();
    for (const BlockPlan& block : participant_plan(study, p)) {
      blocks.push_back(Json{{"condition", condition_code(block.condition)},
                            {"practice", slots_json(block.practice, searches)},
                            {"trials", slots_json(block.trials, searches)}});
    }
    out["participants"].push_back(std::move(blocks));
  }
  return out.dump() + "\n";
}

}  // namespace palp::study
