#include "conformance/compare/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace edgecase::conformance {
namespace {

using Wide = __int128;

/// An outline edge that is not horizontal, from its upper end down.
struct Side {
  GridPoint upper;
  GridPoint lower;
  int winding = 0;  ///< what it adds to the winding number of the points on its right
};

/// Where a side crosses the row at half the given doubled y: x = numerator / denominator, doubled.
struct Crossing {
  Wide numerator;
  Wide denominator;  ///< positive
};

Crossing cross(const Side& side, std::int64_t doubled_y) {
  const Wide dx = side.lower.x - side.upper.x;
  const Wide dy = side.lower.y - side.upper.y;
  return {2 * Wide{side.upper.x} * dy + (doubled_y - 2 * side.upper.y) * dx, dy};
}

bool left_of(const Crossing& a, const Crossing& b) { return a.numerator * b.denominator < b.numerator * a.denominator; }

std::vector<Side> sides_of(std::span<const OutlineEdge> outline) {
  std::vector<Side> sides;
  for (const OutlineEdge& edge : outline) {
    if (edge.from.y == edge.to.y) continue;
    const bool up = edge.to.y < edge.from.y;
    sides.push_back({up ? edge.to : edge.from, up ? edge.from : edge.to, up ? edge.times : -edge.times});
  }
  return sides;
}

/// Looks at the plane between two neighbouring vertex rows, where every side passes from top to bottom: faces are the
/// gaps between neighbouring sides, unless two sides cross. At a crossing three different winding numbers meet, so one
/// of them is neither 0 nor 1.
std::optional<std::string> slab_fault(std::vector<Side>& slab, std::int64_t top, std::int64_t bottom, int turn) {
  std::sort(slab.begin(), slab.end(),
            [&](const Side& a, const Side& b) { return left_of(cross(a, top + bottom), cross(b, top + bottom)); });
  int winding = 0;
  for (std::size_t i = 0; i < slab.size(); ++i) {
    winding += slab[i].winding * turn;
    if (i + 1 == slab.size()) break;
    for (const std::int64_t row : {top, bottom}) {
      if (left_of(cross(slab[i + 1], 2 * row), cross(slab[i], 2 * row))) {
        return fmt::format("its outline crosses itself between rows {} and {} of the subpixel grid", top, bottom);
      }
    }
    const bool a_face = left_of(cross(slab[i], top + bottom), cross(slab[i + 1], top + bottom));
    if (a_face && winding != 0 && winding != 1) {
      return fmt::format("its outline winds {} times around points between rows {} and {} of the subpixel grid",
                         winding, top, bottom);
    }
  }
  return std::nullopt;
}

std::uint64_t hash(const GridPoint& low, const GridPoint& high) {
  // Odd multipliers from splitmix64 and its relatives; any that spread small integers over the upper bits would do.
  std::uint64_t h = static_cast<std::uint64_t>(low.x) * 0x9E3779B97F4A7C15u;
  h = std::rotl(h ^ static_cast<std::uint64_t>(low.y) * 0xBF58476D1CE4E5B9u, 29);
  h = (h ^ static_cast<std::uint64_t>(high.x)) * 0x94D049BB133111EBu;
  h = (std::rotl(h, 31) ^ static_cast<std::uint64_t>(high.y)) * 0x9E3779B97F4A7C15u;
  return h ^ h >> 32;
}

}  // namespace

int orientation(const GridTriangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Wide area = Wide{b.x - a.x} * (c.y - a.y) - Wide{b.y - a.y} * (c.x - a.x);
  return area > 0 ? 1 : area < 0 ? -1 : 0;
}

std::optional<int> common_orientation(std::span<const GridTriangle> mesh) {
  int common = 0;
  for (const GridTriangle& triangle : mesh) {
    const int turn = orientation(triangle);
    if (turn == 0) continue;
    if (turn == -common) return std::nullopt;
    common = turn;
  }
  return common;
}

void OutlineBuilder::add(const GridPoint& from, const GridPoint& to) {
  if (from == to) return;
  const bool forward = std::pair(from.y, from.x) < std::pair(to.y, to.x);
  const GridPoint& low = forward ? from : to;
  const GridPoint& high = forward ? to : from;
  std::size_t i = hash(low, high) & (slots_.size() - 1);
  while (slots_[i].mesh == mesh_ && !(slots_[i].low == low && slots_[i].high == high)) {
    i = (i + 1) & (slots_.size() - 1);
  }
  Slot& slot = slots_[i];
  if (slot.mesh != mesh_) {
    slot = {low, high, 0, mesh_};
    used_.push_back(i);
  }
  slot.times += forward ? 1 : -1;
}

std::span<const OutlineEdge> OutlineBuilder::build(std::span<const GridTriangle> mesh) {
  // At most half full, so that probing ends soon.
  if (const std::size_t needed = std::bit_ceil(mesh.size() * 6 + 1); slots_.size() < needed) {
    slots_.assign(needed, {});
    mesh_ = 0;
  }
  if (++mesh_ == 0) {
    slots_.assign(slots_.size(), {});
    mesh_ = 1;
  }
  used_.clear();
  for (const auto& [a, b, c] : mesh) {
    add(a, b);
    add(b, c);
    add(c, a);
  }
  outline_.clear();
  for (const std::size_t i : used_) {
    const auto& [low, high, times, owner] = slots_[i];
    if (times > 0) outline_.push_back({low, high, times});
    if (times < 0) outline_.push_back({high, low, -times});
  }
  return outline_;
}

std::optional<std::string> mesh_fault(std::span<const GridTriangle> mesh) {
  int common = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const int turn = orientation(mesh[i]);
    if (turn != 0 && turn == -common) return fmt::format("triangle {} is wound against those before it", i);
    if (turn != 0) common = turn;
  }
  if (common == 0) return std::nullopt;

  OutlineBuilder builder;
  const std::vector<Side> sides = sides_of(builder.build(mesh));
  std::vector<std::int64_t> rows;
  for (const Side& side : sides) {
    rows.push_back(side.upper.y);
    rows.push_back(side.lower.y);
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  std::vector<Side> slab;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    slab.clear();
    for (const Side& side : sides) {
      if (side.upper.y <= rows[i] && side.lower.y >= rows[i + 1]) slab.push_back(side);
    }
    if (auto fault = slab_fault(slab, rows[i], rows[i + 1], common)) return fault;
  }
  return std::nullopt;
}

}  // namespace edgecase::conformance
