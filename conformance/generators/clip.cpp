// Positions in clip space. Every operation here is one rounding of binary32, so that they are the same everywhere.
#include <cmath>
#include <utility>

#include "conformance/generators/families.h"
#include "conformance/scene/nearest_even.h"

namespace edgecase::conformance::families {
namespace {

enum class W { one, positive, either_sign };

// From -reach to reach; a quarter of them multiples of 1/8, which lie on planes and on each other's edges.
float ratio(Random& random, float reach) {
  const std::int64_t limit = std::int64_t{1} << 23;
  const float unit = static_cast<float>(random.between(-limit, limit)) * 0x1p-23F;
  const float value = unit * reach;
  return random.one_in(4) ? nearest_even(value * 8) / 8 : value;
}

// Magnitudes from 1/4 to 4.
float homogeneous(Random& random, W kind) {
  if (kind == W::one) return 1;
  float w = static_cast<float>(1 << random.between(0, 3)) / 4;
  if (!random.one_in(4)) w *= 1 + static_cast<float>(random.between(0, (1 << 23) - 1)) * 0x1p-23F;
  return w;
}

}  // namespace

// Inside the view volume, half of them with w = 1. Some coordinates are sent to the tie of the snap next to where they
// would lie in the scene's viewport, as nearly as binary32 can.
void inside(const Lattice& lattice, Random& random, Scene& scene) {
  const Viewport& viewport = scene.clip->viewport;
  const W kind = random.one_in(2) ? W::one : W::positive;
  const auto coordinate = [&](float origin, float extent) {
    const float value = ratio(random, 1);
    if (random.one_in(2)) return value;
    const auto grid = static_cast<float>(lattice.pixel());
    const float window = origin + (value + 1) * 0.5F * extent;
    const float tie = (std::floor(window * grid) + 0.5F) / grid;
    const float back = (tie - origin) / extent * 2 - 1;
    return std::fabs(back) <= 1 ? back : value;
  };
  ClipTriangle triangle;
  for (ClipPosition& p : triangle) {
    p.w = homogeneous(random, kind);
    p.x = coordinate(viewport.x, viewport.width) * p.w;
    p.y = coordinate(viewport.y, viewport.height) * p.w;
    p.z = std::fabs(ratio(random, 1)) * p.w;
  }
  scene.clip->triangles.push_back(triangle);
}

// Across the view volume's planes: those of x and y, of z, or of all.
void clip(const Lattice&, Random& random, Scene& scene) {
  const auto kind = static_cast<W>(random.between(0, 2));
  const float reach = std::ldexp(1.0F, static_cast<int>(random.between(0, 3)));
  const bool in_depth = random.one_in(2);
  ClipTriangle triangle;
  for (ClipPosition& p : triangle) {
    p.w = homogeneous(random, kind);
    p.x = ratio(random, reach) * p.w;
    p.y = ratio(random, reach) * p.w;
    p.z = in_depth ? (ratio(random, 1.5F) + 0.5F) * p.w : 0.5F * p.w;
    if (kind == W::either_sign && random.one_in(3)) p.w = -p.w;
  }
  scene.clip->triangles.push_back(triangle);
}

// As far_corner, for a viewport that ends within the target's first 64 pixels: one vertex far to the left and above,
// one about the viewport's lower right corner, one on the same row or column as either; or each coordinate of each
// vertex at either end, so that the target may lie outside of the triangle. Most are cut at the viewport's sides.
void clip_far(const Lattice&, Random& random, Scene& scene) {
  const W kind = random.one_in(2) ? W::one : W::positive;
  const float reach = std::ldexp(1.25F, 1 - static_cast<int>(random.between(0, 2)));
  const auto far = [&] { return 1 - std::fabs(ratio(random, reach)); };
  const auto near = [&] { return 1 + ratio(random, 0x1p-7F); };
  const float left = far();
  const float right = near();
  const float top = far();
  const float bottom = near();
  const bool beside = random.one_in(2);
  ClipTriangle triangle{ClipPosition{left, top}, ClipPosition{right, bottom},
                        ClipPosition{beside ? right : left, beside ? top : bottom}};
  if (random.one_in(2)) std::swap(triangle[0], triangle[1]);
  const bool anywhere = random.one_in(2);
  for (ClipPosition& p : triangle) {
    if (anywhere) p = {random.one_in(2) ? near() : far(), random.one_in(2) ? near() : far()};
    p.w = homogeneous(random, kind);
    p.x *= p.w;
    p.y *= p.w;
    p.z = 0.5F * p.w;
  }
  scene.clip->triangles.push_back(triangle);
}

}  // namespace edgecase::conformance::families
