// Indexed strips and fans, one after the other in one assembly, with restarts between them.
#include <array>
#include <cstddef>

#include "conformance/generators/families.h"
#include "conformance/scene/assemble.h"

namespace edgecase::conformance::families {
namespace {

// Three to nine vertices, drawn in any order and some of them twice, on half a pixel: windings and parities of all
// kinds.
void append_indexed(Topology topology, const Lattice& lattice, Random& random, Scene& scene) {
  if (!scene.assembly) scene.assembly = Assembly{topology, {}, {}};
  Assembly& assembly = *scene.assembly;
  if (!assembly.indices.empty()) assembly.indices.push_back(kRestartIndex);
  const std::size_t first = assembly.vertices.size();
  const std::int64_t count = random.between(3, 9);
  for (std::int64_t i = 0; i < count; ++i) {
    const LatticePoint p = lattice.anywhere(random, lattice.pixel());
    const std::int64_t half = lattice.half_pixel();
    assembly.vertices.push_back(lattice.position({p.x / half * half, p.y / half * half}));
  }
  std::vector<Position> drawn;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto chosen = random.one_in(8) ? random.between(0, count - 1) : i;
    const std::size_t index = first + static_cast<std::size_t>(chosen);
    assembly.indices.push_back(static_cast<std::uint32_t>(index));
    drawn.push_back(assembly.vertices[index]);
  }
  append_primitives(topology, drawn, scene.triangles);
}

}  // namespace

void strips(const Lattice& lattice, Random& random, Scene& scene) {
  append_indexed(Topology::strip, lattice, random, scene);
}

void fans(const Lattice& lattice, Random& random, Scene& scene) {
  append_indexed(Topology::fan, lattice, random, scene);
}

}  // namespace edgecase::conformance::families
