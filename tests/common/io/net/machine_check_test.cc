#include "common/io/net/machine_check.h"

#include <gtest/gtest.h>

namespace palp::io {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

MachineFacts good_machine() {
  MachineFacts facts;
  facts.loop.ticks = 5000;
  facts.loop.lateness_p99 = 12us;
  facts.loop.lateness_max = 90us;
  facts.loop.grant = {.priority = 80, .memory_locked = true, .scheduling = "", .memory = ""};
  facts.clock_source = "tsc";
  facts.governor = "performance";
  facts.processors = 4;
  facts.receive_buffer = facts.receive_buffer_want = 4 << 20;
  return facts;
}

/// What is to be changed.
std::vector<std::string> wrong_with(const MachineFacts& facts) {
  std::vector<std::string> wrong;
  for (const MachineFinding& one : judge_machine(facts, 1ms)) {
    EXPECT_EQ(one.good, one.advice.empty()) << one.what;
    if (!one.good) wrong.push_back(one.what);
  }
  return wrong;
}

using Names = std::vector<std::string>;

TEST(MachineCheckTest, AGoodMachineNeedsNoChange) {
  EXPECT_EQ(wrong_with(good_machine()), Names{});
  MachineFacts silent = good_machine();
  silent.governor.clear();  // virtual machines have none
  silent.clock_source.clear();
  EXPECT_EQ(wrong_with(silent), Names{});
}

TEST(MachineCheckTest, EachFaultIsFoundAloneWithItsAdvice) {
  const auto with = [](auto change) {
    MachineFacts facts = good_machine();
    change(facts);
    return wrong_with(facts);
  };
  EXPECT_EQ(with([](MachineFacts& f) { f.loop.grant.priority = 0; }), Names{"scheduler rights"});
  EXPECT_EQ(with([](MachineFacts& f) { f.loop.grant.memory_locked = false; }),
            Names{"memory lock"});
  EXPECT_EQ(with([](MachineFacts& f) { f.loop.lateness_p99 = 101us; }), Names{"timer lateness"});
  EXPECT_EQ(with([](MachineFacts& f) { f.loop.missed = 6; }), Names{"timer lateness"});
  EXPECT_EQ(with([](MachineFacts& f) { f.loop.ticks = 0; }), Names{"timer lateness"});
  EXPECT_EQ(with([](MachineFacts& f) { f.clock_source = "hpet"; }), Names{"clock"});
  EXPECT_EQ(with([](MachineFacts& f) { f.governor = "powersave"; }), Names{"processor frequency"});
  EXPECT_EQ(with([](MachineFacts& f) { f.processors = 1; }), Names{"processors"});
  EXPECT_EQ(with([](MachineFacts& f) { f.receive_buffer = 212'992; }), Names{"socket buffer"});
}

TEST(MachineCheckTest, ReadsThisMachine) {
  const MachineFacts facts = read_machine({.period = 1ms}, 50ms);
  EXPECT_GT(facts.loop.ticks, 0U);
  EXPECT_GE(facts.processors, 1);
  EXPECT_GT(facts.receive_buffer, 0);
}

}  // namespace
}  // namespace palp::io
