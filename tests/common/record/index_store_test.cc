#include "common/record/index_store.h"

#include <gtest/gtest.h>

namespace palp::record {
namespace {

TEST(IndexStoreTest, GivesBackInOrderWhatItTookAndKeepsLittleOfIt) {
  IndexStore store{true};
  Bytes expected;
  for (std::uint32_t k = 0; k < 100'000; ++k) {
    append(store.newest(), k);
    store.settle();
    append(expected, k);
    ASSERT_LE(store.newest().size(), IndexStore::kKept);
  }
  EXPECT_GE(store.laid_down() + IndexStore::kKept, expected.size());
  EXPECT_EQ(store.all(), expected);
}

TEST(IndexStoreTest, WithoutAFileItKeepsEverything) {
  IndexStore store{false};
  for (std::uint32_t k = 0; k < 100'000; ++k) {
    append(store.newest(), k);
    store.settle();
  }
  EXPECT_EQ(store.laid_down(), 0U);
  EXPECT_EQ(store.all().size(), 400'000U);
}

}  // namespace
}  // namespace palp::record
