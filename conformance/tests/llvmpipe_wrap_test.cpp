// The model of llvmpipe's wrap against llvmpipe: every sample, right or wrong, of triangles that reach far to the left
// and above of the target's first tile. Should a newer driver put this right, this test goes red, and with it every run
// of these generators.
#include "conformance/models/llvmpipe_wrap.h"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST_P(LlvmpipeWrap, IsPredictedToTheLastSample) {
  const auto subject = make_subject(GetParam());
  ASSERT_TRUE(subject) << subject.error().message;
  for (const char* name : {"far_corner", "far_corner_wide", "far_corner_scissor", "far_corner_samples4"}) {
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
      if (!llvmpipe_may_wrap(scene.setting, scene.triangles[i])) continue;
      predict_llvmpipe_wrap(scene.setting, scene.triangles[i], predicted);
      ASSERT_TRUE(std::ranges::equal(predicted, masks[i])) << name << ' ' << i << ": " << text(scene.triangles[i]);
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], exact);
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
