// For tests of drivers: random triangles on the 1/256 grid, and their exact coverage by the shortest definition.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Vertices uniform in [low, high] pixels, on multiples of `step` / 256 px.
inline Triangle random_triangle(std::mt19937& random, int low, int high, int step) {
  std::uniform_int_distribution<int> lattice(low * 256 / step, high * 256 / step);
  Triangle triangle;
  for (Position& p : triangle) {
    p.x = static_cast<float>(lattice(random) * step) / 256.0F;
    p.y = static_cast<float>(lattice(random) * step) / 256.0F;
  }
  return triangle;
}

/// Whether the rules cover the sample at (x, y), both in 1/256 px, as all vertices must be: the top-left rule as the
/// test of the sample moved by an infinitesimal to the right and a smaller one down.
inline bool exactly_inside(const Triangle& triangle, std::int64_t x, std::int64_t y) {
  std::array<std::array<std::int64_t, 2>, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = {std::llrint(triangle[i].x * 256.0F), std::llrint(triangle[i].y * 256.0F)};
  }
  int left_of = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& a = v[i];
    const auto& b = v[(i + 1) % 3];
    const std::int64_t dx = b[0] - a[0];
    const std::int64_t dy = b[1] - a[1];
    std::int64_t e = dx * (y - a[1]) - dy * (x - a[0]);
    if (e == 0) e = -dy;  // de/dx
    if (e == 0) e = dx;   // de/dy
    if (e == 0) return false;
    left_of += e > 0 ? 1 : -1;
  }
  return std::abs(left_of) == 3;
}

/// The exact mask at the setting's sample locations.
inline std::vector<std::uint64_t> exact_mask(const Setting& setting, const Triangle& triangle) {
  const MaskLayout layout(setting);
  std::vector<std::uint64_t> mask(layout.words());
  for (int y = 0; y < setting.target.height; ++y) {
    for (int x = 0; x < setting.target.width; ++x) {
      for (int s = 0; s < setting.samples(); ++s) {
        const SampleLocation at = setting.sample_locations[static_cast<std::size_t>(s)];
        if (exactly_inside(triangle, x * 256 + at.x * 16, y * 256 + at.y * 16)) cover(mask, layout.bit(x, y, s));
      }
    }
  }
  return mask;
}

/// The mask of one sample per pixel as rows of '#' and '.', for failure messages and hand-written expectations.
inline std::vector<std::string> rows_of(const Setting& setting, MaskView mask) {
  std::vector<std::string> rows;
  const MaskLayout layout(setting);
  for (int y = 0; y < setting.target.height; ++y) {
    std::string row;
    for (int x = 0; x < setting.target.width; ++x) row += covered(mask, layout.bit(x, y, 0)) ? '#' : '.';
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace edgecase::conformance
