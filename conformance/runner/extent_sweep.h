// How far out a rasterizer stays exact: triangles that reach a given distance, and the largest distance without a
// fault.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "conformance/compare/compare.h"
#include "conformance/runner/known_deviations.h"
#include "conformance/runner/reference.h"
#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// The largest extent that is tried, in pixels: up to it every grid coordinate of 16.8 is exact in binary32.
inline constexpr int kLargestExtent = 65536;

/// `triangles` triangles over a 32x32 target with vertices on the grid of `rules`, at most `extent` grid units from the
/// origin on either axis. One coordinate of each triangle is exactly +-extent. Of half of the triangles an edge goes
/// exactly through a pixel centre, if the extent lets them. An eighth are right angles with two vertices as far out to
/// the left or above as may be, and a third within 64.5 px: rasterizers that work in tiles of 64 px know of those edges
/// only how they pass one tile (models/llvmpipe_wrap.h).
Scene extent_scene(const Rules& rules, std::int64_t extent, std::uint64_t seed, std::size_t triangles);

/// What a subject made of one scene.
struct Measured {
  Comparison comparison;
  std::uint64_t to_cover = 0;  ///< samples that the rules cover
  std::optional<std::string> refused;
};

/// Leaves the subject's masks in `observed`.
tl::expected<Measured, Error> measure_scene(const Scene& scene, Subject& subject, Reference& reference,
                                            MaskBatch& observed);

struct Limit {
  /// Exact up to this extent in grid units; 0 if not even one pixel.
  std::int64_t exact = 0;
  /// Up to this one exact or wrong as the known deviation predicts to the last sample; not less than `exact`.
  std::int64_t explained = 0;
  std::int64_t grid_units = 256;  ///< in a pixel
  /// At the extent after `explained` it refuses to draw, with that reason; otherwise it draws wrong samples there, or,
  /// if that is kLargestExtent, nothing larger was tried.
  std::optional<std::string> refused;

  double pixels() const { return static_cast<double>(exact) / static_cast<double>(grid_units); }
  double explained_pixels() const { return static_cast<double>(explained) / static_cast<double>(grid_units); }
};

/// Bisects for the largest extent at which `triangles` triangles leave no sample wrong, and then for the largest at
/// which they leave none that `deviation`, which may be null, does not predict; taking for granted that what fails at
/// one extent fails at every larger one.
tl::expected<Limit, Error> find_limit(Subject& subject, const Rules& rules, Reference& reference,
                                      const KnownDeviation* deviation, std::uint64_t seed, std::size_t triangles);

/// "exact to ±8,192 px; beyond: not accepted", or "exact to ±2,847 px, as its known deviation predicts to ±8,192 px;
/// beyond: not accepted"
std::string describe_limit(const Limit& limit);

}  // namespace edgecase::conformance
