// Triangles in clip space of which no clipper cuts anything and no transform rounds anything: what they cover is a
// matter of the rules alone. See scene/window_position.h.
#include <array>
#include <cmath>
#include <utility>

#include "conformance/generators/families.h"

namespace edgecase::conformance::families {
namespace {

// The inverse of the viewport transform, exact where the viewport's size is a power of two: `window` has few bits.
ClipPosition unprojected(const Viewport& viewport, const Position& window, float z, float w) {
  return {((window.x - viewport.x) / viewport.width * 2 - 1) * w,
          ((window.y - viewport.y) / viewport.height * 2 - 1) * w, z * w, w};
}

ClipTriangle unprojected(const Viewport& viewport, const Triangle& triangle, Random& random) {
  ClipTriangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    const float z = static_cast<float>(random.between(0, 8)) / 8;
    const float w = std::ldexp(1.0F, static_cast<int>(random.between(-2, 2)));
    result[i] = unprojected(viewport, triangle[i], z, w);
  }
  return result;
}

Triangle on_half_pixels(const Lattice& lattice, Random& random) {
  const std::int64_t half = lattice.half_pixel();
  const auto point = [&] {
    const LatticePoint p = lattice.anywhere(random, 0);
    return LatticePoint{p.x / half * half, p.y / half * half};
  };
  const LatticePoint a = point();
  LatticePoint b = point();
  if (random.one_in(2)) b.y = a.y;  // a horizontal edge, often through a row of centres
  return lattice.triangle(a, b, point());
}

float binary32_area(const Triangle& t) {
  return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
}

// A sliver on the grid, its first edge through a pixel's centre, with each vertex moved by up to 3/8 of the grid's
// unit: the snap moves it back. Taken is the first of several that is wound otherwise before the snap than after it.
Triangle turned_sliver(const Lattice& lattice, Random& random) {
  constexpr int kTries = 16;
  Triangle moved;
  for (int i = 0; i < kTries; ++i) {
    const LatticePoint centre = lattice.to_centre(lattice.anywhere(random, -lattice.width() / 4));
    const std::int64_t reach = lattice.width() / 4;
    const LatticePoint a{centre.x + random.between(-reach, reach), centre.y + random.between(-reach, reach)};
    const LatticePoint b{2 * centre.x - a.x, 2 * centre.y - a.y};
    const std::int64_t along = random.between(1, 15);
    const LatticePoint c{a.x + (b.x - a.x) * along / 16 + random.between(-1, 1),
                         a.y + (b.y - a.y) * along / 16 + random.between(-1, 1)};
    const std::int64_t area = orientation(a, b, c);
    const Triangle snapped = lattice.triangle(a, b, c);
    const float eighth = 0.125F / static_cast<float>(lattice.pixel());
    for (std::size_t v = 0; v < 3; ++v) {
      const auto offset = [&] { return static_cast<float>(random.between(-3, 3)) * eighth; };
      const float dx = offset();
      moved[v] = {snapped[v].x + dx, snapped[v].y + offset()};
    }
    if (area != 0 && (area > 0) != (binary32_area(moved) > 0)) break;
  }
  return moved;
}

}  // namespace

void centres(const Lattice& lattice, Random& random, Scene& scene) {
  scene.clip->triangles.push_back(unprojected(scene.clip->viewport, on_half_pixels(lattice, random), random));
}

// Half of them with every coordinate negated: the same positions after division by w, but behind the eye.
void behind(const Lattice& lattice, Random& random, Scene& scene) {
  centres(lattice, random, scene);
  if (random.one_in(2)) return;
  for (ClipPosition& p : scene.clip->triangles.back()) p = {-p.x, -p.y, -p.z, -p.w};
}

void turned(const Lattice& lattice, Random& random, Scene& scene) {
  scene.clip->triangles.push_back(unprojected(scene.clip->viewport, turned_sliver(lattice, random), random));
}

// Moved by half the target towards one of its borders.
void turned_across(const Lattice& lattice, Random& random, Scene& scene) {
  Triangle sliver = turned_sliver(lattice, random);
  const bool sideways = random.one_in(2);
  const Extent& target = scene.setting.target;
  const auto by = static_cast<float>((sideways ? target.width : target.height) / 2 * (random.one_in(2) ? 1 : -1));
  for (Position& p : sliver) (sideways ? p.x : p.y) += by;
  scene.clip->triangles.push_back(unprojected(scene.clip->viewport, sliver, random));
}

// So few that some of a thousand slivers drawn together have one among them, and some have none.
void turned_beside_across(const Lattice& lattice, Random& random, Scene& scene) {
  constexpr int kOneAcrossIn = 2000;
  (random.one_in(kOneAcrossIn) ? turned_across : turned)(lattice, random, scene);
}

}  // namespace edgecase::conformance::families
