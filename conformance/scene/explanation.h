// Why the rules answer as they do for one sample of one triangle: the numbers a person checks by hand.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace edgecase::conformance {

/// A point on the subpixel grid: window coordinates times 2^subpixel_bits.
struct GridPoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

/// An edge as the rules see it: positive `value` is inside, zero is on the edge.
struct EdgeExplanation {
  int from = 0;  ///< index of the vertex the edge starts at, 0 to 2
  int to = 0;
  /// The edge function at the sample, an exact decimal integer, in units of (1/scale px)^2.
  std::string value;
  bool top = false;   ///< exactly horizontal and above the triangle's other edges
  bool left = false;  ///< not horizontal and on the triangle's left side
};

struct Explanation {
  int subpixel_bits = 8;
  std::array<GridPoint, 3> snapped;  ///< the vertices on the subpixel grid
  /// Units per pixel in which the edge functions are computed: fine enough for vertices and sample locations both.
  std::int64_t scale = 256;
  bool degenerate = false;  ///< zero area after snapping: covers nothing
  bool culled = false;      ///< it has an area, but the setting drops the way it faces
  std::array<EdgeExplanation, 3> edges;
  bool inside = false;
};

}  // namespace edgecase::conformance
