#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "conformance/generators/families.h"
#include "conformance/generators/triangulation.h"

namespace edgecase::conformance::families {
namespace {

// A quadrilateral around a part of the target: its corners may lie outside, one in four lies on the half-pixel lattice.
Triangulation quadrilateral(const Lattice& lattice, Random& random) {
  const std::int64_t w = lattice.width();
  const std::int64_t h = lattice.height();
  const auto corner = [&](std::int64_t x, std::int64_t y) {
    const LatticePoint p{random.between(x - w / 4, x + w / 4), random.between(y - h / 4, y + h / 4)};
    return random.one_in(4) ? lattice.to_centre(p) : p;
  };
  // Each corner keeps to its own quarter-sized box around a corner of the target: always strictly convex enough to be
  // cut.
  return {corner(0, 0), corner(w, 0), corner(w, h), corner(0, h)};
}

std::size_t random_face(const Triangulation& mesh, Random& random) {
  return static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(mesh.faces()) - 1));
}

std::size_t random_edge(Random& random) { return static_cast<std::size_t>(random.between(0, 2)); }

// Arguments are evaluated in an order of the compiler's choice: the edge is drawn first here, and in refinement().
void flip_random_edge(Triangulation& mesh, Random& random) {
  const std::size_t edge = random_edge(random);
  mesh.flip_edge(random_face(mesh, random), edge);
}

}  // namespace

// Cells of 2 to 16 px whose inner vertices move by less than a quarter of a cell: quadrilaterals stay convex, so either
// diagonal may be drawn.
void grid(const Lattice& lattice, Random& random, Scene& scene) {
  const std::int64_t cell = lattice.half_pixel() * random.between(4, 32);
  const std::int64_t jitter = random.one_in(4) ? 0 : cell * 24 / 100;
  const LatticePoint origin = lattice.anywhere(random, 0);
  const std::int64_t columns = std::min<std::int64_t>(random.between(1, 8), lattice.width() * 2 / cell);
  const std::int64_t rows = std::min<std::int64_t>(random.between(1, 8), lattice.height() * 2 / cell);
  const LatticePoint corner{origin.x - cell * random.between(0, columns), origin.y - cell * random.between(0, rows)};

  std::array<LatticePoint, 9 * 9> points;
  const auto point = [&](std::int64_t x, std::int64_t y) -> LatticePoint& {
    return points[static_cast<std::size_t>(y * 9 + x)];
  };
  for (std::int64_t y = 0; y <= rows; ++y) {
    for (std::int64_t x = 0; x <= columns; ++x) {
      point(x, y) = {corner.x + x * cell + random.between(-jitter, jitter),
                     corner.y + y * cell + random.between(-jitter, jitter)};
    }
  }
  const std::size_t first = scene.triangles.size();
  for (std::int64_t y = 0; y < rows; ++y) {
    for (std::int64_t x = 0; x < columns; ++x) {
      const LatticePoint& a = point(x, y);
      const LatticePoint& b = point(x + 1, y);
      const LatticePoint& c = point(x + 1, y + 1);
      const LatticePoint& d = point(x, y + 1);
      if (random.one_in(2)) {
        scene.triangles.push_back(lattice.triangle(a, b, c));
        scene.triangles.push_back(lattice.triangle(c, d, a));
      } else {
        scene.triangles.push_back(lattice.triangle(b, c, d));
        scene.triangles.push_back(lattice.triangle(d, a, b));
      }
    }
  }
  scene.meshes.push_back({first, scene.triangles.size() - first});
}

void triangulation(const Lattice& lattice, Random& random, Scene& scene) {
  Triangulation mesh = quadrilateral(lattice, random);
  const std::int64_t steps = random.between(2, 40);
  for (std::int64_t i = 0; i < steps; ++i) {
    mesh.split_face(random_face(mesh, random), random);
    flip_random_edge(mesh, random);
    flip_random_edge(mesh, random);
  }
  mesh.append_to(scene, lattice, random);
}

// Newest vertices in the middle of edges, both neighbours split: corners that lie exactly on the line of the old edge,
// the way subdivision surfaces and terrain levels of detail make them.
void refinement(const Lattice& lattice, Random& random, Scene& scene) {
  Triangulation mesh = quadrilateral(lattice, random);
  const std::int64_t steps = random.between(2, 40);
  for (std::int64_t i = 0; i < steps; ++i) {
    const std::size_t edge = random_edge(random);
    mesh.split_edge(random_face(mesh, random), edge);
  }
  mesh.append_to(scene, lattice, random);
}

// Two rows of vertices a short way apart, zigzag between them. Each new vertex must leave its triangle a positive area;
// one that does not is left out, and the strip goes on from the next.
void strip(const Lattice& lattice, Random& random, Scene& scene) {
  const LatticePoint from = lattice.anywhere(random, lattice.pixel());
  const LatticePoint to = lattice.anywhere(random, lattice.pixel());
  const std::int64_t dx = to.x - from.x;
  const std::int64_t dy = to.y - from.y;
  const std::int64_t length = std::max<std::int64_t>({dx < 0 ? -dx : dx, dy < 0 ? -dy : dy, 1});
  const std::int64_t width = random.one_in(2) ? random.between(1, 4) : random.between(1, 2 * lattice.pixel());
  const std::int64_t segments = random.between(2, 16);
  // Along the strip; and across it, to its right on the screen, at least one lattice unit in the axis that counts.
  const auto across = [&](std::int64_t component) {
    const std::int64_t scaled = component * width / length;
    return scaled == 0 && component != 0 ? (component < 0 ? -1 : 1) : scaled;
  };
  const LatticePoint side{across(-dy), across(dx)};

  // Each vertex becomes a position once, and is a corner of three triangles.
  struct Vertex {
    LatticePoint point;
    Position position;
  };
  const auto vertex = [&](std::int64_t x, std::int64_t y) { return Vertex{{x, y}, lattice.position({x, y})}; };
  const std::size_t first = scene.triangles.size();
  Vertex left = vertex(from.x, from.y);
  Vertex right = vertex(from.x + side.x, from.y + side.y);
  for (std::int64_t i = 1; i <= segments; ++i) {
    const Vertex next_left = vertex(from.x + dx * i / segments, from.y + dy * i / segments);
    const Vertex next_right = vertex(next_left.point.x + side.x, next_left.point.y + side.y);
    if (orientation(left.point, next_left.point, right.point) <= 0 ||
        orientation(next_left.point, next_right.point, right.point) <= 0) {
      continue;
    }
    scene.triangles.push_back({left.position, next_left.position, right.position});
    scene.triangles.push_back({right.position, next_left.position, next_right.position});
    left = next_left;
    right = next_right;
  }
  const std::size_t count = scene.triangles.size() - first;
  if (count != 0) scene.meshes.push_back({first, count});
}

}  // namespace edgecase::conformance::families
