#include "study/orders.h"

#include <set>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

TEST(OrdersTest, AreAllThereAreAndKnowTheirRanks) {
  std::set<std::string> names;
  for (std::size_t order = 0; order < kOrders.size(); ++order) {
    names.insert(order_name(order));
    for (std::size_t rank = 0; rank < kRanked; ++rank) {
      EXPECT_EQ(rank_in(order, kOrders[order][rank]), rank);
    }
  }
  EXPECT_EQ(names.size(), 6U);
  EXPECT_EQ(order_name(3), "2 3 1");
}

TEST(OrdersTest, ValuesRiseInTheirOrder) {
  for (std::size_t order = 0; order < kOrders.size(); ++order) {
    std::array<double, kRanked> values{};
    for (std::size_t i = 0; i < kRanked; ++i)
      values[i] = 0.3 + static_cast<double>(rank_in(order, i));
    EXPECT_EQ(order_of(values), order);
  }
}

// Symmetric, 1 for the same, -1 for the reverse; over all orders it is 0 on average.
TEST(OrdersTest, KendallsTauCountsPairs) {
  for (std::size_t one = 0; one < kOrders.size(); ++one) {
    double sum = 0;
    for (std::size_t other = 0; other < kOrders.size(); ++other) {
      EXPECT_DOUBLE_EQ(kendall_tau(one, other), kendall_tau(other, one));
      sum += kendall_tau(one, other);
    }
    EXPECT_DOUBLE_EQ(kendall_tau(one, one), 1);
    EXPECT_NEAR(sum, 0, 1e-12);
  }
  EXPECT_DOUBLE_EQ(kendall_tau(0, 5), -1);
  EXPECT_DOUBLE_EQ(kendall_tau(0, 1), 1.0 / 3);
}

}  // namespace
}  // namespace palp::study
