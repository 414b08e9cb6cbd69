#include "common/io/net/link_update_desk.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/link/codec_wire.h"

namespace palp::io {
namespace {

using std::chrono::milliseconds;

/// Writes down on which thread it was destroyed.
class TracedWay final : public link::Transport {
 public:
  explicit TracedWay(std::vector<std::thread::id>& freed_on) : freed_on_{freed_on} {}
  ~TracedWay() override { freed_on_.push_back(std::this_thread::get_id()); }
  bool send(std::span<const std::byte> /*datagram*/, TimePoint /*now*/) noexcept override {
    return true;
  }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> /*buffer*/,
                                        TimePoint /*now*/) noexcept override {
    return std::nullopt;
  }

 private:
  std::vector<std::thread::id>& freed_on_;
};

class LinkUpdateDeskTest : public testing::Test {
 protected:
  link::LinkUpdate session(std::uint64_t id) {
    return {.transport = std::make_unique<TracedWay>(freed_on_),
            .protection = std::make_unique<link::PlainProtection>(),
            .send_connection = 1,
            .receive_connection = 2,
            .session_id = id};
  }
  /// `ticks` of a thread that plays rt.
  void serve(int ticks) {
    std::jthread{[&] {
      for (int i = 0; i < ticks; ++i) {
        desk_.serve(link_, now_ += milliseconds{1});
      }
    }}.join();
  }

  std::vector<std::thread::id> freed_on_;
  TimePoint now_{milliseconds{1000}};
  LinkUpdateDesk desk_;
  link::Link link_{{}, std::make_unique<link::WireCodec>()};
};

TEST_F(LinkUpdateDeskTest, WhatWasReplacedIsFreedByIoOnly) {
  ASSERT_TRUE(desk_.offer(session(11)));
  ASSERT_TRUE(desk_.offer(session(12)));
  ASSERT_TRUE(desk_.offer({}));
  serve(5);
  EXPECT_TRUE(freed_on_.empty());
  desk_.destroy_retired();
  ASSERT_EQ(freed_on_.size(), 2U);
  EXPECT_EQ(freed_on_[0], std::this_thread::get_id());
  EXPECT_EQ(freed_on_[1], std::this_thread::get_id());
}

TEST_F(LinkUpdateDeskTest, RtFreesNothingEvenIfIoNeverClearsTheWayBack) {
  std::uint64_t id = 100;
  for (int round = 0; round < 10; ++round) {
    for (link::LinkUpdate next = session(id); desk_.offer(std::move(next)); next = session(id)) {
      ++id;
    }
    freed_on_.clear();  // the one refused was ours
    serve(20);
    EXPECT_TRUE(freed_on_.empty());
  }
  desk_.destroy_retired();
  serve(20);
  desk_.destroy_retired();
  EXPECT_FALSE(freed_on_.empty());
  for (const std::thread::id freed : freed_on_) {
    EXPECT_EQ(freed, std::this_thread::get_id());
  }
}

TEST_F(LinkUpdateDeskTest, RefusedOfferIsLeftAsItWas) {
  std::uint64_t id = 100;
  link::LinkUpdate next = session(id);
  while (desk_.offer(std::move(next))) {
    next = session(++id);
    ASSERT_LT(id, 1000U);
  }
  EXPECT_NE(next.transport, nullptr);  // NOLINT(bugprone-use-after-move): what is tested
  EXPECT_NE(next.protection, nullptr);
}

TEST_F(LinkUpdateDeskTest, TellsIoWhichSessionTheLinkIsIn) {
  serve(1);
  EXPECT_EQ(desk_.link().session_id, 0U);
  EXPECT_EQ(desk_.link().state, LinkState::Down);
  ASSERT_TRUE(desk_.offer(session(11)));
  serve(1);
  EXPECT_EQ(desk_.link().session_id, 11U);
  ASSERT_TRUE(desk_.offer({}));
  serve(1);
  EXPECT_EQ(desk_.link().session_id, 0U);
}

}  // namespace
}  // namespace palp::io
