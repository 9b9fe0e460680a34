// RuleSet: what a specification fixes of coverage, and what it leaves to the rasterizer.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "conformance/scene/setting.h"

namespace edgecase::conformance {

/// Which points of the subpixel grid a coordinate between two of them may be moved to, each coordinate by itself. One
/// that lies on the grid stays, and equal positions go to the same point wherever they occur.
enum class SnapFreedom {
  none,       ///< to the one that Rules say
  near_tie,   ///< to any within 0.6 grid units
  neighbour,  ///< to either neighbour
};

/// What decides on a sample that lies exactly on an edge of a triangle.
enum class OnEdge {
  top_left,  ///< the top-left rule
  /// Nothing, for one triangle; but where the edge is common to two triangles of a mesh, exactly one covers it.
  one_of_two,
  undefined,  ///< nothing at all
};

struct RuleSet {
  std::string_view name;
  /// Grids that a rasterizer may have.
  int least_subpixel_bits = 0;
  int most_subpixel_bits = 16;
  SnapFreedom snap = SnapFreedom::none;
  OnEdge on_edge = OnEdge::top_left;
  /// Whether the snapped vertices decide how a triangle faces. Otherwise one that faces two ways, or has no area, for
  /// different legal choices may be culled or drawn.
  bool facing_is_snapped = true;

  /// Whether Rules leave nothing open.
  bool exact() const { return snap == SnapFreedom::none && on_edge == OnEdge::top_left; }
  /// The grid to judge a rasterizer by that claims to have `bits`: the nearest that is allowed.
  int subpixel_bits(int bits) const { return std::clamp(bits, least_subpixel_bits, most_subpixel_bits); }
  friend bool operator==(const RuleSet&, const RuleSet&) = default;
};

/// Every set by its name; the first one is what holds if none is named.
///   exact   Rules decide every sample; how a driver snaps is found out by drawing.
///   d3d11   Direct3D 11.3 functional specification: 16.8 fixed point (3.4.1), within 0.6 units (3.2.4.1), so that
///           within 0.1 units of a tie either neighbour is legal; top-left rule (3.4.2.1); culled as snapped (15.16).
///   vulkan  Vulkan 1.3, "Basic Polygon Rasterization" and subPixelPrecisionBits, at least 4: how positions are rounded
///           to that grid is not said; of two polygons on either side of a common edge with identical end points
///           exactly one covers a sample on it.
///   opengl  OpenGL 4.6, 14.6.1, and SUBPIXEL_BITS: the same words, at least 4 bits.
///   webgpu  Leaves samples on edges undefined, and runs on the others' hardware: at least 4 bits.
inline constexpr std::array kRuleSets{
    RuleSet{"exact"},
    RuleSet{"d3d11", 8, 8, SnapFreedom::near_tie, OnEdge::top_left, true},
    RuleSet{"vulkan", 4, 16, SnapFreedom::neighbour, OnEdge::one_of_two, false},
    RuleSet{"opengl", 4, 16, SnapFreedom::neighbour, OnEdge::one_of_two, false},
    RuleSet{"webgpu", 4, 16, SnapFreedom::neighbour, OnEdge::undefined, false},
};
inline constexpr const RuleSet& kExactRules = kRuleSets.front();

/// The set of that name, or null.
inline const RuleSet* find_rule_set(std::string_view name) {
  const auto found = std::ranges::find(kRuleSets, name, &RuleSet::name);
  return found == kRuleSets.end() ? nullptr : &*found;
}

}  // namespace edgecase::conformance
