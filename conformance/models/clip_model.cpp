#include "conformance/models/clip_model.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstddef>

namespace edgecase::conformance {
namespace {

// A convex polygon gains at most one vertex per plane. Rounding may bend it: then each inside vertex may gain one.
constexpr std::size_t kMaxVertices = 64;

template <class Vertex>
using Vertices = boost::container::static_vector<Vertex, kMaxVertices>;

struct ClipVertex {
  ClipPosition at;
  bool original = true;
};
using Polygon = Vertices<ClipVertex>;

unsigned bit_of(ClipPlane plane) { return 1U << static_cast<unsigned>(plane); }

// The signed distance is coordinate * factor, + w but for a near plane at z = 0; inside at 0 and above. llvmpipe sums
// the products of the position and (+-1, 0, 0, 1) from left to right; adding the zeros changes no sum, and so this is
// the same.
struct Plane {
  float ClipPosition::*coordinate;
  float factor;
  bool plus_w;

  Plane(const TransformModel& model, float shrink, ClipPlane plane) : coordinate(&ClipPosition::z), plus_w(true) {
    switch (plane) {
      case ClipPlane::left:
      case ClipPlane::right:
        coordinate = &ClipPosition::x;
        factor = plane == ClipPlane::left ? shrink : -shrink;
        break;
      case ClipPlane::bottom:
      case ClipPlane::top:
        coordinate = &ClipPosition::y;
        factor = plane == ClipPlane::bottom ? shrink : -shrink;
        break;
      case ClipPlane::near:
        factor = 1;
        plus_w = model.depth == DepthRange::minus_w_to_w;
        break;
      case ClipPlane::far:
        factor = -1;
        break;
    }
  }

  float distance(const ClipPosition& p) const {
    const float product = factor * (p.*coordinate);
    return plus_w ? p.w + product : product;
  }
};

// The planes that it lies outside of.
unsigned outcode(const TransformModel& model, float shrink, const ClipPosition& p) {
  using enum ClipPlane;
  unsigned code = 0;
  for (const ClipPlane plane : {left, right, bottom, top, near, far}) {
    if (Plane(model, shrink, plane).distance(p) < 0) code |= bit_of(plane);
  }
  return code;
}

float towards(float from, float t, float to) {
  const float step = t * (to - from);
  return from + step;
}

float crosswise(float inside, float d_inside, float outside, float d_outside, float inverse) {
  const float a = d_outside * inside;
  const float b = d_inside * outside;
  return (a - b) * inverse;
}

ClipPosition crossing(Interpolation how, const ClipPosition& inside, float d_inside, const ClipPosition& outside,
                      float d_outside) {
  if (how == Interpolation::crosswise) {
    const float inverse = 1.0F / (d_outside - d_inside);
    return {crosswise(inside.x, d_inside, outside.x, d_outside, inverse),
            crosswise(inside.y, d_inside, outside.y, d_outside, inverse),
            crosswise(inside.z, d_inside, outside.z, d_outside, inverse),
            crosswise(inside.w, d_inside, outside.w, d_outside, inverse)};
  }
  const bool outside_is_nearer = -d_outside < d_inside;
  const ClipPosition& near = outside_is_nearer ? outside : inside;
  const ClipPosition& far = outside_is_nearer ? inside : outside;
  const float d_near = outside_is_nearer ? d_outside : d_inside;
  const float d_far = outside_is_nearer ? d_inside : d_outside;
  const float t = d_near / (d_near - d_far);
  return {towards(near.x, t, far.x), towards(near.y, t, far.y), towards(near.z, t, far.z), towards(near.w, t, far.w)};
}

// Cuts off what lies outside of the plane; false if that makes too many vertices.
bool cut(Interpolation how, const Plane& plane, const Polygon& in, Polygon& out) {
  out.clear();
  const auto add = [&out](const ClipVertex& vertex) {
    if (out.size() == kMaxVertices) return false;
    out.push_back(vertex);
    return true;
  };
  const float first = plane.distance(in.front().at);
  float da = first;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const bool last = i + 1 == in.size();
    const ClipVertex& a = in[i];
    const ClipVertex& b = in[last ? 0 : i + 1];
    const float db = last ? first : plane.distance(b.at);
    const bool a_stays = da >= 0;
    const bool b_stays = db >= 0;
    if (a_stays && !add(a)) return false;
    // An edge that comes in to a vertex on the plane itself yields no new vertex in SwiftShader. In llvmpipe it does:
    // at the same place in clip space, but projected as new vertices are.
    if (a_stays != b_stays && !(how == Interpolation::crosswise && !a_stays && db == 0)) {
      const ClipPosition at = a_stays ? crossing(how, a.at, da, b.at, db) : crossing(how, b.at, db, a.at, da);
      if (!add({at, false})) return false;
    }
    da = db;
  }
  return true;
}

bool within_reach(const ClipTriangle& triangle) {
  constexpr float kLeast = 0x1p-40F;
  constexpr float kMost = 0x1p40F;
  for (const ClipPosition& p : triangle) {
    for (const float value : {p.x, p.y, p.z, p.w}) {
      const float magnitude = std::abs(value);
      if (!(magnitude <= kMost) || (magnitude != 0 && magnitude < kLeast)) return false;
    }
  }
  return true;
}

// Where a vertex lies, and whence the snap took it there.
struct Projected {
  Position snapped;
  Position before_snap;
};

class Projection {
 public:
  Projection(const TransformModel& model, const Setting& setting, const Viewport& viewport)
      : model_(model),
        x_(AxisTransform::of(viewport.x, viewport.width)),
        y_(AxisTransform::of(viewport.y, viewport.height)),
        multisampled_(setting.samples() > 1) {}

  std::optional<Projected> operator()(const ClipVertex& vertex) const {
    const float inverse_w = 1.0F / vertex.at.w;
    const MultiplyAdd how = vertex.original ? model_.multiply_add : MultiplyAdd::separate;
    const auto x = transformed(model_, x_, how, multisampled_, vertex.at.x, inverse_w);
    const auto y = transformed(model_, y_, how, multisampled_, vertex.at.y, inverse_w);
    if (!x || !y) return std::nullopt;
    return Projected{{x->snapped, y->snapped}, {x->window, y->window}};
  }

 private:
  const TransformModel& model_;
  AxisTransform x_;
  AxisTransform y_;
  bool multisampled_;
};

bool within(float max_extent, const Triangle& t) {
  const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
  return right - left <= max_extent && bottom - top <= max_extent;
}

// How SwiftShader takes the triangle to be wound. It counts from a pixel's centre, in subpixels; a scale that is a
// power of two changes no rounding, so that pixels do. Each product and sum is rounded.
Turn turn_in_binary32(const std::array<Position, 3>& v, const ClipTriangle& triangle) {
  constexpr float kPixelCentre = 0.5F;
  const auto x = [&](std::size_t i) { return v[i].x - kPixelCentre; };
  const auto y = [&](std::size_t i) { return v[i].y - kPixelCentre; };
  const float p = (y(0) - y(2)) * x(1);
  const float q = (y(2) - y(1)) * x(0);
  const float r = (y(1) - y(0)) * x(2);
  const float area = (p + q) + r;
  if (area == 0) return Turn::none;
  bool counter_clockwise = area > 0;
  for (const ClipPosition& vertex : triangle) counter_clockwise ^= std::signbit(vertex.w);
  return counter_clockwise ? Turn::counter_clockwise : Turn::clockwise;
}

// How llvmpipe's draw module takes a triangle to be wound.
Turn turn_before_snap(const Triangle& t) {
  const float ex = t[0].x - t[2].x;
  const float ey = t[0].y - t[2].y;
  const float fx = t[1].x - t[2].x;
  const float fy = t[1].y - t[2].y;
  const float p = ex * fy;
  const float q = ey * fx;
  const float area = p - q;
  return area > 0 ? Turn::clockwise : area < 0 ? Turn::counter_clockwise : Turn::none;
}

// `first_goes_last`: what turn_before_snap() is asked of has the fan's first vertex last.
bool append_fan(const TransformModel& model, const Vertices<Projected>& outline, bool first_goes_last,
                std::vector<WindowTriangle>& out) {
  const std::size_t before = out.size();
  for (std::size_t i = 2; i < outline.size(); ++i) {
    const auto part_of = [&](Position Projected::*at) {
      return Triangle{outline[0].*at, outline[i - 1].*at, outline[i].*at};
    };
    const Triangle part = part_of(&Projected::snapped);
    if (!within(model.max_extent, part)) {
      out.resize(before);
      return false;
    }
    Triangle before_snap = part_of(&Projected::before_snap);
    if (first_goes_last) std::rotate(before_snap.begin(), before_snap.begin() + 1, before_snap.end());
    if (turn_of(part) != Turn::none) out.push_back({part, turn_before_snap(before_snap)});
  }
  return true;
}

float shrink_of(const TransformModel& model, const Setting& setting) {
  return setting.samples() > 1 ? model.multisample_shrink : model.shrink;
}

// Leaves of `polygon` what is inside the planes `any`, nothing if fewer than three vertices are; false if rounding made
// too many vertices.
bool clip(const TransformModel& model, float shrink, unsigned any, Polygon& polygon) {
  Polygon next;
  for (const ClipPlane plane : model.planes) {
    if ((any & bit_of(plane)) == 0) continue;
    if (!cut(model.interpolation, Plane(model, shrink, plane), polygon, next)) return false;
    polygon = next;
    if (polygon.size() < 3) {
      polygon.clear();
      break;
    }
  }
  return true;
}

}  // namespace

Turn turn_of(const Triangle& triangle) {
  const auto d = [](float from, float to) { return static_cast<double>(to) - static_cast<double>(from); };
  const auto& [a, b, c] = triangle;
  const double area = d(a.x, b.x) * d(a.y, c.y) - d(a.y, b.y) * d(a.x, c.x);
  return area > 0 ? Turn::clockwise : area < 0 ? Turn::counter_clockwise : Turn::none;
}

bool leaves_view_volume(const TransformModel& model, const ClipTriangle& triangle) {
  return std::ranges::any_of(triangle, [&](const ClipPosition& p) { return outcode(model, 1, p) != 0; });
}

std::optional<Turn> append_window_triangles(const TransformModel& model, const Setting& setting,
                                            const Viewport& viewport, const ClipTriangle& triangle,
                                            std::vector<WindowTriangle>& out) {
  if (!within_reach(triangle)) return std::nullopt;
  const float shrink = shrink_of(model, setting);
  unsigned any = 0;  // of the planes, guard bands included
  unsigned some = 0;
  unsigned all = ~0U;
  Polygon polygon;
  for (const ClipPosition& p : triangle) {
    const unsigned code = outcode(model, 1, p);
    any |= shrink == 1 ? code : outcode(model, shrink, p);
    some |= code;
    all &= code;
    polygon.push_back({p, true});
  }
  if (all != 0) {  // guard bands save nothing that is outside as a whole
    polygon.clear();
  } else if (any != 0 && !clip(model, shrink, any, polygon)) {
    return std::nullopt;
  }
  const Projection project(model, setting, viewport);
  Vertices<Projected> outline;
  for (const ClipVertex& vertex : polygon) {
    const auto at = project(vertex);
    if (!at) return std::nullopt;
    outline.push_back(*at);
  }
  Turn turn = Turn::none;
  if (!outline.empty() && model.winding == Winding::binary32_before_clipping) {
    std::array<Position, 3> unclipped;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = project({triangle[i], true});
      if (!at) return std::nullopt;
      unclipped[i] = at->snapped;
    }
    turn = turn_in_binary32(unclipped, triangle);
  }
  // A triangle that nothing is cut off keeps its order.
  if (!append_fan(model, outline, model.fan_ends_with_first && some != 0, out)) return std::nullopt;
  return turn;
}

}  // namespace edgecase::conformance
