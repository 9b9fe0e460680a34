#include "conformance/scene/nearest_name.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace edgecase::conformance {
namespace {

TEST(EditDistance, CountsSingleEdits) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "fan"), 3u);
  EXPECT_EQ(edit_distance("fan", "fan"), 0u);
  EXPECT_EQ(edit_distance("fan", "fans"), 1u);
  EXPECT_EQ(edit_distance("fn", "fan"), 1u);
  EXPECT_EQ(edit_distance("fin", "fan"), 1u);
  EXPECT_EQ(edit_distance("afn", "fan"), 1u);
  EXPECT_EQ(edit_distance("lavapipe", "softpipe"), 4u);
}

TEST(NearestName, ProposesOnlyWhatIsNear) {
  constexpr auto kNames = std::to_array<std::string_view>({"fan", "lavapipe", "softpipe"});
  EXPECT_EQ(nearest_name("lavapiep", kNames), "lavapipe");
  EXPECT_EQ(nearest_name("LAVAPIPE", kNames), std::nullopt);
  EXPECT_EQ(nearest_name("fn", kNames), "fan");
  EXPECT_EQ(nearest_name("triangle", kNames), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(100'000, 'f'), kNames), std::nullopt);
}

}  // namespace
}  // namespace edgecase::conformance
