// Vertices as a caller has them, and what can be wrong with them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace edgecase::rasterizer {

/// A window position in pixels, y down; (0, 0) is the top-left corner of the target's top-left pixel, whose centre is
/// (0.5, 0.5).
struct Vertex {
  float x = 0;
  float y = 0;
};

/// Either winding is drawn.
using Triangle = std::array<Vertex, 3>;

enum class Axis { x, y };

/// A coordinate that no format can snap, or that lies outside the one in use.
struct InputError {
  enum class Kind { nan, infinite, out_of_range };
  Kind kind;
  std::size_t triangle;  ///< its index in the list; 0 for a single triangle
  int vertex;            ///< 0 to 2
  Axis axis;
  float value;
};

/// One line for a person, such as "triangle 3, vertex 1: y is NaN".
std::string describe(const InputError& error);

/// The error for a coordinate that could not be snapped. Decides on the bits of `value`, so that it also holds in
/// programs compiled with the promise that there are no NaNs.
constexpr InputError make_input_error(std::size_t triangle, int vertex, Axis axis, float value) {
  const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(value) & 0x7fffffffu;
  constexpr std::uint32_t kInfinity = 0x7f800000u;
  const auto kind = magnitude > kInfinity    ? InputError::Kind::nan
                    : magnitude == kInfinity ? InputError::Kind::infinite
                                             : InputError::Kind::out_of_range;
  return {kind, triangle, vertex, axis, value};
}

}  // namespace edgecase::rasterizer
