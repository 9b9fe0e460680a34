#include "rasterizer/input_error.h"

#include <charconv>

namespace edgecase::rasterizer {

std::string describe(const InputError& error) {
  std::string text = "triangle " + std::to_string(error.triangle) + ", vertex " + std::to_string(error.vertex) + ": " +
                     (error.axis == Axis::x ? "x" : "y");
  if (error.kind == InputError::Kind::nan) return text + " is NaN";
  if (error.kind == InputError::Kind::infinite) return text + " is infinite";
  // The shortest digits that give the same float back; no binary32 needs more than 16 characters.
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), error.value).ptr;
  return text + " = " + std::string(digits.data(), end) + " px lies outside the coordinate format";
}

}  // namespace edgecase::rasterizer
