#include "common/core/place_text.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(PlaceTextTest, SitesHaveNamesOtherPlacesMillimetres) {
  EXPECT_EQ(place_text(kSiteA), "A");
  EXPECT_EQ(place_text(kSiteB), "B");
  EXPECT_EQ(place_text({0.09e-3, 0}), "A") << "a measured place is never exact";
  EXPECT_EQ(place_text({0.2e-3, 0}), "0.2,0");
  EXPECT_EQ(place_text({12.5e-3, -3e-3}), "12.5,-3");
  EXPECT_EQ(place_text({13e-3, -7.6e-10}), "13,0");
}

}  // namespace
}  // namespace palp
