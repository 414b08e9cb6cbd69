#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "netem/model/simulation.h"
#include "tests/netem/model/impairment_builders.h"

/// Goal: mode netem-6.1 does what Linux does. Method: each recorded case of reference/ is run in
/// virtual time from the words of its row, and its statistics are compared within four standard
/// errors of the difference of two samples, and 60 us for the path that the recording had.
namespace palp::netem {
namespace {

/// Our sample is longer, so that the test judges the engine and not our luck; the tolerances stay
/// those of two samples of the recording's size.
constexpr std::uint64_t kLonger = 5;
constexpr double kBoth = 2;

using Row = std::map<std::string, std::string>;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream{line};
  for (std::string field; std::getline(stream, field, ',');) {
    if (field.ends_with('\r')) field.pop_back();
    fields.push_back(field);
  }
  return fields;
}

std::vector<Row> read_table(const std::string& name) {
  std::ifstream file{std::string{PALP_NETEM_REFERENCE} + "/" + name};
  std::string line;
  std::getline(file, line);
  const auto header = fields_of(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const auto fields = fields_of(line);
    Row row;
    for (std::size_t i = 0; i < header.size() && i < fields.size(); ++i) row[header[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

double number(const Row& row, const std::string& key) { return std::stod(row.at(key)); }

struct Seen {
  std::vector<double> delay_us;  ///< of originals that arrived, as sent
  double sent{};
  double lost{};
  double loss_runs{};
  double loss_after_loss{};
  double duplicates{};
  double corrupted{};
  double reordered{};
  double reorder_link{};  ///< how reordering hangs together from one to the next
  double immediate{};
  double slots{};
};

struct Case {
  Row row;
  Row quantiles;
  [[nodiscard]] std::string name() const { return row.at("case"); }
  [[nodiscard]] std::string words() const {
    const std::string& words = row.at("netem_args");
    return words + (words.find("limit") == std::string::npos ? " limit 100000" : "");
  }
};

std::vector<Decision> decisions_of(const Case& one) {
  std::vector<Decision> decisions;
  const PathPlan plan{.impairment = *parse_impairment(one.words(), Mode::Netem61)};
  const auto length = static_cast<std::size_t>(number(one.row, "payload_bytes"));
  ImpairedPath impaired_path{plan, 61, Direction::Up, 200'000, 200'000, TimePoint{}};
  DecisionOrder order{[&](const Decision& decision) { decisions.push_back(decision); }};
  const auto sent = kLonger * static_cast<std::uint64_t>(number(one.row, "sent"));
  const auto burst = static_cast<std::uint64_t>(number(one.row, "burst"));
  const auto period = std::chrono::microseconds{static_cast<int>(number(one.row, "period_us"))};
  const auto collect = [&](TimePoint now) {
    while (const auto left = impaired_path.pop(now)) {
      if (left->open) order.left(*left);
    }
  };
  for (std::uint64_t k = 0; k < sent; ++k) {
    const TimePoint at{period * static_cast<std::int64_t>(k / burst * burst)};
    const auto decided = impaired_path.push({.at = at, .length = length, .room = 200'000});
    order.decided(decided);
    collect(at);
  }
  collect(TimePoint::max());
  return decisions;
}

Seen seen_in(const std::vector<Decision>& decisions) {
  Seen seen;
  bool lost_before = false;
  std::vector<std::pair<TimePoint, std::uint64_t>> arrivals;
  std::vector<TimePoint> leaves;
  for (const Decision& decision : decisions) {
    const bool arrived = decision.verdict == Verdict::Delivered;
    if (decision.copy > 0) {
      seen.duplicates += arrived ? 1 : 0;
      continue;
    }
    seen.sent += 1;
    if (arrived) {
      const Duration delay = decision.released_at - decision.arrived_at;
      seen.delay_us.push_back(static_cast<double>(delay.count()) * 1e-3);
      seen.corrupted += decision.flipped_bit >= 0 ? 1 : 0;
      seen.immediate += delay < std::chrono::milliseconds{1} ? 1 : 0;
      arrivals.emplace_back(decision.released_at, decision.index);
      leaves.push_back(decision.released_at);
    } else {
      seen.lost += 1;
      seen.loss_runs += lost_before ? 0 : 1;
      seen.loss_after_loss += lost_before ? 1 : 0;
    }
    lost_before = !arrived;
  }
  std::sort(arrivals.begin(), arrivals.end());
  std::uint64_t next = 0;
  bool before = false;
  double again = 0;
  for (const auto& [at, index] : arrivals) {
    const bool late = index < next;
    seen.reordered += late ? 1 : 0;
    again += late && before ? 1 : 0;
    before = late;
    next = std::max(next, index + 1);
  }
  const double share = seen.reordered / static_cast<double>(arrivals.size());
  if (seen.reordered > 0 && share < 1) {
    seen.reorder_link = std::max((again / seen.reordered - share) / (1 - share), 0.0);
  }
  std::sort(leaves.begin(), leaves.end());
  seen.slots = static_cast<double>(std::unique(leaves.begin(), leaves.end()) - leaves.begin());
  return seen;
}

/// A share seen in `n` trials whose outcomes hang together by `c` from one to the next.
double share_error(double p, double n, double c = 0) {
  return std::sqrt(std::max(p * (1 - p), 1 / n) / n * (1 + c) / (1 - c));
}

void expect_share(const std::string& what, double ours, double theirs, double n, double c = 0) {
  const double error = std::sqrt(kBoth) * share_error(theirs, n, c);
  EXPECT_NEAR(ours, theirs, 4 * error) << what;
}

void compare_losses(const Case& one, const Seen& ours) {
  const double n = number(one.row, "sent");
  const double p = number(one.row, "loss_rate");
  if (p == 0) {
    EXPECT_EQ(ours.lost, 0);
    return;
  }
  const double again = number(one.row, "p_loss_given_loss");
  const double c = std::max((again - p) / (1 - p), 0.0);
  expect_share("loss rate", ours.lost / ours.sent, p, n, c);
  // The losses of s18 are headers that were hit, without runs. Those of s22 come in runs that hang
  // on microseconds: whether a datagram is faster than the timer that makes room for it.
  if (one.name() == "s18_corrupt3" || one.name() == "s22_limit20") return;
  const double losses = p * n;
  expect_share("loss after loss", ours.loss_after_loss / ours.lost, again, losses);
  // A mean of runs of length 1/(1-q) with the spread sqrt(q)/(1-q) of geometric ones.
  const double runs = losses / number(one.row, "mean_loss_run");
  const double spread = std::sqrt(again) / (1 - again);
  EXPECT_NEAR(ours.lost / ours.loss_runs,
              number(one.row, "mean_loss_run"),
              4 * spread * std::sqrt(kBoth / runs));
}

double quantile(const std::vector<double>& sorted, double q) {
  const double rank = q * static_cast<double>(sorted.size() - 1);
  const auto cell = std::min(static_cast<std::size_t>(rank), sorted.size() - 2);
  return sorted[cell] + (rank - static_cast<double>(cell)) * (sorted[cell + 1] - sorted[cell]);
}

void compare_quantiles(const Case& one, const Seen& ours, double jitter_us) {
  std::vector<double> sorted = ours.delay_us;
  std::sort(sorted.begin(), sorted.end());
  const std::map<std::string, std::array<const char*, 2>> neighbours{
      {"q0.01", {"q0.005", "q0.025"}},
      {"q0.05", {"q0.025", "q0.1"}},
      {"q0.1", {"q0.05", "q0.2"}},
      {"q0.25", {"q0.2", "q0.3"}},
      {"q0.5", {"q0.4", "q0.6"}},
      {"q0.75", {"q0.7", "q0.8"}},
      {"q0.9", {"q0.8", "q0.95"}},
      {"q0.95", {"q0.9", "q0.975"}},
      {"q0.99", {"q0.975", "q0.995"}}};
  const bool slots = one.name() == "s21_slot5_10";
  const double n = slots ? ours.slots / kLonger : number(one.row, "received");
  // In s21 up to ten leave together and all of them pass the recording's kernel before its receiver
  // wakes: its own least delay, above the 5 ms of the law, tells what that path takes.
  const double path = slots ? number(one.quantiles, "q0") - 5000 : 0;
  for (const auto& [name, beside] : neighbours) {
    const double q = std::stod(name.substr(1));
    const double width =
        std::stod(std::string{beside[1]}.substr(1)) - std::stod(std::string{beside[0]}.substr(1));
    const double slope =
        (number(one.quantiles, beside[1]) - number(one.quantiles, beside[0])) / width;
    const double error = std::sqrt(kBoth * q * (1 - q) / n) * slope;
    EXPECT_NEAR(quantile(sorted, q),
                number(one.quantiles, name) - path,
                std::max({3 * error, 0.01 * jitter_us, 60.0}))
        << one.name() << " quantile " << name;
  }
}

double autocorrelation(const std::vector<double>& values, std::size_t lag) {
  double mean = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double variance = 0;
  double product = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    variance += (values[i] - mean) * (values[i] - mean);
    if (i >= lag) product += (values[i] - mean) * (values[i - lag] - mean);
  }
  return product / variance;
}

void compare_autocorrelation(const Case& one, const Seen& ours) {
  const int number_of_case = std::stoi(one.name().substr(1, 2));
  const bool jitter = number_of_case >= 2 && number_of_case <= 8;
  if (!jitter && number_of_case != 9 && number_of_case != 21) return;
  const double tolerance = jitter                ? 4 * std::sqrt(kBoth / number(one.row, "sent"))
                           : number_of_case == 9 ? 0.05
                                                 : 0.1;
  for (const std::size_t lag : {1U, 2U, 3U, 5U, 10U}) {
    EXPECT_NEAR(autocorrelation(ours.delay_us, lag),
                number(one.row, "acf" + std::to_string(lag)),
                tolerance)
        << one.name() << " lag " << lag;
  }
}

class NetemReferenceTest : public ::testing::TestWithParam<Case> {};

TEST_P(NetemReferenceTest, DoesWhatLinuxDid) {
  const Case& one = GetParam();
  if (!parse_impairment(one.words(), Mode::Netem61) &&
      one.words().find("experimental") != std::string::npos) {
    GTEST_SKIP() << "experimental.dist of the Debian package iproute2 is not installed";
  }
  const Seen ours = seen_in(decisions_of(one));
  const double n = number(one.row, "sent");
  EXPECT_EQ(ours.sent, kLonger * n);
  compare_losses(one, ours);
  expect_share("duplicates", ours.duplicates / ours.sent, number(one.row, "duplicates") / n, n);
  expect_share("corrupted", ours.corrupted / ours.sent, number(one.row, "corrupted") / n, n);
  expect_share("reordered",
               ours.reordered / static_cast<double>(ours.delay_us.size()),
               number(one.row, "reorder_rate"),
               number(one.row, "received"),
               ours.reorder_link);
  const int which = std::stoi(one.name().substr(1, 2));
  if (which == 9)
    expect_share("immediate", ours.immediate / ours.sent, number(one.row, "immediate_rate"), n);
  if (which <= 10 || (which >= 19 && which <= 22)) {
    compare_quantiles(one, ours, which >= 2 && which <= 8 ? 10'000 : 0);
  }
  compare_autocorrelation(one, ours);
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto quantiles = read_table("quantiles_us.csv");
  for (const Row& row : read_table("summary.csv")) {
    const auto same = std::find_if(quantiles.begin(), quantiles.end(), [&](const Row& other) {
      return other.at("case") == row.at("case");
    });
    all.push_back({row, same == quantiles.end() ? Row{} : *same});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Recorded,
                         NetemReferenceTest,
                         ::testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name(); });

TEST(NetemReferenceTest, GilbertElliottLosesByTheStateBeforeTheStep) {
  const PathPlan plan{.impairment = *parse_impairment("loss gemodel 100% 100%", Mode::Netem61)};
  std::vector<Verdict> verdicts;
  (void)simulate({.plan = plan, .packets = 4},
                 [&](const Decision& decision) { verdicts.push_back(decision.verdict); });
  EXPECT_EQ(verdicts,
            (std::vector{Verdict::Delivered, Verdict::Lost, Verdict::Delivered, Verdict::Lost}));
}

TEST(NetemReferenceTest, SpacesABurstExactlyByItsLengthOnTheLine) {
  for (const auto& [words, step] :
       {std::pair{"delay 10ms rate 2mbit", std::chrono::microseconds{568}},
        std::pair{"delay 10ms rate 2mbit 20 48 5", std::chrono::microseconds{848}}}) {
    const PathPlan plan{.impairment = *parse_impairment(words, Mode::Netem61)};
    std::vector<TimePoint> leaves;
    (void)simulate({.plan = plan,
                    .packets = 100,
                    .interval = std::chrono::milliseconds{1},
                    .burst = 10,
                    .frame_length = 142},
                   [&](const Decision& decision) { leaves.push_back(decision.released_at); });
    for (std::size_t k = 0; k < leaves.size(); ++k) {
      const auto burst = static_cast<std::int64_t>(k / 10);
      const auto place = static_cast<std::int64_t>(k % 10) + 1;
      EXPECT_EQ(leaves[k], TimePoint{std::chrono::milliseconds{10 * burst + 10} + place * step});
    }
  }
}

}  // namespace
}  // namespace palp::netem
