#include "conformance/bench/growth.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "conformance/bench/contender.h"
#include "conformance/bench/progress.h"
#include "conformance/bench/workloads.h"
#include "conformance/generators/lattice.h"
#include "conformance/generators/random.h"
#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

constexpr Extent kScreen{1920, 1080};
constexpr int kSubpixelBits8 = 8;

/// From `first` on, each `factor` times the one before.
std::vector<double> series(double first, double factor, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i, first *= factor) values.push_back(first);
  return values;
}

Scene by_count(double value, std::size_t, std::uint64_t seed) {
  return make_even(kScreen, static_cast<std::size_t>(value), 10, seed);
}

Scene by_area(double value, std::size_t most, std::uint64_t seed) {
  // As many as cover 10^7 px.
  const auto count = static_cast<std::size_t>(std::clamp(1e7 / value, 20.0, static_cast<double>(most)));
  return make_even({4096, 4096}, count, value, seed);
}

Scene by_target(double value, std::size_t most, std::uint64_t seed) {
  const int side = static_cast<int>(value);
  return make_even({side, side}, most, 10, seed);
}

Scene by_full_target(double value, std::size_t, std::uint64_t) {
  const int side = static_cast<int>(value);
  const auto s = static_cast<float>(side);
  Scene scene;
  scene.setting.target = {side, side};
  scene.triangles = {{{{0, 0}, {s, 0}, {s, s}}}, {{{0, 0}, {s, s}, {0, s}}}};
  return scene;
}

Scene by_samples(double value, std::size_t most, std::uint64_t seed) {
  Scene scene = make_even({64, 64}, std::min<std::size_t>(most, 2'000), 200, seed);
  const auto locations = standard_sample_locations(static_cast<int>(value));
  scene.setting.sample_locations.assign(locations.begin(), locations.end());
  return scene;
}

/// Every triangle has its three vertices `value` px away from the centre of the target, half of which it covers, as one
/// of its edges passes within a few pixels of that centre.
Scene by_range(double value, std::size_t most, std::uint64_t seed) {
  Scene scene;
  scene.setting.target = {64, 64};
  const Lattice lattice(scene.setting.target, kSubpixelBits8);
  Random random = Random::stream(seed, "range", 0);
  const double pixel = static_cast<double>(lattice.pixel());
  for (std::size_t i = 0; i < most; ++i) {
    const double turn = static_cast<double>(random.between(0, 1 << 20)) / (1 << 20) * 2 * std::numbers::pi;
    const auto vertex = [&](double angle) {
      const auto coordinate = [&](double direction) {
        return static_cast<std::int64_t>((32 + value * direction) * pixel) + random.between(-1024, 1024);
      };
      const std::int64_t x = coordinate(std::cos(angle));
      return LatticePoint{x, coordinate(std::sin(angle))};
    };
    const LatticePoint a = vertex(turn), b = vertex(turn + std::numbers::pi / 2), c = vertex(turn + std::numbers::pi);
    scene.triangles.push_back(lattice.triangle(a, b, c));
  }
  return scene;
}

std::vector<GrowthAxis> make_axes() {
  return {
      {"triangles", "Triangles of 10 px anywhere on 1920x1080 pixels", "number of triangles",
       "Slope 1: each triangle is work of its own, and a list that has outgrown the caches is still read fast "
       "enough.",
       series(1e3, 10, 5), by_count, true},
      {"area", "Triangles of one area anywhere on 4096x4096 pixels", "area in px",
       "Flat where setting up a triangle is all; then 1/2 where the work goes with the rows or blocks along its "
       "outline,\\n"
       "and 1 where it goes with its pixels: at once for the plain loop, late for those that fill whole words.",
       series(0.1, 10, 8), by_area},
      {"target", "Triangles of 10 px anywhere on a square target", "side of the target in px",
       "Slope 0: nothing is done for pixels outside of a triangle. A rise is memory: the mask has outgrown a cache, "
       "and a\\n"
       "byte per pixel does so 8 times as early as a bit.",
       series(64, 4, 5), by_target},
      {"full", "Two triangles that share the diagonal of a square target", "side of the target in px",
       "Slope 2: the work is the pixels, or their words, and both grow with the square. Less on the left, where "
       "setting\\n"
       "up is all; more on the right, where the mask outgrows the caches: with a bit per pixel it is 32 MB at 16384.",
       series(64, 4, 5), by_full_target},
      {"samples", "Triangles of 200 px, a mask each, clearing included", "samples a pixel",
       "At most slope 1: edges are set up once, each sample is drawn on its own. One sample in the centre has code "
       "of\\n"
       "its own; the step to two is that to the code for all patterns, and to bringing a pixel's samples together.",
       series(1, 2, 5), by_samples, false, true},
      {"range", "Triangles that cover half of 64x64 pixels, their vertices farther and farther away",
       "distance of the vertices in px",
       "Slope 0: what lies outside of the target costs nothing, and only the width of the numbers grows. A step is "
       "the\\n"
       "distance from which 32 bits no longer hold an edge function, or a triangle takes the path for wider ones.",
       series(64, 4, 5), by_range},
  };
}

/// Whether scenes of that many triangles can be held, by the scene and by each of the contenders.
bool fits_into_memory(double triangles, std::size_t contenders) {
  const double available = static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return triangles * sizeof(Triangle) * static_cast<double>(contenders + 1) < available / 2;
}

using MakeSubject = std::function<tl::expected<std::unique_ptr<Subject>, Error>(const std::string&)>;

tl::expected<std::vector<std::unique_ptr<Contender>>, Error> contenders_of(const GrowthAxis& axis,
                                                                           const MakeSubject& make_subject) {
  std::vector<std::unique_ptr<Contender>> chosen;
  if (axis.by_subjects) {
    for (const char* name : {"edgecase:scalar", "edgecase"}) {
      auto subject = make_subject(name);
      if (!subject) return tl::unexpected(subject.error());
      chosen.push_back(make_subject_contender(std::move(*subject)));
    }
    return chosen;
  }
  constexpr std::array<std::string_view, 5> kNames{kPlain, "edgecase:trapezoid", "edgecase:sse4", "edgecase:avx2",
                                                   "edgecase"};
  auto built_in = built_in_contenders();
  for (const std::string_view name : kNames) {
    const auto found = std::ranges::find_if(built_in, [&](const auto& c) { return c && c->name() == name; });
    if (found != built_in.end()) chosen.push_back(std::move(*found));
  }
  return chosen;
}

tl::expected<void, Error> measure_point(const GrowthAxis& axis, double value, const GrowthEffort& effort,
                                        std::uint64_t seed, const MakeSubject& make_subject,
                                        std::vector<GrowthPoint>& points) {
  const auto contenders = contenders_of(axis, make_subject);
  if (!contenders) return tl::unexpected(contenders.error());
  if (axis.name == "triangles" &&
      (value > static_cast<double>(effort.most_on_triangles_axis) || !fits_into_memory(value, contenders->size()))) {
    return {};
  }
  const Scene scene = axis.scene(value, effort.most_triangles, seed);
  for (const auto& contender : *contenders) {
    if (auto prepared = contender->prepare(scene); !prepared) return prepared;
    contender->clear();
    if (auto drawn = contender->draw(); !drawn) return drawn;
  }
  const auto seconds = time_draws(*contenders, effort.repetitions);
  if (!seconds) return tl::unexpected(seconds.error());
  for (std::size_t i = 0; i < contenders->size(); ++i) {
    const auto& contender = *(*contenders)[i];
    points.push_back({std::string(axis.name), value, contender.name(), contender.isa(), scene.triangles.size(),
                      (*seconds)[i].median * 1e9 / static_cast<double>(scene.triangles.size()), (*seconds)[i].spread});
  }
  return {};
}

}  // namespace

std::span<const GrowthAxis> growth_axes() {
  static const std::vector<GrowthAxis> axes = make_axes();
  return axes;
}

tl::expected<std::vector<GrowthPoint>, Error> measure_growth(const GrowthEffort& effort, std::uint64_t seed,
                                                             const MakeSubject& make_subject) {
  std::size_t steps = 0, done = 0;
  for (const GrowthAxis& axis : growth_axes()) steps += axis.values.size();
  const Progress progress(steps, "points");
  std::vector<GrowthPoint> points;
  for (const GrowthAxis& axis : growth_axes()) {
    for (const double value : axis.values) {
      progress.show(done++, axis.name);
      if (auto measured = measure_point(axis, value, effort, seed, make_subject, points); !measured) {
        return tl::unexpected(measured.error());
      }
    }
  }
  return points;
}

}  // namespace edgecase::conformance
