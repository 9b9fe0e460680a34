#include "conformance/runner/mesh_choices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "conformance/compare/outline.h"
#include "conformance/oracle/allowed.h"
#include "conformance/scene/grid.h"
#include "conformance/scene/mask.h"

namespace edgecase::conformance {
namespace {

__extension__ using Wide = __int128;

struct Point {
  Wide x = 0;
  Wide y = 0;
};

struct Before {
  bool operator()(const Position& a, const Position& b) const { return a.x < b.x || (a.x == b.x && a.y < b.y); }
};

using Choices = std::map<Position, std::vector<GridPoint>, Before>;
using Edge = std::pair<Position, Position>;

// -1, 0 or 1: the side of a -> b that p is on.
int side(const Point& a, const Point& b, const Point& p) {
  const Wide value = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

// Whether p lies in the convex hull of `points` or on its border: in their bounding box, and beyond no line through two
// of them that has all others on the other side or on itself.
bool in_hull(std::span<const Point> points, const Point& p) {
  const auto [left, right] = std::ranges::minmax(points, {}, &Point::x);
  const auto [top, bottom] = std::ranges::minmax(points, {}, &Point::y);
  if (p.x < left.x || p.x > right.x || p.y < top.y || p.y > bottom.y) return false;
  for (const Point& a : points) {
    for (const Point& b : points) {
      const bool borders = std::ranges::all_of(points, [&](const Point& q) { return side(a, b, q) >= 0; });
      if (borders && side(a, b, p) < 0) return false;
    }
  }
  return true;
}

// Whether all choices of every triangle that has an area turn the same way.
bool turns_one_way(std::span<const Triangle> mesh, const Choices& choices) {
  int turn = 0;
  for (const Triangle& t : mesh) {
    for (const GridPoint& a : choices.at(t[0])) {
      for (const GridPoint& b : choices.at(t[1])) {
        for (const GridPoint& c : choices.at(t[2])) {
          const bool alike = (t[0] != t[1] || a == b) && (t[1] != t[2] || b == c) && (t[2] != t[0] || c == a);
          const int found = alike ? orientation({a, b, c}) : 0;
          if (found * turn < 0) return false;
          if (found != 0) turn = found;
        }
      }
    }
  }
  return true;
}

// The edges that no neighbour has the other way round.
std::vector<Edge> outline_of(std::span<const Triangle> mesh) {
  const auto before = [](const Edge& a, const Edge& b) {
    const Before less;
    return less(a.first, b.first) || (a.first == b.first && less(a.second, b.second));
  };
  std::map<Edge, int, decltype(before)> times(before);
  for (const Triangle& t : mesh) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++times[{t[i], t[(i + 1) % 3]}];
      --times[{t[(i + 1) % 3], t[i]}];
    }
  }
  std::vector<Edge> outline;
  for (const auto& [edge, count] : times) {
    if (count > 0) outline.push_back(edge);
  }
  return outline;
}

}  // namespace

std::optional<std::vector<std::uint64_t>> open_samples(const Scene& scene, const RuleSet& rule_set, const Mesh& mesh) {
  const float scale = std::ldexp(1.0f, scene.rules.subpixel_bits);
  const std::span triangles = std::span(scene.triangles).subspan(mesh.first, mesh.count);
  std::vector<std::uint64_t> open;
  if (rule_set.snap == SnapFreedom::none || all_on_grid(triangles, scale)) return open;

  Choices choices;
  for (const Triangle& t : triangles) {
    for (const Position& p : t) choices.try_emplace(p, oracle::snap_choices(scene.rules, rule_set, p));
  }
  if (!turns_one_way(triangles, choices)) return std::nullopt;

  // In sixteenths of a grid unit, which hold the grid and the sample locations both.
  const MaskLayout layout(scene.setting);
  const int bits = scene.rules.subpixel_bits;
  open.resize(layout.words());
  std::vector<Point> ends;
  for (const auto& [from, to] : outline_of(triangles)) {
    ends.clear();
    for (const Position& end : {from, to}) {
      for (const GridPoint& g : choices.at(end)) {
        ends.push_back({Wide{g.x} << kSampleGridBits, Wide{g.y} << kSampleGridBits});
      }
    }
    for (int y = 0; y < layout.target.height; ++y) {
      for (int x = 0; x < layout.target.width; ++x) {
        for (int s = 0; s < layout.samples; ++s) {
          const SampleLocation& at = scene.setting.sample_locations[static_cast<std::size_t>(s)];
          const auto place = [&](int pixel, int sixteenths) {
            return ((Wide{pixel} << kSampleGridBits) + sixteenths) << bits;
          };
          if (in_hull(ends, {place(x, at.x), place(y, at.y)})) cover(open, layout.bit(x, y, s));
        }
      }
    }
  }
  return open;
}

}  // namespace edgecase::conformance
