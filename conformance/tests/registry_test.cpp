#include "conformance/subjects/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/edgecase_subject.h"

namespace edgecase::conformance {
namespace {

TEST(StandardSamples, EachCountHasThatManyDistinctLocations) {
  for (const int count : {1, 2, 4, 8, 16}) {
    const auto locations = standard_sample_locations(count);
    ASSERT_EQ(locations.size(), static_cast<std::size_t>(count));
    std::vector<int> seen;
    for (const SampleLocation at : locations) seen.push_back(at.y * 16 + at.x);
    std::ranges::sort(seen);
    EXPECT_EQ(std::ranges::adjacent_find(seen), seen.end());
    EXPECT_TRUE(has_standard_samples({{1, 1}, {locations.begin(), locations.end()}}));
  }
  EXPECT_TRUE(standard_sample_locations(3).empty());
  EXPECT_FALSE(has_standard_samples({{1, 1}, {{8, 7}}}));
  EXPECT_FALSE(has_standard_samples({{1, 1}, {}}));
}

std::string error_of(const std::string& name) {
  const auto made = make_subject(name);
  EXPECT_FALSE(made) << name;
  if (made) return "";
  EXPECT_EQ(made.error().kind, ErrorKind::bad_input);
  return made.error().message;
}

TEST(Registry, NamesTheNearestOfAnUnknownSubject) {
  EXPECT_EQ(error_of("lavapip"), "unknown subject \"lavapip\"; the nearest is \"lavapipe\"");
  EXPECT_EQ(error_of("edgecase:scaler"), "unknown subject \"edgecase:scaler\"; the nearest is \"edgecase:scalar\"");
  EXPECT_EQ(error_of("what is this"),
            "unknown subject \"what is this\"; \"edgecase list subjects\" names those there are");
  for (const char* name : {"", "vulkan:", "edgecase:", "fault:", "fault"}) error_of(name);
}

TEST(Registry, EveryListedSubjectIsMadeUnderItsName) {
  std::vector<std::string> names;
  for (const SubjectName& subject : subject_names()) {
    EXPECT_FALSE(subject.about.empty());
    if (subject.name == "vulkan:DEVICE-OR-ICD") continue;
    const auto made = make_subject(subject.name);
    const bool lacking = std::ranges::any_of(instruction_set_variants(), [&](const InstructionSetVariant& variant) {
      return !variant.available && subject.name == "edgecase:" + std::string(variant.name);
    });
    if ((lacking || subject.name == "swiftshader") && !made && made.error().kind == ErrorKind::absent) continue;
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ((*made)->info().name, subject.name);
    names.push_back(subject.name);
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"edgecase", "lavapipe", "osmesa-llvmpipe", "osmesa-softpipe"}));
  EXPECT_GE(names.size(), 10U) << "and the faults";
}

TEST(Registry, MakesTheInstructionSetsOfThisMachineAndSaysOfOthersThatItHasThemNot) {
  const auto variants = instruction_set_variants();
  ASSERT_EQ(variants.size(), 4U);
  EXPECT_TRUE(variants.front().available);
  for (const InstructionSetVariant& variant : variants) {
    const std::string name = "edgecase:" + std::string(variant.name);
    const auto made = make_subject(name);
    ASSERT_EQ(made.has_value(), variant.available) << name;
    if (made) continue;
    EXPECT_EQ(made.error().kind, ErrorKind::absent);
    EXPECT_EQ(made.error().message,
              name + ": this machine, or this build, has no " + std::string(variant.instructions));
  }
}

class SmallSubject final : public Subject {
 public:
  SmallSubject() {
    info_.max_target = 100;
    info_.sample_counts = {1, 4};
    info_.max_coordinate = 50;
  }
  const SubjectInfo& info() const override { return info_; }
  tl::expected<void, Error> draw(const Scene&, MaskBatch&) override { return {}; }

 private:
  SubjectInfo info_;
};

TEST(Refusal, NamesWhatLiesOutsideTheInfo) {
  const SmallSubject subject;
  Scene scene;
  scene.setting.target = {100, 1};
  scene.triangles.assign(2, Triangle{{{0, 0}, {50, -50}, {0.25F, 1}}});
  EXPECT_EQ(subject.refusal(scene), std::nullopt) << "the limits themselves are fine";
  scene.triangles[1][2].y = -50.5F;
  EXPECT_EQ(subject.refusal(scene), "triangle 1, vertex 2: y = -50.5 lies beyond 50 px");
  scene.triangles[0][1].x = std::nanf("");
  EXPECT_EQ(subject.refusal(scene), "triangle 0, vertex 1: x = nan lies beyond 50 px");
  scene.setting.sample_locations.resize(2);
  EXPECT_EQ(subject.refusal(scene), "2 samples a pixel");
  scene.setting.target = {100, 101};
  EXPECT_EQ(subject.refusal(scene), "target 100x101 exceeds 100 pixels a side");
}

}  // namespace
}  // namespace edgecase::conformance
