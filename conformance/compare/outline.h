// The outline of a mesh: the directed edges that no neighbour cancels.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/scene/explanation.h"

namespace edgecase::conformance {

/// A triangle after snapping. Every coordinate handed to this part lies within -2^40 .. 2^40, so that cross products
/// and comparisons of two of an edge's crossings are exact in 128 bits.
using GridTriangle = std::array<GridPoint, 3>;

/// +1 or -1 as the vertices turn, +1 being clockwise on the screen (y down); 0 for zero area.
int orientation(const GridTriangle& triangle);

/// The orientation that every triangle with an area has; 0 if none has an area; nothing if two differ.
std::optional<int> common_orientation(std::span<const GridTriangle> mesh);

struct OutlineEdge {
  GridPoint from;
  GridPoint to;
  int times = 1;  ///< how often it is left over; above 1 only in a malformed mesh
};

/// Collects the edges of a mesh and drops those that occur as often in one direction as in the other. Holds only memory
/// that is used again from mesh to mesh.
class OutlineBuilder {
 public:
  /// The outline of `mesh`, in the order in which its edges first occur; valid until the next call. Points are only
  /// told apart here, and may lie anywhere.
  std::span<const OutlineEdge> build(std::span<const GridTriangle> mesh);

 private:
  /// A hash table of the edges of one mesh. A point is one number Key that orders by y, then x: comparing two of them
  /// takes no branch, and which way an edge runs no processor can predict.
  template <typename Key>
  class Edges {
   public:
    void collect(std::span<const GridTriangle> mesh, std::vector<OutlineEdge>& outline);

   private:
    struct Slot {
      Key low;  ///< the lesser end
      Key high;
      std::int32_t times = 0;  ///< occurrences from low to high less those from high to low
      std::uint32_t mesh = 0;
    };
    void reserve(std::size_t triangles);

    std::vector<Slot> slots_;  ///< open addressing; a slot of another mesh than mesh_ is free
    int hash_shift_ = 0;
    std::vector<std::uint32_t> used_;  ///< slots of this mesh, in the order in which they were taken
    std::uint32_t mesh_ = 0;
  };

  Edges<std::uint64_t> narrow_;  ///< for coordinates of 32 bits
  Edges<unsigned __int128> wide_;
  std::vector<OutlineEdge> outline_;
};

/// Why `mesh` does not cover its region exactly once, in one line; nothing if it does.
///
/// The winding numbers of the triangles around a point add up to that of the outline, because an edge and its reverse
/// cancel. If all triangles turn the same way, each contributes 0 or 1, and so an outline that winds 0 or 1 times
/// around every point proves that no two triangles overlap. Decided exactly, for the whole plane and not only at
/// samples, in time quadratic in the outline's edges.
std::optional<std::string> mesh_fault(std::span<const GridTriangle> mesh);

}  // namespace edgecase::conformance
