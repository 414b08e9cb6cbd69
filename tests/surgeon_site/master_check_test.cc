// A person and a paddle, both of them in memory: each answer is a deed at the paddle.
#include "surgeon_site/master_check.h"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "surgeon_site/devices/firmware/paddle/paddle_report.h"
#include "surgeon_site/settings_devices.h"
#include "tests/surgeon_site/devices/hid_bench.h"

namespace palp::surgeon {
namespace {

using fake_hid::Bytes;

/// Reads one answer after the other; `done` is called with the number of each before it is given.
class Deeds final : public std::streambuf {
 public:
  Deeds(std::vector<std::string> answers, std::function<void(std::size_t)> done)
      : answers_{std::move(answers)}, done_{std::move(done)} {}

 protected:
  int_type underflow() override {
    if (next_ == answers_.size()) return traits_type::eof();
    done_(next_);
    line_ = answers_[next_++] + "\n";
    setg(line_.data(), line_.data(), line_.data() + line_.size());
    return traits_type::to_int_type(line_[0]);
  }

 private:
  std::vector<std::string> answers_;
  std::function<void(std::size_t)> done_;
  std::size_t next_{};
  std::string line_;
};

/// A paddle whose handle is where `place` has it, or where its motor pushes it: [m], + into the
/// tissue.
class PaddleWorld {
 public:
  PaddleWorld() {
    fake_hid::Device made;
    made.path = "paddle";
    made.vendor = 0x16C0;
    made.product = 0x0486;
    made.usage_page = 0xFFAB;
    raw = &fake_hid::plug(made);
    raw->on_write = [this](const Bytes& bytes) {
      palp_paddle::Command command{};
      if (palp_paddle::unpack(bytes.data() + 1, bytes.size() - 1, command)) {
        force = command.force_un * 1e-6 * motor;
        strongest = std::max(strongest, std::abs(force));
      }
    };
  }
  ~PaddleWorld() { fake_hid::clear(); }
  PaddleWorld(const PaddleWorld&) = delete;
  PaddleWorld& operator=(const PaddleWorld&) = delete;

  void pass(Duration span) {
    clock.at += span;
    waited_ = force == pushed_ ? waited_ + 1 : 0;
    pushed_ = force;
    if (waited_ >= 7 && !held) slipped_ -= force * slip;  // it takes a while until it moves
    palp_paddle::State state{};
    state.sequence = ++sequence_;
    state.flags = palp_paddle::kStateCalibrated;
    state.position_nm = static_cast<std::int32_t>(std::lround((place + slipped_) * sense * 1e9));
    Bytes bytes(palp_paddle::kReportBytes);
    palp_paddle::pack(state, bytes.data());
    raw->input.push_back(bytes);
  }
  Result<MasterPlan> check(const std::vector<std::string>& answers) {
    Deeds deeds{answers, [this](std::size_t number) {
                  constexpr std::array<double, 7> kPlaces{0.0, 0.0, 0.02, 0.01, -0.03, 0.025, 0};
                  if (number < kPlaces.size()) place = kPlaces[number];
                  held = number >= kPlaces.size();  // by a scale
                }};
    std::istream in{&deeds};
    const auto plan = make_master_plan(*master_named("paddle"), "", "hand");
    io::HidPort port{addresses_of(MasterKind::Paddle)[0]};
    site_program::Dialogue talk{in, out};
    return MasterCheck{*plan, port, clock, [this](Duration span) { pass(span); }, talk}.run();
  }

  [[nodiscard]] double reached() const { return place + slipped_; }  ///< [m], by its motor

  TurnedClock clock;
  fake_hid::Device* raw{};
  std::ostringstream out;
  double place{};
  double sense{1};    ///< of its counts, against its place
  double motor{1};    ///< -1: wired the wrong way
  double slip{2e-5};  ///< [m/N], in each millisecond
  bool held{};
  double force{};  ///< [N]
  double strongest{};

 private:
  std::uint16_t sequence_{};
  double pushed_{};
  int waited_{};
  double slipped_{};
};

const std::vector<std::string> kAnswers{"", "", "20", "", "", "", "yes", "yes", "1.8"};

TEST(MasterCheckTest, FindsScaleZeroLimitsLatencyAndForce) {
  PaddleWorld world;
  const auto found = world.check(kAnswers);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_DOUBLE_EQ(found->installation.position_unit, 1e-9) << "as it was";
  EXPECT_NEAR(found->installation.zero, 0.01, 1e-6);
  EXPECT_NEAR(found->installation.travel_min, -0.041, 1e-4);
  EXPECT_NEAR(found->installation.travel_max, 0.016, 1e-4);
  EXPECT_NEAR(found->installation.force_unit, 2e-6, 1e-9) << "twice of the 0.9 N that were asked";
  EXPECT_FALSE(found->installation.reversed);
  EXPECT_FALSE(found->installation.force_reversed);
  EXPECT_NEAR(found->facts.lag, 0.016, 0.006);
  EXPECT_LE(world.strongest, 0.9 + 1e-6) << "30 % of its 3 N";
  EXPECT_EQ(world.force, 0);
}

TEST(MasterCheckTest, FindsWhatIsTheWrongWayRound) {
  PaddleWorld world;
  world.sense = -0.5;
  world.motor = -1;
  const auto found = world.check(kAnswers);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_TRUE(found->installation.reversed);
  EXPECT_TRUE(found->installation.force_reversed);
  EXPECT_NEAR(found->installation.position_unit, 2e-9, 1e-13);
  EXPECT_NEAR(found->installation.zero, -0.01, 1e-6) << "as it reads there, in its new unit";
  const auto text = calibrated_text("master { pedal_button: 3 }", "hand", *found);
  ASSERT_TRUE(text) << text.error().text;
  EXPECT_TRUE(text->starts_with("# Written by a program, from hand. Comments")) << *text;
  const auto again = make_master_plan(*master_named("paddle"), *text, "written");
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(again->pedal_button, 3);
  EXPECT_NEAR(again->installation.position_unit, 2e-9, 1e-13);
  EXPECT_NEAR(again->installation.travel_max, found->installation.travel_max, 1e-6);
  EXPECT_TRUE(again->installation.force_reversed);
}

TEST(MasterCheckTest, NothingMovesWithoutAYesAndAMotorThatDoesNothingIsTold) {
  {
    PaddleWorld world;
    EXPECT_EQ(world.check({"", "", "20", "", "", "", "no"}).error().text,
              "the force was not tried: without that it is not calibrated");
    EXPECT_EQ(world.strongest, 0);
  }
  PaddleWorld dead;
  dead.motor = 0;
  EXPECT_EQ(dead.check(kAnswers).error().text,
            "it did not move: no power, too little force, or a false scale of it");
}

TEST(MasterCheckTest, ItsMotorPushesNobodyBeyondTheLimitsThatWereFound) {
  PaddleWorld world;
  world.slip = 4e-4;  // [m/N], 58 mm in a push of half a second
  const auto found = world.check(kAnswers);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().text, "the position is outside its travel");
  EXPECT_EQ(world.force, 0);
  EXPECT_GT(world.reached(), -0.032);
}

TEST(MasterCheckTest, ThatNobodyAnswersAndThatItIsAbsentAreTold) {
  PaddleWorld world;
  EXPECT_EQ(world.check({""}).error().text, "nobody answered: the check was left");
  world.raw->there = false;
  EXPECT_EQ(world.check({""}).error().text, "it is not ready: cannot be opened");
}

}  // namespace
}  // namespace palp::surgeon
