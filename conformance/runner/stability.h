// Stability: what inexact arithmetics cost, family by family of hard cases, and where each of them first fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/runner/extent_sweep.h"
#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

struct Family {
  std::string name;
  std::string about;
  /// How far its vertices reach, in pixels, if it is one of the sweep over extents.
  std::optional<int> extent;
  /// Scene number `index`, of at least one triangle.
  std::function<Scene(std::uint64_t seed, std::uint64_t index)> scene;
};

/// All families, in the order in which they are shown.
std::vector<Family> families();

/// One subject on one family.
struct StabilityRow {
  std::string subject;
  std::string family;
  std::optional<int> extent;
  std::uint64_t triangles = 0;
  std::uint64_t to_cover = 0;  ///< samples that the rules cover, triangle by triangle
  std::uint64_t wrong = 0;     ///< of those or any others: missing and unexpected
  std::uint64_t meshes = 0;
  std::uint64_t inside = 0;   ///< samples strictly inside meshes
  std::uint64_t gaps = 0;     ///< of these, covered by no triangle
  std::uint64_t doubles = 0;  ///< covered by more than one triangle of a mesh
  std::optional<std::string> refused;

  double wrong_per_million() const;
};

struct Stability {
  std::vector<StabilityRow> rows;  ///< subject by subject, family by family
  struct SubjectLimit {
    std::string subject;
    Limit limit;
  };
  std::vector<SubjectLimit> limits;
};

/// The exact subject and every inexact one.
std::vector<std::string> stability_subjects();

/// Draws `count` triangles of each family, at least, with each of `subjects`; `on_progress` is told how many have been
/// drawn since it was last called.
tl::expected<Stability, Error> measure_stability(std::span<const std::string> subjects, std::uint64_t seed,
                                                 std::uint64_t count,
                                                 const std::function<void(std::uint64_t)>& on_progress);

std::string stability_text(const Stability& stability);
std::string stability_json(const Stability& stability, std::uint64_t seed);

/// The gnuplot program that draws it as PNG to `path`: wrong samples over the extent, and by family.
std::string stability_plot(const Stability& stability, const std::string& path);

}  // namespace edgecase::conformance
