// Generators: seed and index in, scenes out. The same arguments give the same triangles on every machine, and scene i
// needs none of the scenes before it, so that a run can be streamed, split, resumed, and any one scene drawn again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "conformance/generators/lattice.h"
#include "conformance/generators/random.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

struct Generator {
  std::string_view name;
  std::string_view category;
  std::string_view about;
  /// Target and samples that the scenes are made for.
  Setting setting;
  /// Appends one scene: its triangles, and a Mesh for each set of them that is watertight. Vertices lie on `lattice`,
  /// but for the categories `float` (window positions off the grid), `viewport` and `clip` (clip space).
  void (*append)(const Lattice& lattice, Random& random, Scene& scene);
  /// Only of generators in clip space: what their scenes' ClipGeometry has.
  std::optional<Viewport> viewport{};
  /// Only of some whose scenes are one triangle each: what append() makes of scenes `first` to `first + count - 1`, in
  /// vectors, because drawing triangle by triangle would cost a driver's tests more than they may take. `family`: what
  /// the scenes' streams are the items of.
  void (*append_each)(const Lattice& lattice, const Random& family, std::uint64_t first, std::size_t count,
                      Scene& scene) = nullptr;
};

/// All generators of window positions, in the order in which they are listed and run.
std::span<const Generator> generators();

/// All generators in clip space. What a rasterizer covers of their triangles is no matter of the rules alone but of a
/// model of its clipper and transform (models/window_scene.h).
std::span<const Generator> clip_generators();

/// The generator of that name, or null.
const Generator* find_generator(std::string_view name);

/// The scenes that a generator makes of one seed. Keeps the generator.
class SceneStream {
 public:
  SceneStream(const Generator& generator, std::uint64_t seed)
      : generator_(generator), random_(Random::of_family(seed, generator.name)) {}

  /// Appends scene number `index` for a rasterizer with `scene.rules.subpixel_bits`, at least 1, to `scene`, whose
  /// setting must be the generator's; a generator in clip space gives the scene its viewport.
  void append(std::uint64_t index, Scene& scene) const;

  /// The same for scenes from number `index` on until `scene` has `triangles` triangles or more; calls begin(number,
  /// its first triangle) before each. Returns the number of the next scene.
  template <class Begin>
  std::uint64_t fill(std::uint64_t index, std::size_t triangles, Scene& scene, const Begin& begin) const {
    std::size_t has = triangle_count(scene);
    if (generator_.append_each != nullptr && has < triangles) {
      append_each(index, triangles - has, scene);
      for (; has < triangles; ++has) begin(index++, has);
    }
    for (; has < triangles; has = triangle_count(scene)) {
      begin(index, has);
      append(index++, scene);
    }
    return index;
  }

 private:
  void append_each(std::uint64_t first, std::size_t count, Scene& scene) const;

  const Generator& generator_;
  Random random_;
};

/// The same for one scene.
void append_scene(const Generator& generator, std::uint64_t seed, std::uint64_t index, Scene& scene);

}  // namespace edgecase::conformance
