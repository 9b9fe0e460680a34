// Window positions off the grid: nothing but the snap decides what they cover.
#include <cmath>

#include "conformance/generators/families.h"

namespace edgecase::conformance::families {
namespace {

// From -4 px to 4 px beyond the target, with as many bits as binary32 has there; a quarter lies around 0, where those
// are more than anywhere else: magnitudes of 2^-12 to 1/2 px. None is so small that a driver's viewport would lose bits
// of it.
float anywhere(Random& random, int extent) {
  const auto bits = static_cast<float>(random.between(1 << 23, (1 << 24) - 1));
  if (random.one_in(4)) {
    const float value = std::ldexp(bits, -24 - static_cast<int>(random.between(1, 11)));
    return random.one_in(2) ? value : -value;
  }
  const auto whole = static_cast<float>(random.between(-4, extent + 3));
  return whole + (std::ldexp(bits, -23) - 1);
}

// An odd multiple of half the grid's unit, or one of the four nearest floats.
float near_tie(Random& random, int extent, std::int64_t pixel) {
  const std::int64_t tie = 2 * random.between(-4 * pixel, (extent + 4) * pixel) + 1;
  float value = static_cast<float>(tie) / static_cast<float>(2 * pixel);
  const std::int64_t steps = random.between(-2, 2);
  for (std::int64_t i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, steps < 0 ? -1e6F : 1e6F);
  return value;
}

}  // namespace

void floats(const Lattice&, Random& random, Scene& scene) {
  const Extent target = scene.setting.target;
  Triangle triangle;
  for (Position& p : triangle) {
    p.x = anywhere(random, target.width);
    p.y = anywhere(random, target.height);
  }
  scene.triangles.push_back(triangle);
}

// A sample near an edge is needed to see where a vertex was snapped to: one vertex lies near a tie, another so that the
// edge between them passes a pixel's centre, which the two grid points beside the tie put on either side of it.
void float_ties(const Lattice& lattice, Random& random, Scene& scene) {
  const Extent target = scene.setting.target;
  const std::int64_t pixel = lattice.pixel();
  Triangle triangle;
  for (Position& p : triangle) {
    p.x = near_tie(random, target.width, pixel);
    p.y = near_tie(random, target.height, pixel);
  }
  if (random.one_in(2)) {
    const Position centre = lattice.position(lattice.to_centre(lattice.anywhere(random, -pixel)));
    const auto mirrored = [&](float middle, float value) {
      const auto grid = std::floor(value * static_cast<float>(pixel)) / static_cast<float>(pixel);
      return 2 * middle - grid;
    };
    triangle[1] = {mirrored(centre.x, triangle[0].x), mirrored(centre.y, triangle[0].y)};
  }
  scene.triangles.push_back(triangle);
}

}  // namespace edgecase::conformance::families
