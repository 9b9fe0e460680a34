#include "conformance/models/llvmpipe_setup.h"

#include <algorithm>

#include "conformance/models/transform_model.h"
#include "conformance/scene/grid.h"

namespace edgecase::conformance::llvmpipe {
namespace {

/// From a pixel's corner to where its edge functions begin.
std::int64_t first_sample(const Setting& setting) { return setting.samples() > 1 ? 0 : kPixel / 2; }

}  // namespace

std::optional<Points> snapped_points(const Setting& setting, const Triangle& triangle) {
  Points points;
  constexpr auto kScale = static_cast<float>(kPixel);
  if (all_on_grid({&triangle, 1}, kScale)) {
    std::ranges::transform(triangle, points.begin(), [](const Position& position) {
      const GridPoint p = grid_point(position, kScale);
      return Point{p.x, p.y};
    });
    return points;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto position = snapped(lavapipe_model(), setting, triangle[i]);
    if (!position) return std::nullopt;
    points[i] = {static_cast<std::int64_t>(position->x * kPixel), static_cast<std::int64_t>(position->y * kPixel)};
  }
  return points;
}

std::int64_t area_of(const Points& points) {
  const auto& [p, q, r] = points;
  return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

bool is_culled(const Setting& setting, std::int64_t area) {
  if (area == 0) return true;
  const bool front = (area > 0) == (setting.front_face == FrontFace::clockwise);
  return setting.cull != CullMode::none && front == (setting.cull == CullMode::front);
}

std::array<Edge, 3> edges_of(const Setting& setting, const Points& points) {
  const bool clockwise = area_of(points) > 0;
  std::array<Edge, 3> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& from = points[clockwise ? i : (i + 1) % 3];
    const Point& to = points[clockwise ? (i + 1) % 3 : i];
    const std::int64_t a = from.y - to.y, b = to.x - from.x;
    const bool top_left = a > 0 || (a == 0 && b > 0);
    const std::int64_t s = first_sample(setting);
    edges[i] = {a * (s - from.x) + b * (s - from.y) + (top_left ? 1 : 0), a, b};
  }
  return edges;
}

Box box_of(const Setting& setting, const Points& points) {
  const auto& [p, q, r] = points;
  const std::int64_t s = first_sample(setting);
  const auto [left, right] = std::minmax({p.x, q.x, r.x});
  const auto [top, bottom] = std::minmax({p.y, q.y, r.y});
  const auto pixel = [&](std::int64_t v) { return (v - s) >> kSubpixelBits; };
  return {pixel(left), pixel(top), pixel(right - 1), pixel(bottom - 1)};
}

Box scissor_of(const Setting& setting) {
  const Extent target = setting.target;
  const Rect r = setting.scissor.value_or(Rect{0, 0, target.width, target.height});
  return {std::max(r.x, 0), std::max(r.y, 0), std::min<std::int64_t>(std::int64_t{r.x} + r.width, target.width) - 1,
          std::min<std::int64_t>(std::int64_t{r.y} + r.height, target.height) - 1};
}

}  // namespace edgecase::conformance::llvmpipe
