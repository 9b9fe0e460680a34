// A triangulated region that stays watertight while it is refined: the ground of several generators.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "conformance/generators/lattice.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Invariant: every face is clockwise on the screen and of positive area; faces overlap nowhere and meet in whole
/// edges.
class Triangulation {
 public:
  /// The convex quadrilateral a, b, c, d, clockwise on the screen, cut along a-c.
  Triangulation(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d);

  std::size_t faces() const { return faces_.size(); }

  /// Joins a random lattice point strictly inside `face` to its corners; false if the one tried is not strictly inside.
  bool split_face(std::size_t face, Random& random);
  /// Puts a vertex at the middle of the face's edge number `edge`, 0 to 2, and splits the faces on both sides there, so
  /// that no T-junction arises; false if the middle is not a lattice point.
  bool split_edge(std::size_t face, std::size_t edge);
  /// Replaces an edge between two faces by the other diagonal; false at the rim or where the two do not form a strictly
  /// convex quadrilateral.
  bool flip_edge(std::size_t face, std::size_t edge);

  /// Appends the faces, their corners rotated and their order shuffled at random, as one watertight mesh.
  void append_to(Scene& scene, const Lattice& lattice, Random& random) const;

 private:
  static constexpr std::uint32_t kRim = ~std::uint32_t{0};
  // Edge i runs from vertex i to vertex i + 1 and is shared with face neighbours[i].
  struct Face {
    std::array<std::uint32_t, 3> vertices;
    std::array<std::uint32_t, 3> neighbours;
  };

  const LatticePoint& point(const Face& face, std::size_t i) const { return points_[face.vertices[i % 3]]; }
  std::uint32_t add_point(const LatticePoint& p);
  std::uint32_t add_face(const Face& face);
  void relink(std::uint32_t face, std::uint32_t old_neighbour, std::uint32_t new_neighbour);
  std::size_t edge_towards(std::uint32_t face, std::uint32_t neighbour) const;

  std::vector<LatticePoint> points_;
  std::vector<Face> faces_;
};

}  // namespace edgecase::conformance
