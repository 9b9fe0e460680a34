// Where a clip-space position lies in the window, as far as no clipper and no rounding have a say in it.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// a + b, a * b: nothing if binary32 has to round them. A product of two binary32 numbers has 48 bits and is exact in
/// binary64; a sum s is exact there if and only if the larger of a and b taken from it leaves the other.
inline std::optional<float> exact_sum(float a, float b) {
  const double s = static_cast<double>(a) + static_cast<double>(b);
  const bool exact = s - static_cast<double>(a) == static_cast<double>(b) &&
                     s - static_cast<double>(b) == static_cast<double>(a) &&
                     static_cast<double>(static_cast<float>(s)) == s;
  return exact ? std::optional(static_cast<float>(s)) : std::nullopt;
}

inline std::optional<float> exact_product(float a, float b) {
  const double p = static_cast<double>(a) * static_cast<double>(b);
  const double limit = static_cast<double>(std::numeric_limits<float>::max());
  if (!(std::abs(p) <= limit) || static_cast<double>(static_cast<float>(p)) != p) return std::nullopt;
  // Subnormal numbers are exact here, but not on machines that flush them to zero.
  const auto result = static_cast<float>(p);
  return p == 0 || std::isnormal(result) ? std::optional(result) : std::nullopt;
}

/// The window position of `vertex` if every way to compute it gives this one: the vertex lies in the view volume
/// (|x| <= w, |y| <= w, 0 <= z <= w), borders included, so that no clipper touches it; w is a power of two, so that
/// dividing by w and multiplying by 1/w are the same; and every step of the viewport transform is exact in binary32.
inline std::optional<Position> exact_window_position(const Viewport& viewport, const ClipPosition& vertex) {
  const float w = vertex.w;
  // A power of two has a significand of zero; both ends keep 1/w a normal number.
  const bool power_of_two = (std::bit_cast<std::uint32_t>(w) & 0x7fffff) == 0;
  if (!(w >= 0x1p-126f && w <= 0x1p126f) || !power_of_two) return std::nullopt;
  if (std::abs(vertex.x) > w || std::abs(vertex.y) > w || !(vertex.z >= 0 && vertex.z <= w)) return std::nullopt;
  const auto transformed = [&](float clip, float start, float size) -> std::optional<float> {
    const auto normalized = exact_product(clip, 1 / w);
    const auto half = exact_product(size, 0.5f);
    if (!normalized || !half) return std::nullopt;
    const auto centre = exact_sum(start, *half);
    const auto from_centre = exact_product(*normalized, *half);
    if (!centre || !from_centre) return std::nullopt;
    return exact_sum(*centre, *from_centre);
  };
  const auto x = transformed(vertex.x, viewport.x, viewport.width);
  const auto y = transformed(vertex.y, viewport.y, viewport.height);
  if (!x || !y) return std::nullopt;
  return Position{*x, *y};
}

/// Whether every vertex has a negative w: then no point of the triangle has -w <= x <= w, and it covers nothing.
inline bool behind_the_eye(const ClipTriangle& triangle) {
  return std::ranges::all_of(triangle, [](const ClipPosition& p) { return p.w < 0; });
}

/// The triangles of `scene` in the window, as far as every rasterizer has to agree: its own, or for clip space those
/// whose vertices all have an exact_window_position, and one without area for each that is behind_the_eye; nothing if
/// there is any other.
inline std::optional<std::vector<Triangle>> exact_window_triangles(const Scene& scene) {
  if (!scene.clip) return scene.triangles;
  std::vector<Triangle> triangles;
  for (const ClipTriangle& clip : scene.clip->triangles) {
    Triangle& triangle = triangles.emplace_back();
    if (behind_the_eye(clip)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto position = exact_window_position(scene.clip->viewport, clip[i]);
      if (!position) return std::nullopt;
      triangle[i] = *position;
    }
  }
  return triangles;
}

}  // namespace edgecase::conformance
