#include "conformance/bench/geometry.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "conformance/generators/random.h"

namespace edgecase::conformance {
namespace {

__extension__ typedef __int128 Wide;

constexpr std::int64_t kPixel = std::int64_t{1} << kGeometryBits;

/// In units of 2^-20 px [36 bits].
struct Vertex {
  std::int64_t x;
  std::int64_t y;
};

std::int64_t units(float pixels) {
  return static_cast<std::int64_t>(std::ldexp(static_cast<double>(pixels), kGeometryBits));
}

Wide floor_divided(Wide dividend, Wide divisor) {
  const Wide quotient = dividend / divisor;
  return quotient * divisor > dividend ? quotient - 1 : quotient;
}

/// a * x + b * y + c [73 bits], and inside where that is above 0, or 0 and the edge a left or a top one.
struct Edge {
  Wide a, b, c;
  Edge(const Vertex& p, const Vertex& q) : a(p.y - q.y), b(q.x - p.x), c(-(a * p.x + b * p.y)) {
    if (!(a > 0 || (a == 0 && b > 0))) c -= 1;  // integers: above 0 is at least 1
  }
};

}  // namespace

void cover_geometry(const Triangle& triangle, const Extent& target, MutableMaskView mask) {
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = {units(triangle[i].x), units(triangle[i].y)};
  const Wide doubled_area = Wide{v[1].x - v[0].x} * (v[2].y - v[0].y) - Wide{v[2].x - v[0].x} * (v[1].y - v[0].y);
  if (doubled_area == 0) return;
  if (doubled_area < 0) std::swap(v[1], v[2]);
  const std::array edges{Edge(v[0], v[1]), Edge(v[1], v[2]), Edge(v[2], v[0])};
  const auto [high, low] = std::minmax({v[0].y, v[1].y, v[2].y});
  const auto row = [&](std::int64_t y) {
    return static_cast<int>(std::clamp<std::int64_t>(y >> kGeometryBits, 0, target.height));
  };
  Setting setting;
  setting.target = target;
  const MaskLayout layout(setting);
  for (int y = row(high); y < row(low + kPixel); ++y) {
    // Of the columns i, with the centre at (i + 1/2) px, each edge leaves a half line: a * i * 2^20 + rest >= 0.
    Wide first = 0, last = target.width - 1;
    for (const Edge& edge : edges) {
      const Wide rest = edge.a * (kPixel / 2) + edge.b * (y * kPixel + kPixel / 2) + edge.c;
      const Wide step = edge.a * kPixel;
      if (step > 0) first = std::max(first, -floor_divided(rest, step));
      if (step < 0) last = std::min(last, floor_divided(rest, -step));
      if (step == 0 && rest < 0) last = -1;
    }
    if (first > last) continue;
    const std::size_t begin = layout.bit(static_cast<int>(first), y, 0),
                      end = layout.bit(static_cast<int>(last), y, 0) + 1;
    for (std::size_t bit = begin; bit < end;) {
      const std::size_t next = std::min((bit / 64 + 1) * 64, end);
      mask[bit / 64] |= ~std::uint64_t{0} >> (64 - (next - bit)) << (bit % 64);
      bit = next;
    }
  }
}

std::optional<Scene> make_off_grid(const Workload& workload, std::size_t count, std::uint64_t seed) {
  if (workload.name == "full" || workload.name == "ties") return std::nullopt;
  Scene scene = make_workload(workload, count, seed);
  // Less than half a subpixel by more than what binary32 rounds by up to 2048 px, 2^-14 px: it snaps back.
  const std::int64_t most = (kPixel >> (scene.rules.subpixel_bits + 1)) - (kPixel >> 14) - 1;
  for (Triangle& triangle : scene.triangles) {
    for (Position& p : triangle) {
      // The place is the stream.
      const std::uint64_t place =
          std::uint64_t{std::bit_cast<std::uint32_t>(p.x)} << 32 | std::bit_cast<std::uint32_t>(p.y);
      Random random = Random::stream(seed, "off grid", place);
      const auto moved = [&](float coordinate) {
        // Exact in binary64. In binary32 it is rounded from 16 px on, to a coarser multiple of 2^-20.
        return static_cast<float>(coordinate +
                                  std::ldexp(static_cast<double>(random.between(-most, most)), -kGeometryBits));
      };
      const float x = moved(p.x);
      p = {x, moved(p.y)};
    }
  }
  return scene;
}

}  // namespace edgecase::conformance
