#include "conformance/compare/clip_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "conformance/compare/outline.h"
#include "conformance/compare/row_bits.h"

namespace edgecase::conformance {
namespace {

// (x, y, z, w) in binary64.
using Vector = std::array<double, 4>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

std::array<Vector, 6> planes_of(NearPlane near) {
  return {{{1, 0, 0, 1},
           {-1, 0, 0, 1},
           {0, 1, 0, 1},
           {0, -1, 0, 1},
           {0, 0, 1, near == NearPlane::zero ? 0.0 : 1.0},
           {0, 0, -1, 1}}};
}

struct Corner {
  Vector at;
  bool border;  ///< whether the edge that begins here borders on nothing
};
using Polygon = std::vector<Corner>;

// Positions by number, so that edges can be compared as those of a grid are.
class Vertices {
 public:
  GridPoint number(const ClipPosition& p) {
    const std::array key{p.x, p.y, p.z, p.w};
    return {numbers_.try_emplace(key, static_cast<std::int64_t>(numbers_.size())).first->second, 0};
  }

 private:
  std::map<std::array<float, 4>, std::int64_t> numbers_;
};

Polygon cut(const Polygon& polygon, const Vector& plane) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    const double da = dot(a.at, plane);
    const double db = dot(b.at, plane);
    if (da >= 0) result.push_back(a);
    if ((da >= 0) == (db >= 0)) continue;
    Corner crossing{{}, a.border};
    const double t = da / (da - db);
    for (std::size_t k = 0; k < 4; ++k) crossing.at[k] = a.at[k] + t * (b.at[k] - a.at[k]);
    result.push_back(crossing);
  }
  return result;
}

// What can be seen of each triangle. An edge is on the border if the mesh has no neighbour there, or if it lies in a
// plane, because that has cut it or because the neighbour is wholly beyond.
struct Seen {
  std::vector<Polygon> polygons;
  double greatest = 0;  ///< magnitude of a coordinate of the mesh
  double least_w = 0;   ///< of what can be seen
};

Seen seen(NearPlane near, std::span<const ClipTriangle> mesh) {
  Seen result;
  Vertices vertices;
  std::vector<GridTriangle> numbered;
  for (const ClipTriangle& t : mesh) {
    numbered.push_back({vertices.number(t[0]), vertices.number(t[1]), vertices.number(t[2])});
    for (const ClipPosition& p : t) {
      for (const float v : {p.x, p.y, p.z, p.w}) result.greatest = std::max(result.greatest, std::abs(double{v}));
    }
  }
  OutlineBuilder builder;
  const auto outline = builder.build(numbered);
  const double in_plane = std::ldexp(result.greatest, -20);
  const auto planes = planes_of(near);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    Polygon polygon;
    for (std::size_t v = 0; v < 3; ++v) {
      const GridPoint from = numbered[i][v];
      const GridPoint to = numbered[i][(v + 1) % 3];
      const bool border =
          std::ranges::any_of(outline, [&](const OutlineEdge& edge) { return edge.from == from && edge.to == to; });
      const ClipPosition& p = mesh[i][v];
      polygon.push_back({{p.x, p.y, p.z, p.w}, border});
    }
    for (const Vector& plane : planes) polygon = cut(polygon, plane);
    for (const Vector& plane : planes) {
      // A polygon that lies in the plane as a whole is not cut there.
      if (std::ranges::all_of(polygon, [&](const Corner& corner) { return dot(corner.at, plane) == 0; })) continue;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vector& next = polygon[(k + 1) % polygon.size()].at;
        const bool lies_in = std::abs(dot(polygon[k].at, plane)) <= in_plane && std::abs(dot(next, plane)) <= in_plane;
        polygon[k].border = polygon[k].border || lies_in;
      }
    }
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const double w = polygon[k].at[3];
      result.least_w = result.polygons.empty() && k == 0 ? w : std::min(result.least_w, w);
    }
    if (!polygon.empty()) result.polygons.push_back(std::move(polygon));
  }
  return result;
}

std::optional<double> error_of(const Seen& seen, int subpixel_bits, const Viewport& viewport) {
  if (seen.polygons.empty() || !(seen.least_w > 0)) return std::nullopt;
  const double half = std::max(std::abs(double{viewport.width}), std::abs(double{viewport.height})) / 2;
  double end = 0;
  for (const auto& [from, size] : {std::pair{viewport.x, viewport.width}, std::pair{viewport.y, viewport.height}}) {
    end = std::max({end, std::abs(double{from}), std::abs(double{from} + double{size})});
  }
  const double rounding = std::ldexp(96 * seen.greatest / seen.least_w * half + 4 * half + 4 * end, -24);
  const double error = 2 * rounding + std::ldexp(0.5, -subpixel_bits);
  return error < 1 ? std::optional(error) : std::nullopt;
}

struct Point {
  double x;
  double y;
};

// Positive to the right of a -> b on the screen, y down.
double side(const Point& a, const Point& b, const Point& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Whether the square of `reach` around p is off the edge: beyond its bounding box, or wholly on one side of its line.
bool off(const Point& a, const Point& b, const Point& p, double reach) {
  const auto [left, right] = std::minmax(a.x, b.x);
  const auto [top, bottom] = std::minmax(a.y, b.y);
  return p.x + reach < left || p.x - reach > right || p.y + reach < top || p.y - reach > bottom ||
         std::abs(side(a, b, p)) > reach * (right - left + bottom - top);
}

// Pixels first .. end - 1 of one axis.
struct Range {
  int first;
  int end;
};

// Those that lie wholly inside the viewport, and in the target.
Range pixels_inside(float start, float size, int extent) {
  const double from = std::ceil(double{start} + std::min(0.0, double{size}));
  const double to = std::floor(double{start} + std::max(0.0, double{size}));
  return {static_cast<int>(std::clamp(from, 0.0, double{kMaxTargetExtent})),
          static_cast<int>(std::clamp(to, 0.0, static_cast<double>(extent)))};
}

Range pixels_between(const Range& all, double low, double high) {
  return {static_cast<int>(std::clamp<double>(std::floor(low), all.first, kMaxTargetExtent)),
          static_cast<int>(std::clamp<double>(std::floor(high) + 1, 0, all.end))};
}

// The samples of the pixels that a mesh may be asked to cover.
class Samples {
 public:
  Samples(const Setting& setting, const Viewport& viewport)
      : setting_(setting),
        columns_(pixels_inside(viewport.x, viewport.width, setting.target.width)),
        rows_(pixels_inside(viewport.y, viewport.height, setting.target.height)) {}

  /// Visits those in the pixels around `points`, `margin` on each side.
  template <typename Visit>
  void around(std::span<const Point> points, double margin, const Visit& visit) const {
    const auto [left, right] = std::ranges::minmax(points, {}, &Point::x);
    const auto [top, bottom] = std::ranges::minmax(points, {}, &Point::y);
    const Range columns = pixels_between(columns_, left.x - margin, right.x + margin);
    const Range rows = pixels_between(rows_, top.y - margin, bottom.y + margin);
    for (int y = rows.first; y < rows.end; ++y) {
      for (int x = columns.first; x < columns.end; ++x) {
        if (scissored(x, y)) continue;
        for (int s = 0; s < setting_.samples(); ++s) {
          const SampleLocation& at = setting_.sample_locations[static_cast<std::size_t>(s)];
          visit(x, y, s, Point{x + at.x / 16.0, y + at.y / 16.0});
        }
      }
    }
  }

 private:
  bool scissored(int x, int y) const {
    const auto& r = setting_.scissor;
    return r && (x < r->x || x >= std::int64_t{r->x} + r->width || y < r->y || y >= std::int64_t{r->y} + r->height);
  }

  const Setting& setting_;
  Range columns_;
  Range rows_;
};

bool holds(std::span<const Point> polygon, const Point& p) {
  bool right = true;
  bool left = true;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const double value = side(polygon[k], polygon[(k + 1) % polygon.size()], p);
    right = right && value >= 0;
    left = left && value <= 0;
  }
  return right != left;  // both: a polygon without area
}

}  // namespace

void Cracks::add(const Cracks& later) {
  meshes += later.meshes;
  torn_meshes += later.torn_meshes;
  samples_inside += later.samples_inside;
  holes += later.holes;
  doubled += later.doubled;
  if (!first) first = later.first;
}

std::optional<double> border_error(int subpixel_bits, const Viewport& viewport, NearPlane near,
                                   std::span<const ClipTriangle> mesh) {
  return error_of(seen(near, mesh), subpixel_bits, viewport);
}

bool certainly_inside(const Setting& setting, int subpixel_bits, const Viewport& viewport, NearPlane near,
                      std::span<const ClipTriangle> mesh, MutableMaskView inside) {
  std::ranges::fill(inside, 0);
  const Seen visible = seen(near, mesh);
  const auto error = error_of(visible, subpixel_bits, viewport);
  if (!error) return false;
  const MaskLayout layout(setting);
  const Samples samples(setting, viewport);
  std::vector<std::array<Point, 2>> borders;
  std::vector<Point> points;
  for (const Polygon& polygon : visible.polygons) {
    points.clear();
    for (const auto& [at, border] : polygon) {
      points.push_back({viewport.x + (at[0] / at[3] + 1) / 2 * viewport.width,
                        viewport.y + (at[1] / at[3] + 1) / 2 * viewport.height});
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (polygon[k].border) borders.push_back({points[k], points[(k + 1) % points.size()]});
    }
    samples.around(points, 0, [&](int x, int y, int s, const Point& p) {
      if (holds(points, p)) cover(inside, layout.bit(x, y, s));
    });
  }
  for (const auto& border : borders) {
    samples.around(border, *error, [&](int x, int y, int s, const Point& p) {
      const std::size_t bit = layout.bit(x, y, s);
      if (!off(border[0], border[1], p, *error)) inside[bit / 64] &= ~(std::uint64_t{1} << bit % 64);
    });
  }
  return true;
}

void count_cracks(const Setting& setting, MaskView inside, std::span<const std::uint64_t> masks,
                  std::size_t first_triangle, Cracks& total) {
  const MaskLayout layout(setting);
  ++total.meshes;
  bool torn = false;
  for (std::size_t word = 0; word < layout.words(); ++word) {
    std::uint64_t once = 0;
    std::uint64_t twice = 0;
    for (std::size_t i = word; i < masks.size(); i += layout.words()) {
      twice |= once & masks[i];
      once |= masks[i];
    }
    const std::uint64_t holes = inside[word] & ~once;
    const std::uint64_t doubled = inside[word] & twice;
    total.samples_inside += static_cast<std::uint64_t>(std::popcount(inside[word]));
    total.holes += static_cast<std::uint64_t>(std::popcount(holes));
    total.doubled += static_cast<std::uint64_t>(std::popcount(doubled));
    if ((holes | doubled) == 0) continue;
    torn = true;
    if (total.first) continue;
    const int bit = std::countr_zero(holes | doubled);
    const SampleIndex at = sample_index(layout, word * 64 + static_cast<std::size_t>(bit));
    const bool hole = (holes >> bit & 1) != 0;
    total.first = {hole ? WrongSample::Kind::missing : WrongSample::Kind::doubled, first_triangle, at.x, at.y,
                   at.sample};
  }
  if (torn) ++total.torn_meshes;
}

}  // namespace edgecase::conformance
