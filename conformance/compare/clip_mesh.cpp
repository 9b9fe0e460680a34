#include "conformance/compare/clip_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "conformance/compare/outline.h"
#include "conformance/compare/row_bits.h"
#include "conformance/compare/row_intervals.h"

namespace edgecase::conformance {
namespace {

using namespace rows;

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
// A triangle that six planes have cut. Of n corners, k inside, a cut leaves these and a new one wherever an edge
// crosses the plane, at most 2 min(k, n - k) times, should rounding have bent the polygon: 3n/2 in all, and so 4, 6, 9,
// 13, 19, 28.
using Polygon = boost::container::static_vector<Corner, 28>;

// The position's 128 bits as a point, so that edges can be compared as those of a grid are; -0 as 0.
GridPoint as_point(const ClipPosition& p) {
  const auto bits = [](float v) { return std::uint64_t{std::bit_cast<std::uint32_t>(v + 0.0F)}; };
  return {std::bit_cast<std::int64_t>(bits(p.x) << 32 | bits(p.y)),
          std::bit_cast<std::int64_t>(bits(p.z) << 32 | bits(p.w))};
}

Polygon cut(const Polygon& polygon, const Vector& plane) {
  if (std::ranges::none_of(polygon, [&](const Corner& corner) { return dot(corner.at, plane) < 0; })) return polygon;
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
  for (const ClipTriangle& t : mesh) {
    for (const ClipPosition& p : t) {
      for (const float v : {p.x, p.y, p.z, p.w}) result.greatest = std::max(result.greatest, std::abs(double{v}));
    }
  }
  std::vector<GridTriangle> points;
  points.reserve(mesh.size());
  for (const ClipTriangle& t : mesh) points.push_back({as_point(t[0]), as_point(t[1]), as_point(t[2])});
  OutlineBuilder builder;
  const auto outline = builder.build(points);
  const double in_plane = std::ldexp(result.greatest, -20);
  result.polygons.reserve(mesh.size());
  const auto add = [&](const Polygon& polygon) {
    double least_w = polygon.front().at[3];
    for (const Corner& corner : polygon) least_w = std::min(least_w, corner.at[3]);
    result.least_w = result.polygons.empty() ? least_w : std::min(result.least_w, least_w);
    result.polygons.push_back(polygon);
  };
  const auto planes = planes_of(near);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    Polygon polygon;
    for (std::size_t v = 0; v < 3; ++v) {
      const GridPoint from = points[i][v];
      const GridPoint to = points[i][(v + 1) % 3];
      const bool border =
          std::ranges::any_of(outline, [&](const OutlineEdge& edge) { return edge.from == from && edge.to == to; });
      const ClipPosition& p = mesh[i][v];
      polygon.push_back({{p.x, p.y, p.z, p.w}, border});
    }
    // What lies further than that inside of a plane is neither cut by it nor borders on it.
    boost::container::static_vector<Vector, 6> near_planes;
    std::ranges::copy_if(planes, std::back_inserter(near_planes), [&](const Vector& plane) {
      return std::ranges::any_of(polygon, [&](const Corner& corner) { return dot(corner.at, plane) <= in_plane; });
    });
    for (const Vector& plane : near_planes) polygon = cut(polygon, plane);
    for (const Vector& plane : near_planes) {
      // A polygon that lies in the plane as a whole is not cut there.
      if (std::ranges::all_of(polygon, [&](const Corner& corner) { return dot(corner.at, plane) == 0; })) continue;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vector& next = polygon[(k + 1) % polygon.size()].at;
        const bool lies_in = std::abs(dot(polygon[k].at, plane)) <= in_plane && std::abs(dot(next, plane)) <= in_plane;
        polygon[k].border = polygon[k].border || lies_in;
      }
    }
    if (!polygon.empty()) add(polygon);
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

// Pixels first .. end - 1 of one axis; none if they are equal.
struct Range {
  int first;
  int end;
};

// Those of `all` whose sample lies in `points`, of which the sample's place in its pixel has been taken away.
Range pixels_between(const Range& all, const Interval& points) {
  const double first = std::clamp<double>(std::ceil(points.from), all.first, all.end);
  return {static_cast<int>(first), static_cast<int>(std::clamp<double>(std::floor(points.to) + 1, first, all.end))};
}

// Those that lie wholly inside the viewport, and in the target.
Range pixels_inside(float start, float size, int extent) {
  const double end = double{start} + double{size};
  return pixels_between({0, extent}, {std::min<double>(start, end), std::max<double>(start, end) - 1});
}

// The samples that a mesh may be asked to cover.
class Samples {
 public:
  Samples(const Setting& setting, const Viewport& viewport)
      : setting_(setting),
        layout_(setting),
        columns_(pixels_inside(viewport.x, viewport.width, setting.target.width)),
        rows_(pixels_inside(viewport.y, viewport.height, setting.target.height)) {
    if (64 % setting.samples() == 0) {
      for (int bit = 0; bit < 64; bit += setting.samples()) every_pixel_ |= std::uint64_t{1} << bit;
    }
    if (!setting.scissor) return;
    const Rect& r = *setting.scissor;
    columns_ = pixels_between(columns_, {double(r.x), double(r.x) + r.width - 1});
    rows_ = pixels_between(rows_, {double(r.y), double(r.y) + r.height - 1});
  }

  /// Calls change(word, bits) for the words of a mask in which `area` holds samples, and those.
  template <class Area, class Change>
  void in(const Area& area, const Change& change) const {
    for (int s = 0; s < setting_.samples(); ++s) {
      const SampleLocation& at = setting_.sample_locations[static_cast<std::size_t>(s)];
      const double dx = at.x / 16.0, dy = at.y / 16.0;
      const Range rows = pixels_between(rows_, {area.y().from - dy, area.y().to - dy});
      for (int row = rows.first; row < rows.end; ++row) {
        const Interval x = area.at(row + dy);
        const Range columns = pixels_between(columns_, {x.from - dx, x.to - dx});
        for_each_word(row, s, columns, change);
      }
    }
  }

 private:
  // Word by word if each of them begins with a pixel, as it does if samples are a power of two.
  template <class Change>
  void for_each_word(int row, int sample, const Range& columns, const Change& change) const {
    if (every_pixel_ == 0) {
      for (int column = columns.first; column < columns.end; ++column) {
        const std::size_t bit = layout_.bit(column, row, sample);
        change(bit / 64, std::uint64_t{1} << bit % 64);
      }
      return;
    }
    if (columns.first >= columns.end) return;
    const std::size_t first = layout_.bit(columns.first, row, 0), last = layout_.bit(columns.end, row, 0) - 1;
    for (std::size_t word = first / 64; word <= last / 64; ++word) {
      std::uint64_t bits = every_pixel_ << sample;
      if (word == first / 64) bits &= ~std::uint64_t{0} << first % 64;
      if (word == last / 64) bits &= ~std::uint64_t{0} >> (63 - last % 64);
      change(word, bits);
    }
  }

  const Setting& setting_;
  MaskLayout layout_;
  Range columns_;
  Range rows_;
  std::uint64_t every_pixel_ = 0;  ///< the first bit of each in a word; 0 if words begin within pixels
};

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
  const Samples samples(setting, viewport);
  std::vector<EdgeRows> borders;
  boost::container::static_vector<Point, Polygon::static_capacity> points;
  for (const Polygon& polygon : visible.polygons) {
    points.clear();
    for (const auto& [at, border] : polygon) {
      points.push_back({viewport.x + (at[0] / at[3] + 1) / 2 * viewport.width,
                        viewport.y + (at[1] / at[3] + 1) / 2 * viewport.height});
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (polygon[k].border) borders.emplace_back(points[k], points[(k + 1) % points.size()], *error);
    }
    samples.in(PolygonRows<Polygon::static_capacity>({points.data(), points.size()}),
               [&](std::size_t word, std::uint64_t bits) { inside[word] |= bits; });
  }
  for (const EdgeRows& border : borders) {
    samples.in(border, [&](std::size_t word, std::uint64_t bits) { inside[word] &= ~bits; });
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
