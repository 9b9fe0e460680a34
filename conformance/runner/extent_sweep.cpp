#include "conformance/runner/extent_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "conformance/generators/lattice.h"
#include "conformance/generators/random.h"

namespace edgecase::conformance {
namespace {

// A vertex and its mirror image in the centre of a pixel of the target, both within the extent: c - (extent - c) ..
// extent on both axes.
std::array<LatticePoint, 2> mirrored(const Lattice& lattice, std::int64_t extent, Random& random) {
  const std::int64_t pixels = std::min<std::int64_t>(32, extent / lattice.pixel());
  const auto centre = [&] { return random.between(0, pixels - 1) * lattice.pixel() + lattice.half_pixel(); };
  const LatticePoint c{centre(), centre()};
  const LatticePoint p{random.between(2 * c.x - extent, extent), random.between(2 * c.y - extent, extent)};
  return {p, {2 * c.x - p.x, 2 * c.y - p.y}};
}

// 32767.99609375 and 8,192: no more digits than there are.
std::string with_thousands(double pixels) {
  const auto whole = static_cast<int>(pixels);
  const std::string text =
      whole < 1000 ? fmt::format("{}", whole) : fmt::format("{},{:03}", whole / 1000, whole % 1000);
  const std::string fraction = fmt::format("{}", pixels - whole);  // "0" or "0.125"
  return fmt::format("{}{}", text, std::string_view(fraction).substr(1));
}

}  // namespace

Scene extent_scene(const Rules& rules, std::int64_t extent, std::uint64_t seed, std::size_t triangles) {
  Scene scene;
  scene.rules = rules;
  const Lattice lattice(scene.setting.target, rules.subpixel_bits);
  Random random = Random::stream(seed, "extent", static_cast<std::uint64_t>(extent));
  const auto anywhere = [&] { return LatticePoint{random.between(-extent, extent), random.between(-extent, extent)}; };
  while (scene.triangles.size() < triangles) {
    std::array<LatticePoint, 3> points{anywhere(), anywhere(), anywhere()};
    if (extent >= lattice.pixel() && random.one_in(2)) {
      const auto [p, q] = mirrored(lattice, extent, random);
      points[0] = p;
      points[1] = q;
    }
    const std::int64_t far = random.one_in(2) ? extent : -extent;
    (random.one_in(2) ? points[2].x : points[2].y) = far;
    const auto turn = static_cast<std::ptrdiff_t>(random.between(0, 2));
    std::rotate(points.begin(), points.begin() + turn, points.end());
    scene.triangles.push_back(lattice.triangle(points[0], points[1], points[2]));
  }
  return scene;
}

tl::expected<Measured, Error> measure_scene(const Scene& scene, Subject& subject, Reference& reference,
                                            MaskBatch& observed) {
  Measured measured;
  measured.refused = subject.refusal(scene);
  if (measured.refused) return measured;
  MaskBatch must;
  if (auto drawn = subject.draw(scene, observed); !drawn) return tl::unexpected(drawn.error());
  if (auto known = reference.expect(scene, 0, must); !known) return tl::unexpected(known.error());
  compare_masks(MaskLayout(scene.setting), must.data(), {}, observed.data(), 0, measured.comparison);
  for (const std::uint64_t word : must.data()) measured.to_cover += static_cast<std::uint64_t>(std::popcount(word));
  return measured;
}

tl::expected<Limit, Error> find_limit(Subject& subject, const Rules& rules, Reference& reference, std::uint64_t seed,
                                      std::size_t triangles) {
  Limit limit;
  limit.grid_units = std::int64_t{1} << rules.subpixel_bits;
  std::optional<Error> failure;
  MaskBatch observed;
  // Whether it is exact at `extent`; leaves in `limit` why it is not.
  const auto exact_at = [&](std::int64_t extent) {
    const auto measured = measure_scene(extent_scene(rules, extent, seed, triangles), subject, reference, observed);
    if (!measured) failure = measured.error();
    if (!measured || measured->refused || !measured->comparison.all_right()) {
      limit.refused = measured ? measured->refused : std::nullopt;
      return false;
    }
    limit.exact = extent;
    return true;
  };
  std::int64_t bad = limit.grid_units;
  while (exact_at(bad) && bad < kLargestExtent * limit.grid_units) bad *= 2;
  while (!failure && limit.exact != 0 && bad - limit.exact > 1) {
    const std::int64_t middle = limit.exact + (bad - limit.exact) / 2;
    const std::optional<std::string> refused_at_bad = limit.refused;
    if (exact_at(middle)) {
      limit.refused = refused_at_bad;
    } else {
      bad = middle;
    }
  }
  if (failure) return tl::unexpected(*failure);
  return limit;
}

std::string describe_limit(const Limit& limit) {
  if (limit.exact == 0)
    return limit.refused ? fmt::format("not accepted at ±1 px: {}", *limit.refused) : "wrong at ±1 px already";
  const bool everything = limit.exact == kLargestExtent * limit.grid_units;
  return fmt::format("exact to ±{} px; beyond: {}", with_thousands(limit.pixels()),
                     limit.refused ? "not accepted"
                     : everything  ? "not tried"
                                   : "wrong samples");
}

}  // namespace edgecase::conformance
