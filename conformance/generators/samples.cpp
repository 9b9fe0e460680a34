#include <algorithm>
#include <utility>

#include "conformance/generators/families.h"

namespace edgecase::conformance::families {

// Vertices on the sixteenths of a pixel that samples lie on, where the grid has them. In a third of the triangles an
// edge is the mirror image of itself in a sample location of the scene, and so passes through it.
void sample_ties(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t pixel = lattice.pixel();
  const std::int64_t step = pixel >= 16 ? pixel / 16 : 1;
  const auto point = [&] {
    const LatticePoint p = lattice.anywhere(random, 2 * pixel);
    return LatticePoint{p.x / step * step, p.y / step * step};
  };
  const LatticePoint a = point();
  LatticePoint b = point();
  LatticePoint c = point();
  if (random.one_in(3)) {
    const auto& locations = scene.setting.sample_locations;
    const auto which = random.between(0, static_cast<std::int64_t>(locations.size()) - 1);
    const SampleLocation at = locations[static_cast<std::size_t>(which)];
    const LatticePoint corner = lattice.to_corner(lattice.anywhere(random, -2 * pixel));
    b = {2 * (corner.x + at.x * pixel / 16) - a.x, 2 * (corner.y + at.y * pixel / 16) - a.y};
  }
  if (random.one_in(4)) c = {b.x + random.between(-2, 2) * step, b.y + random.between(-2, 2) * step};
  if (random.one_in(2)) std::swap(b, c);
  scene.triangles.push_back(lattice.triangle(a, b, c));
}

// Triangles of a few grid units, or of a sixteenth of a pixel, around a sample: those on a pixel's border get as many
// as the others, and a bounding box that leaves them out has nothing else to show.
void around_samples(const Lattice& lattice, Random& random, Scene& scene) {
  const auto& locations = scene.setting.sample_locations;
  const auto which = random.between(0, static_cast<std::int64_t>(locations.size()) - 1);
  const SampleLocation at = locations[static_cast<std::size_t>(which)];
  const std::int64_t pixel = lattice.pixel();
  const LatticePoint corner = lattice.to_corner(lattice.anywhere(random, -pixel));
  const LatticePoint sample{corner.x + at.x * pixel / 16, corner.y + at.y * pixel / 16};
  const std::int64_t reach = random.one_in(2) ? 2 : std::max<std::int64_t>(2, pixel / 16);
  const auto near = [&] {
    const std::int64_t dx = random.between(-reach, reach);
    return LatticePoint{sample.x + dx, sample.y + random.between(-reach, reach)};
  };
  const LatticePoint a = near();
  const LatticePoint b = near();
  scene.triangles.push_back(lattice.triangle(a, b, near()));
}

}  // namespace edgecase::conformance::families
