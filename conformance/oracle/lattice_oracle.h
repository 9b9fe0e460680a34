// The oracle by definition, factored so that it can answer for every triangle that a lattice has.
//
// A triangle's coverage is the intersection of what its three edges accept, and an edge is a pair of points: n points
// have n^2 edges but n^3/6 triangles. So every directed edge is asked about every sample once, in exact integers, by
// the same definition as cover_by_definition (D3D11.3 functional specification, 3.4.2.1), and a triangle is three
// look-ups.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "conformance/scene/scene.h"

namespace edgecase::conformance::oracle {

/// One sample in the centre of each pixel; masks are one word, pixel (x, y) in bit y * width + x.
class LatticeOracle {
 public:
  static constexpr int kMostPixels = 64;
  /// The tables of so many points take 285 MB.
  static constexpr std::size_t kMostPoints = 4225;

  /// Points of the lattice with 2^bits steps a pixel over the closed target.
  static std::size_t points_of(const Extent& target, int bits);

  /// At most kMostPixels pixels and kMostPoints points; bits 0 to 8.
  LatticeOracle(const Extent& target, int bits);

  /// Lattice points, numbered row by row from the top left.
  std::size_t points() const { return positions_.size(); }
  const Position& position(std::size_t point) const { return positions_[point]; }

  /// Writes the masks of the triangles (a, b, c), (a, b, c + 1), ... in either winding; all of them different points.
  void cover(std::size_t a, std::size_t b, std::size_t c, std::span<std::uint64_t> masks) const;

 private:
  struct Point {
    std::int64_t x = 0;
    std::int64_t y = 0;
  };
  std::uint64_t accepted(const Point& from, const Point& to) const;

  Extent target_;
  int bits_;
  std::vector<Position> positions_;
  std::vector<Point> grid_;               ///< the points in units of half a lattice step
  std::vector<std::uint64_t> accepted_;   ///< [from * points + to], the inside being on the right
  std::vector<std::uint64_t> backwards_;  ///< [to * points + from]: the same, so that a run of c lies together
};

}  // namespace edgecase::conformance::oracle
