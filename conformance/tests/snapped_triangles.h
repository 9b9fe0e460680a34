// Triangles for tests of the fast rasterizer, of every kind that takes a way of its own through it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>

#include "rasterizer/format.h"
#include "rasterizer/target.h"

namespace edgecase::rasterizer::snapped {

using Fixed = FixedTriangle<Format16_8>;

inline constexpr std::int64_t kLow = -8388608, kHigh = 8388607;  // the ends of 16.8

inline FixedVertex<Format16_8> vertex(std::int64_t x, std::int64_t y) {
  return {*Int<24>::checked(x), *Int<24>::checked(y)};
}

/// A stream of triangles, each kind of which takes another way through the code.
class Triangles {
 public:
  Triangles(unsigned seed, const Target& target) : random_(seed), target_(target) {}

  Fixed next() {
    // Extents from under a pixel to all of the format, on the subpixel grid or on half pixels, each axis on its own.
    const std::int64_t x_reach = reach(), y_reach = reach();
    const std::int64_t step = random_() % 3 == 0 ? 128 : 1;
    const std::int64_t width = target_.width().value() * 256, height = target_.height().value() * 256;
    const std::int64_t x = between(-x_reach, width), y = between(-y_reach, height);
    std::array<FixedVertex<Format16_8>, 3> result;
    for (auto& v : result) {
      const auto coordinate = [&](std::int64_t base, std::int64_t extent) {
        return std::clamp((base + between(0, extent)) / step * step, kLow, kHigh);
      };
      v = vertex(coordinate(x, x_reach), coordinate(y, y_reach));
    }
    // Every now and then two vertices in one row, in one column, or in one place.
    const auto kind = random_() % 16;
    if (kind == 0) result[1].y = result[0].y;
    if (kind == 1) result[1].x = result[2].x;
    if (kind == 2) result[2] = result[0];
    return result;
  }

 private:
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  std::int64_t reach() { return std::int64_t{1} << between(5, random_() % 4 == 0 ? 24 : 15); }

  std::mt19937_64 random_;
  Target target_;
};

inline std::string text(const Fixed& triangle) {
  std::ostringstream stream;
  for (const auto& v : triangle) stream << '(' << v.x.value() << ", " << v.y.value() << ") ";
  return stream.str();
}

}  // namespace edgecase::rasterizer::snapped
