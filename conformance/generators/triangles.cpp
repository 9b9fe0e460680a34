#include <algorithm>
#include <array>

#include "conformance/generators/families.h"

namespace edgecase::conformance::families {
namespace {

// `a` or `b` by their differing bits: no processor could predict a branch on what was drawn.
std::int64_t choose(bool first, std::int64_t a, std::int64_t b) { return b ^ ((a ^ b) & -std::int64_t{first}); }
LatticePoint choose(bool first, const LatticePoint& a, const LatticePoint& b) {
  return {choose(first, a.x, b.x), choose(first, a.y, b.y)};
}

std::array<LatticePoint, 2> in_any_order(Random& random, const LatticePoint& a, const LatticePoint& b) {
  const bool exchanged = random.one_in(2);
  return {choose(exchanged, b, a), choose(exchanged, a, b)};
}

// Either winding and every rotation comes up: no generator that uses this favours an order of vertices.
void append(const Lattice& lattice, Random& random, const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
            Scene& scene) {
  const auto [second, third] = in_any_order(random, b, c);
  scene.triangles.push_back(lattice.triangle(a, second, third));
}

}  // namespace

void uniform(const Lattice& lattice, Random& random, Scene& scene) {
  // One in eight reaches far outside: its edges cross the target with no vertex in it.
  const std::int64_t margin = random.one_in(8) ? 4 * lattice.width() : lattice.width() / 4;
  const LatticePoint a = lattice.anywhere(random, margin);
  const LatticePoint b = lattice.anywhere(random, margin);
  append(lattice, random, a, b, lattice.anywhere(random, margin), scene);
}

void ties(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t half = lattice.half_pixel();
  const auto point = [&] {
    const LatticePoint p = lattice.anywhere(random, 2 * lattice.pixel());
    return LatticePoint{p.x / half * half, p.y / half * half};
  };
  const LatticePoint a = point();
  LatticePoint b = point();
  const LatticePoint c = point();
  // A quarter each has a horizontal, a vertical and a diagonal edge: those go through a whole row of centres.
  switch (random.between(0, 3)) {
    case 0:
      b.y = a.y;
      break;
    case 1:
      b.x = a.x;
      break;
    case 2:
      b.y = a.y + (b.x - a.x);
      break;
    default:
      break;
  }
  append(lattice, random, a, b, c, scene);
}

// A long edge between two points, and the third vertex a few lattice units off it. Half of the long edges go exactly
// through a pixel centre, the rest anywhere.
void sliver(const Lattice& lattice, Random& random, Scene& scene) {
  LatticePoint a = lattice.anywhere(random, lattice.pixel());
  LatticePoint b = lattice.anywhere(random, lattice.pixel());
  if (random.one_in(2)) {  // b is a mirrored in a centre near the target's middle
    const LatticePoint centre = lattice.to_centre(lattice.anywhere(random, -lattice.width() / 4));
    b = {2 * centre.x - a.x, 2 * centre.y - a.y};
  }
  const std::int64_t along = random.between(0, 16);
  const std::int64_t off = random.one_in(2) ? 1 : random.between(1, lattice.half_pixel());
  const LatticePoint c{a.x + (b.x - a.x) * along / 16 + random.between(-off, off),
                       a.y + (b.y - a.y) * along / 16 + random.between(-off, off)};
  const auto [first, second] = in_any_order(random, a, b);
  append(lattice, random, first, second, c, scene);
}

// Vertices up to 8,000 px out, the reach growing by powers of two: where products stop fitting 16, 32 and 48 bits. Half
// of the triangles have an edge that passes exactly through a pixel centre of the target.
void range(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t reach = std::min(lattice.pixel() << random.between(5, 13), 8000 * lattice.pixel());
  const auto far = [&] { return LatticePoint{random.between(-reach, reach), random.between(-reach, reach)}; };
  const LatticePoint a = far();
  LatticePoint b = far();
  if (random.one_in(2)) {
    const LatticePoint centre = lattice.to_centre(lattice.anywhere(random, -lattice.pixel()));
    b = {2 * centre.x - a.x, 2 * centre.y - a.y};
  }
  append(lattice, random, a, b, far(), scene);
}

// Up to 8,000 px out on the left and above, but with two or three vertices on the other sides no further than a few
// pixels beyond 64 px: those of an axis-parallel right angle, of an edge through a pixel centre, or anywhere.
void far_corner(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t reach = std::min(lattice.pixel() << random.between(9, 13), 8000 * lattice.pixel());
  const auto far = [&] { return -random.between(reach / 2, reach); };
  const auto near = [&] {
    // Half of them with their last pixel about the 4th, the 16th or the 64th.
    if (random.one_in(2)) return random.between(1, 66 * lattice.pixel());
    const std::int64_t border = std::int64_t{4} << 2 * random.between(0, 2);
    return border * lattice.pixel() + random.between(-1, 1) * (random.one_in(2) ? 1 : lattice.half_pixel());
  };
  const LatticePoint corner{near(), near()};
  const LatticePoint a{far(), far()};
  LatticePoint b{corner.x, far()};
  if (random.one_in(3)) return append(lattice, random, a, b, corner, scene);
  if (random.one_in(2)) return append(lattice, random, a, {b.y, corner.y}, corner, scene);
  const LatticePoint centre = lattice.to_centre({corner.x / 2, corner.y / 2});
  if (random.one_in(2)) b = {centre.x + (centre.x - a.x) / 4096, centre.y + (centre.y - a.y) / 4096};
  const LatticePoint c{random.one_in(2) ? corner.x : far(), near()};
  append(lattice, random, a, b, c, scene);
}

// Ending within 16 px, of at most 128 px, and most of them of more than 64: an area of 8,192 square pixels is about the
// middle.
void near_corner(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t pixel = lattice.pixel();
  const auto far = [&] { return -random.between(70 * pixel, 114 * pixel); };
  const auto near = [&] { return random.between(1, 16 * pixel); };
  const LatticePoint beside{near(), far()};
  const LatticePoint below{far(), near()};
  const LatticePoint corner = lattice.to_centre({near(), near()});
  append(lattice, random, random.one_in(4) ? LatticePoint{far(), far()} : beside, below, corner, scene);
}

void tiny(const Lattice& lattice, Random& random, Scene& scene) {
  const bool off_centre = random.one_in(4);
  const LatticePoint place = lattice.anywhere(random, 0);
  const LatticePoint middle = choose(off_centre, place, lattice.to_centre(place));
  const std::int64_t reach = choose(random.one_in(2), 2, lattice.half_pixel());
  const auto near = [&] {
    return LatticePoint{middle.x + random.between(-reach, reach), middle.y + random.between(-reach, reach)};
  };
  const LatticePoint a = near();
  const LatticePoint b = near();
  append(lattice, random, a, b, near(), scene);
}

}  // namespace edgecase::conformance::families
