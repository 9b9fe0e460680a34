// The family: the rasterizers that articles and chapters teach, each exact, chosen by name.
//
// They are here to be read and to be measured against. All give the same bits as cover_scalar; none is what cover()
// uses. Each is a function template `cover_NAME<F>(triangle, target, sink)` in a header of its own, on the triangle
// setup of edge.h; the table below has them for 16.8 and a mask.
#pragma once

#include <span>
#include <string_view>

#include "rasterizer/format.h"
#include "rasterizer/target.h"

namespace edgecase::rasterizer {

struct FamilyMember {
  std::string_view name;
  /// What it does, in one line.
  std::string_view about;
  /// Where it is described.
  std::string_view source;
  /// Adds the coverage of one triangle to what the mask holds.
  void (*cover)(const FixedTriangle<Format16_8>& triangle, const Mask& mask);
  /// The same for each triangle of a list: their union.
  void (*cover_list)(std::span<const FixedTriangle<Format16_8>> triangles, const Mask& mask);
};

/// orient2d, scalar, lanes4, quads, coarse_fine, larrabee, stamp, trapezoid.
std::span<const FamilyMember> family_members();

/// The member of that name, or null.
const FamilyMember* find_family_member(std::string_view name);

}  // namespace edgecase::rasterizer
