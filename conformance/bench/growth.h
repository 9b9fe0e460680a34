// Growth: how the time of a draw grows along one axis at a time, everything else being equal.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/bench/timing.h"
#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

struct GrowthAxis {
  std::string_view name;   ///< in JSON and file names
  std::string_view title;  ///< what is drawn
  std::string_view label;  ///< of the axis, with the unit
  /// Why the lines rise as they do, in lines that fit under a picture.
  std::string_view slope;
  /// From least to greatest, a geometric series.
  std::vector<double> values;
  /// The triangles at one value; at most `most` of them where their number is free.
  Scene (*scene)(double value, std::size_t most, std::uint64_t seed);
  /// Whether a picture shows the time of the whole draw rather than that of a triangle.
  bool whole_draw = false;
  /// Whether it is subjects that draw, a mask per triangle: the only ones that take samples.
  bool by_subjects = false;
};

/// triangles, area, target, full, samples, range.
std::span<const GrowthAxis> growth_axes();

struct GrowthPoint {
  std::string axis;
  double value = 0;
  std::string rasterizer;
  std::string isa;
  std::size_t triangles = 0;
  double ns_per_triangle = 0;
  double spread = 0;  ///< as in BenchRow
};

struct GrowthEffort {
  Repetitions repetitions;
  /// Of a scene whose number of triangles is free.
  std::size_t most_triangles;
  /// Values beyond are left out; so are those for which the memory does not suffice.
  std::size_t most_on_triangles_axis;
};
inline constexpr GrowthEffort kQuickGrowth{{3, 0.002}, 2'000, 100'000};
inline constexpr GrowthEffort kThoroughGrowth{{5, 0.02}, 50'000, 10'000'000};

/// Axis by axis, value by value, the rasterizers of a value interleaved.
tl::expected<std::vector<GrowthPoint>, Error> measure_growth(
    const GrowthEffort& effort, std::uint64_t seed,
    const std::function<tl::expected<std::unique_ptr<Subject>, Error>(const std::string&)>& make_subject);

/// The exponent of a rasterizer's line, of the time as the picture shows it: the least squares' fit of a straight line
/// to the logarithms. 0 for fewer than two points.
double slope_of(const GrowthAxis& axis, std::span<const GrowthPoint> points, std::string_view rasterizer);

/// {"points": [...]}, an object per point with the fields' names as keys, indented.
std::string growth_json(std::span<const GrowthPoint> points);

/// The exponent between the last two values alone: where a line bends, what it comes to.
double last_slope_of(const GrowthAxis& axis, std::span<const GrowthPoint> points, std::string_view rasterizer);

/// For each axis a line per value and a column per rasterizer, the slopes, and why they are so.
std::string growth_table(std::span<const GrowthPoint> points);

/// The gnuplot program for the picture of one axis, a PNG at `path`.
std::string growth_plot_program(const GrowthAxis& axis, std::span<const GrowthPoint> points, const std::string& path);

}  // namespace edgecase::conformance
