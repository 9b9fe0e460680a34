#include <array>

#include "conformance/generators/families.h"
#include "conformance/generators/generator.h"

namespace edgecase::conformance {

std::span<const Generator> generators() {
  static const std::array all{
      Generator{"fan",
                "fan",
                "closed fans of 3 to 64 spokes; centre and spokes on sample points, pixel corners, anywhere",
                {},
                families::fan},
      Generator{
          "grid", "shared_edge", "regular grids jittered on the subpixel lattice, either diagonal", {}, families::grid},
      Generator{"triangulation",
                "shared_edge",
                "random triangulations: points inserted, edges flipped",
                {},
                families::triangulation},
      Generator{"strip", "shared_edge", "long thin strips, down to one subpixel wide", {}, families::strip},
      Generator{"refinement",
                "shared_edge",
                "meshes refined at edge midpoints without T-junctions",
                {},
                families::refinement},
      Generator{"random",
                "random",
                "triangles with uniformly random vertices in and around the target",
                {},
                families::uniform},
      Generator{"ties",
                "ties",
                "triangles on the half-pixel lattice: edges and vertices on pixel centres",
                {},
                families::ties},
      Generator{
          "range", "range", "triangles whose vertices lie up to 8,000 px outside the target", {}, families::range},
      Generator{"sliver",
                "sliver",
                "needles up to a few subpixels wide, most of them passing close to pixel centres",
                {},
                families::sliver},
      Generator{"tiny", "tiny", "triangles under a pixel, most of them around a pixel centre", {}, families::tiny},
  };
  return all;
}

const Generator* find_generator(std::string_view name) {
  for (const Generator& generator : generators()) {
    if (generator.name == name) return &generator;
  }
  return nullptr;
}

void append_scene(const Generator& generator, std::uint64_t seed, std::uint64_t index, Scene& scene) {
  const Lattice lattice(scene.setting.target, scene.rules.subpixel_bits);
  Random random = Random::stream(seed, generator.name, index);
  generator.append(lattice, random, scene);
}

}  // namespace edgecase::conformance
