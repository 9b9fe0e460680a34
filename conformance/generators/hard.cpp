// Single hard shapes, each at the size where it has broken rasterizers.
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "conformance/generators/families.h"

namespace edgecase::conformance::families {
namespace {

void append(const Lattice& lattice, Random& random, std::array<LatticePoint, 3> points, Scene& scene) {
  if (random.one_in(2)) std::swap(points[1], points[2]);
  std::rotate(points.begin(), points.begin() + random.between(0, 2), points.end());
  scene.triangles.push_back(lattice.triangle(points[0], points[1], points[2]));
}

// On a whole or half pixel, or one of the two points beside it: where a box ends in one pixel or in the next.
std::int64_t beside_half_pixel(const Lattice& lattice, Random& random, std::int64_t low, std::int64_t high) {
  return random.between(2 * low, 2 * high) * lattice.half_pixel() + random.between(-1, 1);
}

}  // namespace

// A box of a power of two pixels, up to a pixel more or less, that begins at one or a little off it. The corners of the
// box, or points on its sides, are the vertices.
void straddle(const Lattice& lattice, Random& random, Scene& scene) {
  const Extent target = scene.setting.target;
  const auto side = [&](std::int64_t limit) {
    constexpr std::array<std::int64_t, 6> kSizes{4, 8, 16, 32, 64, 128};
    std::int64_t size = kSizes[static_cast<std::size_t>(random.between(0, 5))];
    while (size > limit) size /= 2;
    const std::int64_t from =
        random.one_in(2) ? random.between(0, (limit - 1) / size) * size : random.between(0, limit - size / 2);
    const std::int64_t low = beside_half_pixel(lattice, random, from, from);
    return std::array{low, low + beside_half_pixel(lattice, random, size - 1, size + 1)};
  };
  const auto x = side(target.width);
  const auto y = side(target.height);
  const auto corner = static_cast<std::size_t>(random.between(0, 3));
  const auto at = [&](std::size_t right, std::size_t down) { return LatticePoint{x[right], y[down]}; };
  const std::size_t r = corner & 1;
  const std::size_t d = corner >> 1;
  LatticePoint beside = at(1 - r, d);
  LatticePoint opposite = at(r, 1 - d);
  if (random.one_in(2)) beside.y = random.between(y[0], y[1]);
  if (random.one_in(2)) opposite.x = random.between(x[0], x[1]);
  append(lattice, random, {at(r, d), beside, opposite}, scene);
}

// Two triangles that make a rectangle: its upper left corner lies 1,000 to 8,000 px away to either side, its lower
// right one in the target or just beyond it. Neither loses or gains a sample unless an edge function is cut off.
void far_rectangle(const Lattice& lattice, Random& random, Scene& scene) {
  const auto far = [&] {
    const std::int64_t low = 1000 * lattice.pixel() << random.between(0, 2);
    return -random.between(low, 2 * low);
  };
  const LatticePoint first{far(), far()};
  const LatticePoint last = lattice.anywhere(random, lattice.pixel());
  scene.meshes.push_back({scene.triangles.size(), 2});
  const LatticePoint right{last.x, first.y};
  const LatticePoint left{first.x, last.y};
  if (random.one_in(2)) {
    scene.triangles.push_back(lattice.triangle(first, right, last));
    scene.triangles.push_back(lattice.triangle(last, left, first));
  } else {
    scene.triangles.push_back(lattice.triangle(left, right, last));
    scene.triangles.push_back(lattice.triangle(first, right, left));
  }
}

// 16,000 px long and a subpixel or two wide, along the target's longer side: its edges pass the centres of a whole row
// or column within about a subpixel, thousands of them on a target of that length.
void needle(const Lattice& lattice, Random& random, Scene& scene) {
  const bool wide = scene.setting.target.width >= scene.setting.target.height;
  const std::int64_t lines = wide ? scene.setting.target.height : scene.setting.target.width;
  const auto point = [&](std::int64_t along, std::int64_t across) {
    return wide ? LatticePoint{along, across} : LatticePoint{across, along};
  };
  const std::int64_t centre = random.between(0, lines - 1) * lattice.pixel() + lattice.half_pixel();
  const auto across = [&] { return centre + random.between(-2, 2); };
  const std::int64_t reach = 8000 * lattice.pixel();
  const std::int64_t from = random.between(-reach, 64 - reach);
  const std::int64_t to = random.between(reach - 64, reach);
  const std::int64_t middle = random.one_in(2) ? random.between(from, to) : random.one_in(2) ? from : to;
  append(lattice, random, {point(from, across()), point(to, across()), point(middle, across())}, scene);
}

// A closed fan of 1,000 to 4,096 spokes around a point of the target, the rim being a square far outside: points on it
// in their order have angles in that order, so that the fan is watertight.
void spokes(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t reach = lattice.pixel() * (random.one_in(2) ? 64 : 4000);
  const LatticePoint centre = random.one_in(2) ? lattice.to_centre(lattice.anywhere(random, -lattice.pixel()))
                                               : lattice.anywhere(random, -lattice.pixel());
  const std::int64_t count = random.between(1000, 4096);
  const std::int64_t side = 2 * reach;
  std::vector<std::int64_t> places{0, side, 2 * side, 3 * side};
  while (static_cast<std::int64_t>(places.size()) < count) places.push_back(random.between(0, 4 * side - 1));
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const auto on_rim = [&](std::int64_t place) -> LatticePoint {
    const std::int64_t along = place % side;
    switch (place / side) {  // clockwise on the screen, from the upper left corner
      case 0:
        return {along - reach, -reach};
      case 1:
        return {reach, along - reach};
      case 2:
        return {reach - along, reach};
      default:
        return {-reach, reach - along};
    }
  };
  scene.meshes.push_back({scene.triangles.size(), places.size()});
  for (std::size_t i = 0; i < places.size(); ++i) {
    scene.triangles.push_back(lattice.triangle(centre, on_rim(places[i]), on_rim(places[(i + 1) % places.size()])));
  }
}

namespace {

// Coordinates from -limit to last: at these ends, or within 64 px of them, and about the target.
void ends(const Lattice& lattice, Random& random, std::int64_t limit, std::int64_t last, Scene& scene) {
  const auto coordinate = [&](std::int64_t extent) {
    if (random.one_in(4)) return random.between(-lattice.pixel(), extent + lattice.pixel());
    const std::int64_t inward = random.one_in(2) ? 0 : random.between(0, 64 * lattice.pixel());
    return random.one_in(2) ? last - inward : inward - limit;
  };
  const auto point = [&] { return LatticePoint{coordinate(lattice.width()), coordinate(lattice.height())}; };
  const LatticePoint a = point();
  LatticePoint b = point();
  if (random.one_in(4)) {  // its mirror image in a pixel's centre, as far as the range lets it
    const LatticePoint centre = lattice.to_centre(lattice.anywhere(random, -lattice.pixel()));
    b = {std::clamp(2 * centre.x - a.x, -limit, last), std::clamp(2 * centre.y - a.y, -limit, last)};
  }
  append(lattice, random, {a, b, point()}, scene);
}

}  // namespace

// 16 integer bits.
void range_ends(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t limit =
      std::min(32768 * lattice.pixel(), std::int64_t{1} << 23);  // of 24 bits, on finer grids, too
  ends(lattice, random, limit, limit - 1, scene);
}

// As far as the drivers go that have viewports of 16,384 px.
void viewport_ends(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t limit = 8192 * lattice.pixel();
  ends(lattice, random, limit, limit, scene);
}

// A triangle of less than a pixel to a few pixels about a sample that lies on or next to its pixel's border: its box
// ends at the sample, or a subpixel before or behind it.
void border_samples(const Lattice& lattice, Random& random, Scene& scene) {
  std::vector<SampleLocation> at_border;
  for (const SampleLocation& at : scene.setting.sample_locations) {
    if (std::min(at.x, at.y) == 0 || std::max(at.x, at.y) == 15) at_border.push_back(at);
  }
  const SampleLocation at =
      at_border[static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(at_border.size()) - 1))];
  const LatticePoint pixel = lattice.to_corner(lattice.anywhere(random, -lattice.pixel()));
  const LatticePoint sample{pixel.x + at.x * lattice.pixel() / 16, pixel.y + at.y * lattice.pixel() / 16};
  const std::int64_t reach = random.one_in(2) ? lattice.half_pixel() : 4 * lattice.pixel();
  const auto off = [&] { return random.between(-1, 1); };
  const auto away = [&] { return random.between(-reach, reach); };
  // One vertex at the sample, or an edge along its row or column, and the rest on one side of it.
  LatticePoint a{sample.x + off(), sample.y + off()};
  LatticePoint b{sample.x + away(), sample.y + away()};
  const LatticePoint c{sample.x + away(), sample.y + away()};
  if (random.one_in(3)) b.x = 2 * sample.x - a.x;
  if (random.one_in(3)) b.y = 2 * sample.y - a.y;
  append(lattice, random, {a, b, c}, scene);
}

}  // namespace edgecase::conformance::families
