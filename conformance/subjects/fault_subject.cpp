#include "conformance/subjects/fault_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace edgecase::conformance {
namespace {

enum class Fault {
  none,
  top_exclusive,
  left_exclusive,
  slanted_left_exclusive,
  right_inclusive,
  vertical_right_inclusive,
  bottom_inclusive,
  all_exclusive,
  all_inclusive,
  snap_truncate,
  snap_floor,
  snap_half_up,
  snap_half_away,
  box_short_left,
  box_short_right,
  box_short_top,
  box_short_bottom,
  overflow_c,
  y_flipped,
  corner_sample,
  one_winding,
};

struct PlantedFault {
  Fault fault;
  FaultInfo info;
};

constexpr std::string_view kOffGrid = "vertices between two grid points, as clipping and transforms leave them";
constexpr std::string_view kOffGridTies = "vertices exactly half way between two grid points";
constexpr std::string_view kAnyTriangle = "almost any triangle that touches a sample at that side of its bounding box";

constexpr PlantedFault kPlanted[] = {
    {Fault::top_exclusive,
     {"top-exclusive", "samples on a top edge are left out", "a horizontal edge through sample points, inside below"}},
    {Fault::left_exclusive,
     {"left-exclusive", "samples on a left edge are left out", "a left edge of any slope through sample points"}},
    {Fault::slanted_left_exclusive,
     {"slanted-left-exclusive", "only exactly vertical edges count as left edges",
      "a left edge that is not vertical, through sample points"}},
    {Fault::right_inclusive,
     {"right-inclusive", "the bias is missing on right edges, samples on them are covered",
      "a right edge of any slope through sample points; doubles in a mesh"}},
    {Fault::vertical_right_inclusive,
     {"vertical-right-inclusive", "the bias is missing on vertical right edges only",
      "a vertical right edge through sample points"}},
    {Fault::bottom_inclusive,
     {"bottom-inclusive", "the bias is missing on bottom edges, samples on them are covered",
      "a horizontal edge through sample points, inside above; doubles in a mesh"}},
    {Fault::all_exclusive,
     {"all-exclusive", "> for >=: samples on any edge are left out", "any edge through sample points; gaps in a mesh"}},
    {Fault::all_inclusive,
     {"all-inclusive", "no bias at all: samples on any edge are covered",
      "any edge through sample points; doubles in a mesh"}},
    {Fault::snap_truncate, {"snap-truncate", "vertices are snapped by truncation towards zero", kOffGrid}},
    {Fault::snap_floor, {"snap-floor", "vertices are snapped downwards", kOffGrid}},
    {Fault::snap_half_up, {"snap-half-up", "snapping moves ties upwards instead of to even", kOffGridTies}},
    {Fault::snap_half_away, {"snap-half-away", "snapping moves ties away from zero instead of to even", kOffGridTies}},
    {Fault::box_short_left, {"box-short-left", "the bounding box lacks its leftmost column", kAnyTriangle}},
    {Fault::box_short_right, {"box-short-right", "the bounding box lacks its rightmost column", kAnyTriangle}},
    {Fault::box_short_top, {"box-short-top", "the bounding box lacks its top row", kAnyTriangle}},
    {Fault::box_short_bottom, {"box-short-bottom", "the bounding box lacks its bottom row", kAnyTriangle}},
    {Fault::overflow_c,
     {"overflow-c", "the constant c of the edge functions is kept in 32 bits",
      "coordinates whose products reach 2^31 subpixels, 181 px at 8 bits"}},
    {Fault::y_flipped, {"y-flipped", "rows are written bottom to top", "any coverage that is not symmetric"}},
    {Fault::corner_sample,
     {"corner-sample", "samples are taken in the pixel's top-left corner", "any edge between a centre and its corner"}},
    {Fault::one_winding, {"one-winding", "counter-clockwise triangles are dropped", "triangles of both windings"}},
};

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
  Box box{(min_x->x - last_x->x + below_one_pixel) >> bits, (min_y->y - last_y->y + below_one_pixel) >> bits,
          (max_x->x - first_x->x) >> bits, (max_y->y - first_y->y) >> bits};
  if (fault == Fault::box_short_left) ++box.left;
  if (fault == Fault::box_short_top) ++box.top;
  if (fault == Fault::box_short_right) --box.right;
  if (fault == Fault::box_short_bottom) --box.bottom;
  const auto intersect = [&](std::int64_t x, std::int64_t y, std::int64_t width, std::int64_t height) {
    box = {std::max(box.left, x), std::max(box.top, y), std::min(box.right, x + width - 1),
           std::min(box.bottom, y + height - 1)};
  };
  intersect(0, 0, setting.target.width, setting.target.height);
  if (const auto& scissor = setting.scissor) intersect(scissor->x, scissor->y, scissor->width, scissor->height);
  return box;
}

/// Whether a triangle whose doubled area, positive if clockwise on the screen, is not 0 faces the way that is dropped.
bool is_culled(const Setting& setting, const Wide& area) {
  if (setting.cull == CullMode::none) return false;
  const bool faces_front = setting.front_face == FrontFace::clockwise ? area > 0 : area < 0;
  return setting.cull == CullMode::front ? faces_front : !faces_front;
}

void draw_triangle(const Scene& scene, const Triangle& triangle, Fault fault, MutableMaskView mask) {
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
  if (area == 0 || (area < 0 && fault == Fault::one_winding) || is_culled(scene.setting, area)) return;
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
        if (inside) cover(mask, layout.bit(static_cast<int>(x), row, static_cast<int>(s)));
      }
    }
  }
}

class FaultSubject : public Subject {
 public:
  FaultSubject(Fault fault, std::string_view name) : fault_(fault) {
    info_.name = fmt::format("fault:{}", name);
    info_.follows_scene_rules = true;
    info_.sample_counts.resize(16);
    std::iota(info_.sample_counts.begin(), info_.sample_counts.end(), 1);
    info_.max_coordinate = 32768.0 - 1.0 / 256;
    info_.scissor = true;
    info_.cull = true;
    info_.assembly = true;
  }

  const SubjectInfo& info() const override { return info_; }

  std::optional<std::string> refusal(const Scene& scene) const override {
    if (scene.rules.rounding != SnapRounding::nearest_even || scene.rules.half_pixel_first) {
      return "snaps to nearest even only";
    }
    return Subject::refusal(scene);
  }

  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    masks.reset(MaskLayout(scene.setting), scene.triangles.size());
    std::fill(masks.data().begin(), masks.data().end(), std::uint64_t{0});
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      draw_triangle(scene, scene.triangles[i], fault_, masks[i]);
    }
    return {};
  }

 private:
  Fault fault_;
  SubjectInfo info_;
};

constexpr auto kInfos = [] {
  std::array<FaultInfo, std::size(kPlanted)> infos;
  std::transform(std::begin(kPlanted), std::end(kPlanted), infos.begin(),
                 [](const auto& planted) { return planted.info; });
  return infos;
}();

}  // namespace

std::span<const FaultInfo> faults() { return kInfos; }

std::unique_ptr<Subject> make_fault_subject(std::string_view name) {
  const auto planted = std::find_if(std::begin(kPlanted), std::end(kPlanted),
                                    [&](const PlantedFault& candidate) { return candidate.info.name == name; });
  if (planted == std::end(kPlanted)) return nullptr;
  return std::make_unique<FaultSubject>(planted->fault, name);
}

std::unique_ptr<Subject> make_faultless_subject() { return std::make_unique<FaultSubject>(Fault::none, "none"); }

}  // namespace edgecase::conformance
