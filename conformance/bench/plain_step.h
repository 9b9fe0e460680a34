// The inner loops of the plain rasterizer, once for every way of compiling them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace edgecase::conformance {

/// Three edge functions a * x + b * y + c, x and y counted from the corner of the box.
template <class Integer>
struct PlainEdges {
  Integer a[3], b[3], c[3];
};

struct PlainBox {
  int width;
  int height;
  std::ptrdiff_t stride;  ///< bytes from row to row
};

/// `pixels`: the byte of the box's first pixel.
template <class Integer>
inline __attribute__((always_inline)) void step_plain(const PlainEdges<Integer>& edges, const PlainBox& box,
                                                      std::uint8_t* pixels) {
  // Copies: a byte that is stored could be one of the caller's numbers, as far as the compiler knows.
  const auto [a, b, c] = edges;
  const auto [width, height, stride] = box;
  Integer row0 = c[0], row1 = c[1], row2 = c[2];
  for (int y = 0; y < height; ++y) {
    Integer value0 = row0, value1 = row1, value2 = row2;
    for (int x = 0; x < width; ++x) {
      pixels[x] = static_cast<std::uint8_t>(pixels[x] | ((value0 | value1 | value2) >= 0 ? 1 : 0));
      value0 += a[0], value1 += a[1], value2 += a[2];
    }
    row0 += b[0], row1 += b[1], row2 += b[2];
    pixels += stride;
  }
}

/// In plain_scalar.cpp, whose compiler makes no vectors.
void step_scalar(const PlainEdges<std::int32_t>& edges, const PlainBox& box, std::uint8_t* pixels);
void step_scalar(const PlainEdges<std::int64_t>& edges, const PlainBox& box, std::uint8_t* pixels);

}  // namespace edgecase::conformance
