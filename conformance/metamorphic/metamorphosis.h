// Metamorphic checks: changes of a scene after which what it covers is known from what it covered before, whatever that
// was. They need no reference, and no fill rule: every rasterizer that has a fill rule at all has to pass them.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "conformance/generators/lattice.h"
#include "conformance/generators/random.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Triangle `triangle` of variant `variant` covers a part of what triangle `base` of the base scene covers: its pixel
/// (x, y) stands for pixel (x + dx, y + dy) there.
struct Piece {
  std::size_t base = 0;
  std::size_t variant = 0;
  std::size_t triangle = 0;
  int dx = 0;
  int dy = 0;
};

/// A scene drawn as it is, and drawn again in other ways. Every target is at most 64 pixels wide, with one sample a
/// pixel.
struct Experiment {
  Scene base;
  std::vector<Scene> variants;
  /// Ordered by `base`. Every pixel of the base scene's target that some piece's target shows is covered by exactly one
  /// of the pieces if the base triangle covers it, and by none if not.
  std::vector<Piece> pieces;
};

struct Metamorphosis {
  std::string_view name;
  std::string_view about;
  /// Fills `variants` and `pieces` for `base`, whose vertices lie on `lattice`; it may move them by a lattice unit.
  void (*pose)(const Lattice& lattice, Random& random, Experiment& experiment);
};

/// All of them, in the order in which they are listed and run.
std::span<const Metamorphosis> metamorphoses();

/// The metamorphosis of that name, or null.
const Metamorphosis* find_metamorphosis(std::string_view name);

/// An experiment on about `triangles` triangles out of the generators that stay near the target, for a rasterizer that
/// snaps as `rules` say. The same arguments give the same experiment; they agree in no part for different `index`es.
Experiment make_experiment(const Metamorphosis& metamorphosis, const Rules& rules, std::uint64_t seed,
                           std::uint64_t index, std::size_t triangles);

/// One base triangle's pieces put together, in the layout of the base scene.
struct Composition {
  std::vector<std::uint64_t> covered;  ///< by one piece or more
  std::vector<std::uint64_t> doubled;  ///< by two or more
  std::vector<std::uint64_t> hidden;   ///< shown by no piece's target
};

/// Puts `pieces`, all those of one base triangle, together. `masks` has a batch for each variant.
void compose(const Experiment& experiment, std::span<const Piece> pieces, std::span<const MaskBatch> masks,
             Composition& composition);

}  // namespace edgecase::conformance
