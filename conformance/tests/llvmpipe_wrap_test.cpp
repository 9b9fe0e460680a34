// A fault of llvmpipe, explained and held: a triangle that ends within the target's first 64-pixel tile, but reaches
// far to its left and above, is tested with edge values that are shifted right by the 8 subpixel bits and then cut to
// 32 bits. From 2^39 square subpixels on, 2^23 square pixels, their sign is bit 39 of the edge function, whatever its
// true sign is: of the triangles below, whole ranges vanish, 8,192 px being far inside the range that the driver
// accepts. Should a newer driver put this right, this test goes red, and the remark in the README with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "conformance/oracle/oracle.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

// The right angle's legs end at (4, 4); the upper one lies `n` px above the target, `n` px long.
Triangle reaching(float n) { return {{{-n + 0.5f, -n + 0.5f}, {4, -n + 0.5f}, {4, 4}}}; }

bool wraps(std::int64_t value) { return value > 0 && (value >> 39 & 1) != 0; }

// Whether the block is rejected as a whole: an edge's largest value in its 16x16 pixels, at the corner that lies
// furthest inside, counts as negative.
bool rejected_after_wrap(const Scene& scene, const Triangle& triangle) {
  std::array<std::int64_t, 3> largest{};
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(16, 0), std::pair(0, 16), std::pair(16, 16)}) {
    const Explanation corner = oracle::explain(scene.setting, scene.rules, triangle, x, y, 0);
    for (std::size_t e = 0; e < 3; ++e)
      largest[e] = std::max<std::int64_t>(largest[e], std::stoll(corner.edges[e].value));
  }
  return std::ranges::any_of(largest, wraps);
}

bool covered_after_wrap(const Explanation& sample) {
  return sample.inside &&
         std::ranges::none_of(sample.edges, [](const EdgeExplanation& edge) { return wraps(std::stoll(edge.value)); });
}

class LlvmpipeWrap : public testing::TestWithParam<const char*> {};

TEST_P(LlvmpipeWrap, TakesTheSignFromBit39) {
  const auto subject = make_subject(GetParam());
  ASSERT_TRUE(subject) << subject.error().message;
  Scene scene;
  scene.setting.target = {4, 4};
  for (int n = 100; n < 8000; n += 3) scene.triangles.push_back(reaching(static_cast<float>(n)));
  MaskBatch masks;
  ASSERT_TRUE((*subject)->draw(scene, masks));

  const MaskLayout layout(scene.setting);
  std::size_t lost = 0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const bool rejected = rejected_after_wrap(scene, scene.triangles[i]);
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        const Explanation sample = oracle::explain(scene.setting, scene.rules, scene.triangles[i], x, y, 0);
        const bool predicted = !rejected && covered_after_wrap(sample);
        EXPECT_EQ(covered(masks[i], layout.bit(x, y, 0)), predicted) << "n = " << 100 + 3 * i << ", " << x << ", " << y;
        lost += sample.inside && !predicted ? 1 : 0;
      }
    }
  }
  EXPECT_GT(lost, 1000u);
}

INSTANTIATE_TEST_SUITE_P(Drivers, LlvmpipeWrap, testing::Values("lavapipe", "osmesa-llvmpipe"),
                         [](const auto& subject) {
                           return std::string(subject.param) == "lavapipe" ? "lavapipe" : "osmesa";
                         });

}  // namespace
}  // namespace edgecase::conformance
