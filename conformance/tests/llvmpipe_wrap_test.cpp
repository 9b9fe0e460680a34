// The model of llvmpipe's wrap against llvmpipe: every sample, right or wrong, of triangles that reach far to the left
// and above of the target's first tile. Should a newer driver put this right, this test goes red, and with it every run
// of these generators.
#include "conformance/models/llvmpipe_wrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "conformance/generators/generator.h"
#include "conformance/oracle/oracle.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

class LlvmpipeWrap : public testing::TestWithParam<const char*> {};

std::string text(const Triangle& t) {
  std::ostringstream result;
  for (const Position& p : t) result << '(' << p.x << ", " << p.y << ") ";
  return result.str();
}

// c - 1 is an edge's value, less one if the edge is neither a top nor a left one; 2^13 square pixels are 2^29 in square
// subpixels, which here run through the target, a little further with each triangle.
TEST_P(LlvmpipeWrap, IsPredictedAtItsThreshold) {
  const auto subject = make_subject(GetParam());
  ASSERT_TRUE(subject) << subject.error().message;
  Scene scene;
  scene.setting.target = {8, 8};
  constexpr float kStep = 7 * 0x1p-8F;
  for (int i = 0; i < 4000; ++i) {
    const float x = -79 - static_cast<float>(i % 200) * kStep, y = -93 - static_cast<float>(i / 200) * kStep;
    scene.triangles.push_back({{{x, 10}, {6, y}, {6, 10}}});
  }
  MaskBatch masks;
  ASSERT_TRUE((*subject)->draw(scene, masks));
  const MaskLayout layout(scene.setting);
  std::vector<std::uint64_t> predicted(layout.words());
  std::set<std::vector<std::uint64_t>> different;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], predicted);
    asked += predict_llvmpipe_wrap(scene.setting, scene.triangles[i], predicted) ? 1 : 0;
    ASSERT_TRUE(std::ranges::equal(predicted, masks[i])) << text(scene.triangles[i]);
    different.insert(predicted);
  }
  EXPECT_GT(different.size(), 5u);
  EXPECT_GT(asked, scene.triangles.size() / 2);
}

TEST_P(LlvmpipeWrap, IsPredictedToTheLastSample) {
  const auto subject = make_subject(GetParam());
  ASSERT_TRUE(subject) << subject.error().message;
  for (const char* name : {"far_corner", "far_corner_wide", "far_corner_scissor", "far_corner_samples4",
                           "near_corner_scissor", "near_corner_small"}) {
    const Generator& generator = *find_generator(name);
    Scene scene;
    scene.setting = generator.setting;
    for (std::uint64_t i = 0; i < 2000; ++i) append_scene(generator, 1, i, scene);
    MaskBatch masks;
    ASSERT_TRUE((*subject)->draw(scene, masks));
    const MaskLayout layout(scene.setting);
    std::vector<std::uint64_t> exact(layout.words()), predicted(layout.words());
    std::size_t wrapped = 0;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], exact);
      predicted = exact;
      predict_llvmpipe_wrap(scene.setting, scene.triangles[i], predicted);
      ASSERT_TRUE(std::ranges::equal(predicted, masks[i])) << name << ' ' << i << ": " << text(scene.triangles[i]);
      wrapped += exact != predicted ? 1 : 0;
    }
    EXPECT_GT(wrapped, 100u) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Drivers, LlvmpipeWrap, testing::Values("lavapipe", "lavapipe:bgra8", "osmesa-llvmpipe"),
                         [](const auto& subject) {
                           std::string name = subject.param;
                           std::erase_if(name, [](char c) { return c == ':' || c == '-'; });
                           return name;
                         });

}  // namespace
}  // namespace edgecase::conformance
