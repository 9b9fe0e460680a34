#include "conformance/compare/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>

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

/// The point as one number: y in its upper half, x in its lower, both moved so that none is negative.
template <typename Key>
Key key_of(const GridPoint& p) {
  constexpr int kHalf = sizeof(Key) * 4;
  constexpr Key kMoved = Key{1} << (kHalf - 1);
  return (static_cast<Key>(p.y) + kMoved) << kHalf | (static_cast<Key>(p.x) + kMoved);
}

template <typename Key>
GridPoint point_of(Key key) {
  constexpr int kHalf = sizeof(Key) * 4;
  constexpr Key kMoved = Key{1} << (kHalf - 1);
  constexpr Key kLower = (Key{1} << kHalf) - 1;
  return {static_cast<std::int64_t>((key & kLower) - kMoved), static_cast<std::int64_t>((key >> kHalf) - kMoved)};
}

bool fits_32_bits(std::span<const GridTriangle> mesh) {
  std::uint64_t beyond = 0;
  for (const GridTriangle& triangle : mesh) {
    for (const GridPoint& p : triangle) {
      beyond |= (static_cast<std::uint64_t>(p.x) + (1u << 31)) | (static_cast<std::uint64_t>(p.y) + (1u << 31));
    }
  }
  return beyond >> 32 == 0;
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

template <typename Key>
void OutlineBuilder::Edges<Key>::reserve(std::size_t triangles) {
  // At most half full, so that probing ends soon; of a larger table the beginning is used, which stays in the cache.
  const std::size_t needed = std::bit_ceil(triangles * 6 + 2);
  hash_shift_ = 64 - std::countr_zero(needed);
  if (slots_.size() < needed) {
    slots_.assign(needed, {});
    used_.resize(needed / 2);
    mesh_ = 0;
  }
  if (++mesh_ == 0) {
    slots_.assign(slots_.size(), {});
    mesh_ = 1;
  }
}

/// All bits of a product bear on its upper ones. Odd multipliers from splitmix64 and its relatives; any that spread
/// small integers would do. With wide keys the upper halves, the rows, get a share by addition.
template <typename Key>
std::uint64_t hash_of(Key low, Key high) {
  const auto folded = [](Key key) {
    if constexpr (sizeof(Key) == 8) {
      return key;
    } else {
      return static_cast<std::uint64_t>(key) + std::rotl(static_cast<std::uint64_t>(key >> 64), 32);
    }
  };
  return (folded(low) * 0x9E3779B97F4A7C15u) ^ (folded(high) * 0xBF58476D1CE4E5B9u);
}

template <typename Key>
void OutlineBuilder::Edges<Key>::collect(std::span<const GridTriangle> mesh, std::vector<OutlineEdge>& outline) {
  reserve(mesh.size());
  // Names of its own for what stays the same, which stores to the slots might change for all a compiler knows.
  Slot* const slots = slots_.data();
  std::uint32_t* const used = used_.data();
  const int shift = hash_shift_;
  const std::size_t last = (std::size_t{1} << (64 - shift)) - 1;
  const std::uint32_t current = mesh_;
  std::size_t count = 0;
  const auto add = [&](Key from, Key to) {
    const Key low = std::min(from, to);
    const Key high = std::max(from, to);
    std::size_t i = hash_of(low, high) >> shift;
    while (slots[i].mesh == current && !(slots[i].low == low && slots[i].high == high)) i = (i + 1) & last;
    // Whether an edge is there already, no processor can predict either. One without length leads nowhere.
    const bool fresh = slots[i].mesh != current;
    used[count] = static_cast<std::uint32_t>(i);
    count += fresh ? 1 : 0;
    slots[i] = {low, high, (fresh ? 0 : slots[i].times) + (from < to ? 1 : 0) - (to < from ? 1 : 0), current};
  };
  for (const GridTriangle& triangle : mesh) {
    const Key a = key_of<Key>(triangle[0]), b = key_of<Key>(triangle[1]), c = key_of<Key>(triangle[2]);
    add(a, b);
    add(b, c);
    add(c, a);
  }
  outline.resize(count);
  std::size_t left = 0;
  for (const std::uint32_t i : std::span(used, count)) {
    const auto& [low, high, times, owner] = slots[i];
    outline[left] = {point_of(times > 0 ? low : high), point_of(times > 0 ? high : low), std::abs(times)};
    left += times != 0 ? 1 : 0;
  }
  outline.resize(left);
}

std::span<const OutlineEdge> OutlineBuilder::build(std::span<const GridTriangle> mesh) {
  outline_.clear();
  if (fits_32_bits(mesh)) {
    narrow_.collect(mesh, outline_);
  } else {
    wide_.collect(mesh, outline_);
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
