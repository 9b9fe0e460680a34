#include "conformance/runner/extent_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "conformance/generators/lattice.h"
#include "conformance/generators/random.h"
#include "conformance/runner/judge.h"

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

// A right angle between the target's upper left and the points furthest out there; half of the time it is the largest.
std::array<LatticePoint, 3> far_corner(const Lattice& lattice, std::int64_t extent, Random& random) {
  const std::int64_t end = std::min(64 * lattice.pixel() + lattice.half_pixel(), extent);
  const auto far = [&] { return random.one_in(2) ? -extent : random.between(-extent, 0); };
  const auto near = [&] { return random.one_in(2) ? end : random.between(0, end); };
  LatticePoint first{far(), far()};
  (random.one_in(2) ? first.x : first.y) = -extent;
  const LatticePoint last{near(), near()};
  const LatticePoint above{last.x, first.y};
  const LatticePoint left{first.x, last.y};
  switch (random.between(0, 2)) {
    case 0:
      return {first, above, last};
    case 1:
      return {first, left, last};
    default:
      return {above, left, last};
  }
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
    if (random.one_in(8)) points = far_corner(lattice, extent, random);
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

tl::expected<Limit, Error> find_limit(Subject& subject, const Rules& rules, Reference& reference,
                                      const KnownDeviation* deviation, std::uint64_t seed, std::size_t triangles) {
  Limit limit;
  limit.grid_units = std::int64_t{1} << rules.subpixel_bits;
  Judge judge(subject, reference, deviation);
  // The largest extent from `good` on, which is so itself or is 0, at which `fits` says so of the outcome; why the next
  // larger one is refused is left in `limit`.
  const auto largest = [&](std::int64_t good, auto&& fits) -> tl::expected<std::int64_t, Error> {
    std::optional<Error> failure;
    const auto fits_at = [&](std::int64_t extent) {
      const Batch batch{extent_scene(rules, extent, seed, triangles), {}, {}};
      limit.refused = judge.refusal(batch.scene);
      if (limit.refused) return false;
      Outcome outcome;
      if (auto judged = judge.judge(batch, 0, outcome); !judged) failure = judged.error();
      return !failure && fits(outcome);
    };
    const std::int64_t most = kLargestExtent * limit.grid_units;
    std::int64_t bad = std::max(2 * good, limit.grid_units);
    while (fits_at(bad)) {
      if (bad == most) return most;
      good = std::exchange(bad, std::min(2 * bad, most));
    }
    while (!failure && good != 0 && bad - good > 1) {
      const std::int64_t middle = good + (bad - good) / 2;
      std::optional<std::string> refused_at_bad = limit.refused;
      if (fits_at(middle)) {
        good = middle;
        limit.refused = std::move(refused_at_bad);
      } else {
        bad = middle;
      }
    }
    if (failure) return tl::unexpected(*failure);
    return good;
  };
  const auto exact = largest(0, [](const Outcome& outcome) { return outcome.triangles.all_right(); });
  if (!exact) return tl::unexpected(exact.error());
  limit.exact = limit.explained = *exact;
  if (deviation == nullptr || limit.refused) return limit;
  const auto explained = largest(*exact, [](const Outcome& outcome) { return outcome.unexplained == 0; });
  if (!explained) return tl::unexpected(explained.error());
  limit.explained = *explained;
  return limit;
}

std::string describe_limit(const Limit& limit) {
  if (limit.explained == 0 && limit.refused) return fmt::format("not accepted at ±1 px: {}", *limit.refused);
  std::string text =
      limit.exact == 0 ? "wrong at ±1 px already" : fmt::format("exact to ±{} px", with_thousands(limit.pixels()));
  if (limit.explained == 0) return text;
  if (limit.explained > limit.exact) {
    text += fmt::format(", as its known deviation predicts to ±{} px", with_thousands(limit.explained_pixels()));
  }
  const bool everything = limit.explained == kLargestExtent * limit.grid_units;
  return fmt::format("{}; beyond: {}", text,
                     limit.refused ? "not accepted"
                     : everything  ? "not tried"
                                   : "wrong samples");
}

}  // namespace edgecase::conformance
