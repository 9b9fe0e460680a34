// Meshes in clip space that reach across the view volume's planes. They are watertight in the window before clipping:
// every position there is one of a mesh on the lattice, and the same position has the same x, y, z and w.
#include <cmath>
#include <map>
#include <utility>

#include "conformance/generators/families.h"

namespace edgecase::conformance::families {
namespace {

// The window mesh of `append` over a target that a 32x32 viewport fills, a vertex's depth and w drawn anew for each
// position. w is 1, or from 1/2 to 2 with 8 bits; depth z / w is 1/2, or from -3/2 to 3/2 in 64ths. The products with a
// position of at most 15 bits are exact.
void append_clip_mesh(Append& append, const Lattice& lattice, Random& random, Scene& scene) {
  Scene window;
  window.setting = scene.setting;
  append(lattice, random, window);
  const bool w_varies = random.one_in(2);
  const bool depth_varies = random.one_in(2);
  std::map<std::pair<float, float>, ClipPosition> vertices;
  const auto half = static_cast<float>(scene.setting.target.width) / 2;
  const auto vertex = [&](const Position& p) {
    const auto [found, fresh] = vertices.try_emplace({p.x, p.y});
    if (!fresh) return found->second;
    float w = 1;
    if (w_varies) {
      const auto octave = static_cast<int>(random.between(-1, 0));
      w = std::ldexp(static_cast<float>(random.between(256, 512)), octave - 8);
    }
    const float depth = depth_varies ? static_cast<float>(random.between(-96, 96)) / 64 : 0.5F;
    found->second = {(p.x / half - 1) * w, (p.y / half - 1) * w, depth * w, w};
    return found->second;
  };
  const std::size_t first = scene.clip->triangles.size();
  for (const Triangle& t : window.triangles) {
    ClipTriangle& triangle = scene.clip->triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = vertex(t[i]);
  }
  for (const Mesh& mesh : window.meshes) scene.meshes.push_back({first + mesh.first, mesh.count});
}

}  // namespace

void clip_fan(const Lattice& lattice, Random& random, Scene& scene) { append_clip_mesh(fan, lattice, random, scene); }

void clip_grid(const Lattice& lattice, Random& random, Scene& scene) { append_clip_mesh(grid, lattice, random, scene); }

}  // namespace edgecase::conformance::families
