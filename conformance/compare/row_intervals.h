// Areas of the window as intervals of its rows, in binary64: what a convex polygon certainly holds, and what lies near
// an edge.
#pragma once

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace edgecase::conformance::rows {

struct Point {
  double x;
  double y;
};

/// From where to where on one row; nothing if that is the wrong way round.
struct Interval {
  double from;
  double to;

  Interval grown(double by) const { return {from - by, to + by}; }
  friend Interval meet(const Interval& a, const Interval& b) {
    return {std::max(a.from, b.from), std::min(a.to, b.to)};
  }
};
inline constexpr double kEverywhere = std::numeric_limits<double>::infinity();
inline constexpr Interval kNowhere{kEverywhere, -kEverywhere};

/// More than what rounding can do to a point of the window, and much less than a border's error.
inline constexpr double kRounding = 0x1p-20;

inline Interval extent(std::span<const Point> points, double Point::*of) {
  const auto [least, greatest] = std::ranges::minmax(points, {}, of);
  return {least.*of, greatest.*of};
}

/// An edge, from its upper end down if it has one, so that neighbours see the same.
struct Line {
  Point upper;
  Point lower;

  Line(const Point& a, const Point& b) : upper(a.y <= b.y ? a : b), lower(a.y <= b.y ? b : a) {}
  double slope() const { return (lower.x - upper.x) / (lower.y - upper.y); }
};

/// A convex polygon of up to `Capacity` sides, row by row.
template <std::size_t Capacity>
class PolygonRows {
 public:
  explicit PolygonRows(std::span<const Point> polygon)
      : x_(extent(polygon, &Point::x).grown(kRounding)), y_(extent(polygon, &Point::y)) {
    double area = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Point& a = polygon[k];
      const Point& b = polygon[(k + 1) % polygon.size()];
      area += (a.x - polygon[0].x) * (b.y - polygon[0].y) - (a.y - polygon[0].y) * (b.x - polygon[0].x);
      if (a.y != b.y) sides_.push_back({Line(a, b), Line(a, b).slope(), b.y > a.y});
    }
    has_area_ = area != 0;
    for (Side& side : sides_) side.bounds_right ^= area < 0;
  }

  const Interval& y() const { return y_; }

  /// What it holds of a row, border and kRounding included. Beyond the polygon's box, where lines that nearly meet
  /// could go on together, it holds nothing.
  Interval at(double y) const {
    if (!has_area_ || y < y_.from || y > y_.to) return kNowhere;
    Interval result = x_;
    for (const auto& [line, slope, bounds_right] : sides_) {
      const double x = line.upper.x + slope * (y - line.upper.y);
      if (bounds_right) {
        result.to = std::min(result.to, x + kRounding);
      } else {
        result.from = std::max(result.from, x - kRounding);
      }
    }
    return result;
  }

 private:
  struct Side {
    Line line;
    double slope;
    bool bounds_right;
  };
  Interval x_;
  Interval y_;
  boost::container::static_vector<Side, Capacity> sides_;
  bool has_area_ = false;
};

/// All around an edge: of its bounding box, grown by `reach`, what a square of that size may touch the line from.
class EdgeRows {
 public:
  EdgeRows(const Point& a, const Point& b, double reach)
      : line_(a, b),
        x_(extent(std::array{a, b}, &Point::x).grown(reach)),
        y_(extent(std::array{a, b}, &Point::y).grown(reach)) {
    const double width = std::abs(b.x - a.x), height = line_.lower.y - line_.upper.y;
    if (height == 0) return;
    slope_ = line_.slope();
    half_ = reach * (width + height) / height + kRounding;
  }

  const Interval& y() const { return y_; }

  Interval at(double y) const {
    if (y < y_.from || y > y_.to) return kNowhere;
    const double x = line_.upper.x + slope_ * (y - line_.upper.y);
    return meet(x_, {x - half_, x + half_});
  }

 private:
  Line line_;
  Interval x_;
  Interval y_;
  double slope_ = 0;
  double half_ = kEverywhere;  ///< of its width on a row, as far as its box allows
};

}  // namespace edgecase::conformance::rows
