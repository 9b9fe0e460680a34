#include "conformance/bench/workloads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "conformance/generators/lattice.h"
#include "conformance/generators/random.h"

namespace edgecase::conformance {
namespace {

constexpr Extent kScreen{1920, 1080};
constexpr int kSubpixelBits = 8;
constexpr std::int64_t kPixel = std::int64_t{1} << kSubpixelBits;
/// Vertices lie on multiples of this many subpixels.
constexpr std::int64_t kFinest = 1;
constexpr std::int64_t kHalfPixel = kPixel / 2;

const Lattice& lattice() {
  static const Lattice screen(kScreen, kSubpixelBits);
  return screen;
}

/// In pixels.
struct Point {
  double x = 0;
  double y = 0;
};

/// Uniform over the multiples of 2^-53 in [0, 1).
double unit(Random& random) { return std::ldexp(static_cast<double>(random.next() >> 11), -53); }

/// The nearest multiple of `step` subpixels.
LatticePoint rounded(const Point& p, std::int64_t step) {
  const auto coordinate = [&](double pixels) {
    return static_cast<std::int64_t>(
               std::floor(pixels * static_cast<double>(kPixel) / static_cast<double>(step) + 0.5)) *
           step;
  };
  return {coordinate(p.x), coordinate(p.y)};
}

/// Moves the three points, as they are to each other, to a random place on the target, and puts them on the grid. They
/// must fit.
std::array<LatticePoint, 3> placed(const Extent& target, std::array<Point, 3> points, std::int64_t step,
                                   Random& random) {
  const auto [left, right] = std::minmax({points[0].x, points[1].x, points[2].x});
  const auto [top, bottom] = std::minmax({points[0].y, points[1].y, points[2].y});
  const double dx = unit(random) * (target.width - (right - left)) - left;
  const double dy = unit(random) * (target.height - (bottom - top)) - top;
  std::array<LatticePoint, 3> result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = rounded({points[i].x + dx, points[i].y + dy}, step);
  return result;
}

/// Appends `count` triangles of `area` px^2 before their vertices are put on the grid, none of which is thinner than
/// area = 0.12 * (longest edge)^2; the equilateral triangle has 0.43.
void append_even(const Extent& target, std::size_t count, double area, std::int64_t step, Random& random,
                 std::vector<Triangle>& triangles) {
  constexpr double kLeastRatio = 0.12;
  for (std::size_t made = 0; made < count;) {
    std::array<Point, 3> p;
    for (Point& point : p) {
      point.x = unit(random);
      point.y = unit(random);
    }
    const auto squared = [&](std::size_t i, std::size_t j) {
      return (p[i].x - p[j].x) * (p[i].x - p[j].x) + (p[i].y - p[j].y) * (p[i].y - p[j].y);
    };
    const double doubled = std::abs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y));
    if (doubled / 2 < kLeastRatio * std::max({squared(0, 1), squared(1, 2), squared(2, 0)}) || doubled == 0) continue;
    const double scale = std::sqrt(2 * area / doubled);
    for (Point& point : p) {
      point.x *= scale;
      point.y *= scale;
    }
    const auto [a, b, c] = placed(target, p, step, random);
    if (orientation(a, b, c) == 0) continue;  // on a coarse grid only
    triangles.push_back(lattice().triangle(a, b, c));
    ++made;
  }
}

void small10(std::uint64_t seed, std::size_t count, Scene& scene) {
  Random random = Random::stream(seed, "small10", 0);
  append_even(kScreen, count, 10, kFinest, random, scene.triangles);
}

void med200(std::uint64_t seed, std::size_t count, Scene& scene) {
  Random random = Random::stream(seed, "med200", 0);
  append_even(kScreen, count, 200, kFinest, random, scene.triangles);
}

void large20k(std::uint64_t seed, std::size_t count, Scene& scene) {
  Random random = Random::stream(seed, "large20k", 0);
  append_even(kScreen, count, 20'000, kFinest, random, scene.triangles);
}

void full(std::uint64_t, std::size_t count, Scene& scene) {
  const LatticePoint a{0, 0}, b{lattice().width(), 0}, c{lattice().width(), lattice().height()},
      d{0, lattice().height()};
  const std::array<std::array<LatticePoint, 3>, 4> halves{{{a, b, c}, {a, c, d}, {a, b, d}, {b, c, d}}};
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [p, q, r] = halves[i % halves.size()];
    scene.triangles.push_back(lattice().triangle(p, q, r));
  }
}

void sliver(std::uint64_t seed, std::size_t count, Scene& scene) {
  constexpr double kLength = 1'000;
  Random random = Random::stream(seed, "sliver", 0);
  for (std::size_t made = 0; made < count;) {
    // A direction: a point of the disk, normalized. Not too near the centre, where few directions are to be had.
    const Point in_disk{2 * unit(random) - 1, 2 * unit(random) - 1};
    const double radius = std::sqrt(in_disk.x * in_disk.x + in_disk.y * in_disk.y);
    if (radius > 1 || radius < 0.1) continue;
    const Point along{in_disk.x / radius, in_disk.y / radius};
    const double width = 0.5 + 0.5 * unit(random);
    const double apex = kLength * unit(random);
    const auto [a, b, c] = placed(kScreen,
                                  {Point{}, Point{kLength * along.x, kLength * along.y},
                                   Point{apex * along.x - width * along.y, apex * along.y + width * along.x}},
                                  kFinest, random);
    scene.triangles.push_back(lattice().triangle(a, b, c));
    ++made;
  }
}

/// The first `count` triangles of the mesh, cell by cell in reading order; its vertices on multiples of `step`.
void append_mesh(std::size_t count, std::int64_t step, Random& random, std::vector<Triangle>& triangles) {
  constexpr std::size_t kCells = 512;
  constexpr double kJitter = 0.24;
  constexpr double kCellWidth = static_cast<double>(kScreen.width) / kCells;
  constexpr double kCellHeight = static_cast<double>(kScreen.height) / kCells;
  const auto next_row = [&](std::size_t row) {
    std::array<LatticePoint, kCells + 1> points;
    for (std::size_t i = 0; i <= kCells; ++i) {
      // Vertices of the border stay on it.
      const double dx = (2 * unit(random) - 1) * (i == 0 || i == kCells ? 0 : kJitter);
      const double dy = (2 * unit(random) - 1) * (row == 0 || row == kCells ? 0 : kJitter);
      points[i] =
          rounded({(static_cast<double>(i) + dx) * kCellWidth, (static_cast<double>(row) + dy) * kCellHeight}, step);
    }
    return points;
  };
  const std::size_t first = triangles.size();
  auto above = next_row(0);
  for (std::size_t row = 0; row < kCells && triangles.size() < first + count; ++row) {
    const auto below = next_row(row + 1);
    for (std::size_t i = 0; i < kCells; ++i) {
      triangles.push_back(lattice().triangle(above[i], above[i + 1], below[i + 1]));
      triangles.push_back(lattice().triangle(above[i], below[i + 1], below[i]));
    }
    above = below;
  }
  triangles.resize(first + count);
}

void mesh512(std::uint64_t seed, std::size_t count, Scene& scene) {
  Random random = Random::stream(seed, "mesh512", 0);
  append_mesh(count, kFinest, random, scene.triangles);
  scene.meshes.push_back({0, count});
}

constexpr std::size_t kSmall = 1'000'000;
constexpr std::size_t kMesh = 2 * 512 * 512;

// Alternating, so that the first ones are of both kinds, until the mesh has no more.
void ties(std::uint64_t seed, std::size_t count, Scene& scene) {
  const std::size_t of_mesh = std::min(count / 2, kMesh);
  std::vector<Triangle> small, mesh;
  Random for_small = Random::stream(seed, "ties", 0), for_mesh = Random::stream(seed, "ties", 1);
  append_even(kScreen, count - of_mesh, 10, kHalfPixel, for_small, small);
  append_mesh(of_mesh, kHalfPixel, for_mesh, mesh);
  for (std::size_t i = 0; i < small.size(); ++i) {
    scene.triangles.push_back(small[i]);
    if (i < of_mesh) scene.triangles.push_back(mesh[i]);
  }
}

constexpr Workload kWorkloads[] = {
    {"small10", "triangles of 10 px anywhere, none thin", kSmall, small10},
    {"med200", "triangles of 200 px anywhere, none thin", 200'000, med200},
    {"large20k", "triangles of 20,000 px anywhere, none thin", 2'000, large20k},
    {"full", "the screen in two triangles, 100 times, the diagonal alternating", 200, full},
    {"sliver", "triangles 1,000 px long and 0.5 to 1 px wide, in any direction", 5'000, sliver},
    {"mesh512", "the screen as a jittered mesh of 512x512 cells, two triangles of about 4 px each", kMesh, mesh512},
    {"ties", "small10 and mesh512 with their vertices on the half-pixel grid", kSmall + kMesh, ties},
};

}  // namespace

std::span<const Workload> workloads() { return kWorkloads; }

const Workload* find_workload(std::string_view name) {
  const auto found = std::ranges::find(kWorkloads, name, &Workload::name);
  return found == std::end(kWorkloads) ? nullptr : found;
}

Scene make_even(const Extent& target, std::size_t count, double area, std::uint64_t seed) {
  Scene scene;
  scene.setting.target = target;
  scene.rules.subpixel_bits = kSubpixelBits;
  scene.triangles.reserve(count);
  Random random = Random::stream(seed, "even", 0);
  append_even(target, count, area, kFinest, random, scene.triangles);
  return scene;
}

Scene make_workload(const Workload& workload, std::size_t count, std::uint64_t seed) {
  Scene scene;
  scene.setting.target = kScreen;
  scene.rules.subpixel_bits = kSubpixelBits;
  const std::size_t bounded = std::min(count, workload.triangles);
  scene.triangles.reserve(bounded);
  workload.append(seed, bounded, scene);
  return scene;
}

}  // namespace edgecase::conformance
