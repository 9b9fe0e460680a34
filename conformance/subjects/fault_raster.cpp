#include "conformance/subjects/fault_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace edgecase::conformance {
namespace {

__extension__ typedef __int128 Wide;

struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

/// `pixels` in units of 2^-bits px.
std::int64_t snap(float pixels, int bits, Fault fault) {
  const double scaled = std::ldexp(static_cast<double>(pixels), bits);
  switch (fault) {
    case Fault::snap_truncate:
      return static_cast<std::int64_t>(std::trunc(scaled));
    case Fault::snap_floor:
      return static_cast<std::int64_t>(std::floor(scaled));
    case Fault::snap_half_up:
      return static_cast<std::int64_t>(std::floor(scaled + 0.5));
    case Fault::snap_half_away:
      return static_cast<std::int64_t>(std::round(scaled));
    default:
      return static_cast<std::int64_t>(std::nearbyint(scaled));
  }
}

/// a*x + b*y + c, positive on the inside of a triangle that is clockwise on the screen.
struct EdgeFunction {
  Wide a;
  Wide b;
  Wide c;
  bool inclusive;  ///< whether a sample with the value 0 is inside
};

EdgeFunction edge_function(const Point& from, const Point& to, Fault fault) {
  EdgeFunction edge{from.y - to.y, to.x - from.x, Wide{from.x} * to.y - Wide{to.x} * from.y, false};
  if (fault == Fault::overflow_c) edge.c = static_cast<std::int32_t>(edge.c);
  const bool left = edge.a > 0;
  const bool right = edge.a < 0;
  const bool top = edge.a == 0 && edge.b > 0;
  const bool bottom = edge.a == 0 && edge.b < 0;
  switch (fault) {
    case Fault::top_exclusive:
      edge.inclusive = left;
      break;
    case Fault::left_exclusive:
      edge.inclusive = top;
      break;
    case Fault::slanted_left_exclusive:
      edge.inclusive = top || (left && edge.b == 0);
      break;
    case Fault::right_inclusive:
      edge.inclusive = top || left || right;
      break;
    case Fault::vertical_right_inclusive:
      edge.inclusive = top || left || (right && edge.b == 0);
      break;
    case Fault::bottom_inclusive:
      edge.inclusive = top || left || bottom;
      break;
    case Fault::flip_turns_rule:
      edge.inclusive = bottom || left;
      break;
    case Fault::all_exclusive:
      edge.inclusive = false;
      break;
    case Fault::all_inclusive:
      edge.inclusive = true;
      break;
    default:
      edge.inclusive = top || left;
      break;
  }
  return edge;
}

/// Pixels left <= x <= right, top <= y <= bottom; empty if the wrong way round.
struct Box {
  std::int64_t left, top, right, bottom;
};

std::optional<Box> scissor_box(const Setting& setting, Fault fault) {
  if (!setting.scissor) return std::nullopt;
  const Rect& r = *setting.scissor;
  if (fault == Fault::scissor_empty_ignored && (r.width <= 0 || r.height <= 0)) return std::nullopt;
  Box box{r.x, r.y, std::int64_t{r.x} + r.width - 1, std::int64_t{r.y} + r.height - 1};
  if (fault == Fault::scissor_short_left) ++box.left;
  if (fault == Fault::scissor_short_top) ++box.top;
  if (fault == Fault::scissor_short_right) --box.right;
  if (fault == Fault::scissor_short_bottom) --box.bottom;
  if (fault == Fault::scissor_wide_left) --box.left;
  if (fault == Fault::scissor_wide_top) --box.top;
  if (fault == Fault::scissor_wide_right || fault == Fault::scissor_inclusive) ++box.right;
  if (fault == Fault::scissor_wide_bottom || fault == Fault::scissor_inclusive) ++box.bottom;
  return box;
}

/// The pixels of the target, and of the scissor, that have a sample, at one of `locations`, inside the bounding box of
/// `points`. All in units of 2^-bits px.
Box pixel_box(const std::array<Point, 3>& points, const std::vector<Point>& locations, const Setting& setting, int bits,
              Fault fault) {
  const auto by_x = [](const Point& p, const Point& q) { return p.x < q.x; };
  const auto by_y = [](const Point& p, const Point& q) { return p.y < q.y; };
  const auto [min_x, max_x] = std::minmax_element(points.begin(), points.end(), by_x);
  const auto [min_y, max_y] = std::minmax_element(points.begin(), points.end(), by_y);
  const auto [first_x, last_x] = std::minmax_element(locations.begin(), locations.end(), by_x);
  const auto [first_y, last_y] = std::minmax_element(locations.begin(), locations.end(), by_y);
  const std::int64_t below_one_pixel = (std::int64_t{1} << bits) - 1;
  const std::int64_t sixteenth = std::int64_t{1} << (bits - kSampleGridBits);
  const std::int64_t least_x = fault == Fault::box_sample_12 ? std::max(first_x->x, sixteenth) : first_x->x;
  const std::int64_t least_y = fault == Fault::box_sample_15 ? std::max(first_y->y, sixteenth) : first_y->y;
  Box box{(min_x->x - last_x->x + below_one_pixel) >> bits, (min_y->y - last_y->y + below_one_pixel) >> bits,
          (max_x->x - least_x) >> bits, (max_y->y - least_y) >> bits};
  if (fault == Fault::box_short_left) ++box.left;
  if (fault == Fault::box_short_top) ++box.top;
  if (fault == Fault::box_short_right) --box.right;
  if (fault == Fault::box_short_bottom) --box.bottom;
  const auto intersect = [&](const Box& other) {
    box = {std::max(box.left, other.left), std::max(box.top, other.top), std::min(box.right, other.right),
           std::min(box.bottom, other.bottom)};
  };
  intersect({0, 0, std::int64_t{setting.target.width} - 1, std::int64_t{setting.target.height} - 1});
  if (const auto scissor = scissor_box(setting, fault)) intersect(*scissor);
  return box;
}

/// Whether a triangle that is wound like that on the screen, and has an area, faces the way that is dropped.
bool is_culled(const Setting& setting, bool clockwise, Fault fault) {
  if (setting.cull == CullMode::none) return false;
  const bool clockwise_front = setting.front_face == FrontFace::clockwise || fault == Fault::front_face_ignored;
  const bool culls_front = (setting.cull == CullMode::front) != (fault == Fault::cull_flipped);
  return (clockwise == clockwise_front) == culls_front;
}

bool clockwise_in_binary32(const Triangle& t) {
  return (t[1].x - t[0].x) * (t[2].y - t[0].y) > (t[2].x - t[0].x) * (t[1].y - t[0].y);
}

std::size_t stored_sample(std::size_t sample, std::size_t samples, Fault fault) {
  const bool swapped =
      (fault == Fault::samples2_swapped && samples == 2) || (fault == Fault::samples4_swapped && samples == 4);
  return swapped && sample < 2 ? 1 - sample : sample;
}

}  // namespace

void draw_with_fault(const Scene& scene, const Triangle& triangle, Fault fault, MutableMaskView mask) {
  const MaskLayout layout(scene.setting);
  // One grid for vertices and sample locations: as fine as the finer of the two.
  const int bits = std::max(scene.rules.subpixel_bits, kSampleGridBits);
  std::array<Point, 3> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const int to_common_grid = bits - scene.rules.subpixel_bits;
    points[i].x = snap(triangle[i].x, scene.rules.subpixel_bits, fault) << to_common_grid;
    points[i].y = snap(triangle[i].y, scene.rules.subpixel_bits, fault) << to_common_grid;
  }
  std::vector<Point> locations;
  for (const SampleLocation& location : scene.setting.sample_locations) {
    locations.push_back(
        {std::int64_t{location.x} << (bits - kSampleGridBits), std::int64_t{location.y} << (bits - kSampleGridBits)});
    if (fault == Fault::corner_sample) locations.back() = {};
  }

  const Wide area = Wide{points[1].x - points[0].x} * (points[2].y - points[0].y) -
                    Wide{points[2].x - points[0].x} * (points[1].y - points[0].y);
  if (area == 0 || (area < 0 && fault == Fault::one_winding)) return;
  const bool clockwise = fault == Fault::cull_before_snap ? clockwise_in_binary32(triangle) : area > 0;
  if (is_culled(scene.setting, clockwise, fault)) return;
  if (area < 0) std::swap(points[1], points[2]);
  const std::array<EdgeFunction, 3> edges{edge_function(points[0], points[1], fault),
                                          edge_function(points[1], points[2], fault),
                                          edge_function(points[2], points[0], fault)};

  const Box box = pixel_box(points, locations, scene.setting, bits, fault);
  for (std::int64_t y = box.top; y <= box.bottom; ++y) {
    for (std::int64_t x = box.left; x <= box.right; ++x) {
      for (std::size_t s = 0; s < locations.size(); ++s) {
        const Wide sample_x = (x << bits) + locations[s].x;
        const Wide sample_y = (y << bits) + locations[s].y;
        const bool inside = std::all_of(edges.begin(), edges.end(), [&](const EdgeFunction& edge) {
          const Wide value = edge.a * sample_x + edge.b * sample_y + edge.c;
          return value > 0 || (value == 0 && edge.inclusive);
        });
        const auto row = static_cast<int>(fault == Fault::y_flipped ? layout.target.height - 1 - y : y);
        if (!inside) continue;
        const std::size_t sample = stored_sample(s, locations.size(), fault);
        cover(mask, layout.bit(static_cast<int>(x), row, static_cast<int>(sample)));
      }
    }
  }
}

}  // namespace edgecase::conformance
