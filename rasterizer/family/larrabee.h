// Larrabee's descent: 64x64 tiles, in them 16x16 blocks, in them 4x4 blocks, in them 16 pixels; always 16 at a time.
//
// After Michael Abrash, "Rasterization on Larrabee", 2009. At each level the values of an edge at the 16 children's
// corners are one vector: the value at the region's top-left pixel plus a table of 16 steps that depends on the
// triangle alone. The largest value in a child below zero rejects the child; the smallest not below zero accepts it for
// this edge, which is then dropped for all that lies in the child; a child without edges left is filled. Triangles
// whose box fits into 16x16 or 4x4 pixels begin the descent there.
//
// Exact, in 32 bits from the tile down: an edge that neither rejects nor accepts a region has a value below zero and
// one not below zero in it. So zero lies between its smallest and its largest value there, and no value is further from
// zero than these two are from each other, (size - 1) * (|a| + |b|) <= 63 * (2^24 + 2^24) < 2^31 for 16.8. Only the
// test of the region itself needs 64 bits. The steps, at most 48 * (2^24 + 2^24), fit for the same reason.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "rasterizer/family/setup.h"

namespace edgecase::rasterizer::family {

class Larrabee {
 public:
  explicit constexpr Larrabee(const Setup& setup) : setup_(setup) {}

  template <class Sink>
  constexpr void cover(Sink& sink) {
    const int extent = std::max(setup_.right - setup_.left, setup_.bottom - setup_.top);
    if (extent <= 4) return cover_regions<4>(setup_.left, setup_.top, sink);
    if (extent <= 16) return cover_regions<16>(setup_.left, setup_.top, sink);
    cover_regions<64>(setup_.left & -64, setup_.top & -64, sink);
  }

 private:
  static constexpr std::size_t kChildren = 16;
  /// What leads from an edge's value at a region's top-left pixel to the values in its 16 children, each `Child` pixels
  /// a side: to the top-left pixel of each, and from there to its largest and smallest value.
  struct Steps {
    std::array<std::int32_t, kChildren> to_child;
    std::int32_t to_largest;
    std::int32_t to_smallest;
  };
  /// An edge that crosses a region, by its number and its value at the region's top-left pixel.
  struct Crossing {
    std::size_t edge;
    std::int32_t value;
  };
  struct Crossings {
    std::array<Crossing, 3> list;
    std::size_t count = 0;
    constexpr void add(std::size_t edge, std::int32_t value) { list[count++] = {edge, value}; }
  };

  /// Tables for children of 16, 4 and 1 pixels a side.
  static constexpr std::size_t level(int child) { return child == 16 ? 0 : child == 4 ? 1 : 2; }

  template <int Child>
  constexpr void make_steps() {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto a = static_cast<std::int32_t>(setup_.edges[e].a), b = static_cast<std::int32_t>(setup_.edges[e].b);
      Steps& steps = steps_[level(Child)][e];
      for (int k = 0; k < static_cast<int>(kChildren); ++k) {
        steps.to_child[static_cast<std::size_t>(k)] = a * (k % 4 * Child) + b * (k / 4 * Child);
      }
      steps.to_largest = static_cast<std::int32_t>(setup_.edges[e].to_largest(Child));
      steps.to_smallest = static_cast<std::int32_t>(setup_.edges[e].to_smallest(Child));
    }
    if constexpr (Child > 1) make_steps<Child / 4>();
  }

  /// All regions of that size from (left, top) on.
  template <int Size, class Sink>
  constexpr void cover_regions(int left, int top, Sink& sink) {
    make_steps<Size / 4>();
    for (int y = top; y < setup_.bottom; y += Size) {
      for (int x = left; x < setup_.right; x += Size) cover_region<Size>(x, y, sink);
    }
  }

  template <int Size, class Sink>
  constexpr void cover_region(int x, int y, Sink& sink) const {
    Crossings crossings;
    for (std::size_t e = 0; e < 3; ++e) {
      const PlainEdge& edge = setup_.edges[e];
      const std::int64_t value = edge.at(x - setup_.left, y - setup_.top);
      if (value + edge.to_largest(Size) < 0) return;
      if (value + edge.to_smallest(Size) < 0) crossings.add(e, static_cast<std::int32_t>(value));
    }
    descend<Size>(x, y, crossings, sink);
  }

  template <int Size, class Sink>
  constexpr void descend(int x, int y, const Crossings& crossings, Sink& sink) const {
    if (crossings.count == 0) return emit_block(x, y, Size, setup_.right, setup_.bottom, sink);
    constexpr int kChild = Size / 4;
    std::array<std::array<std::int32_t, kChildren>, 3> values;
    std::array<std::uint32_t, 3> crossed{};  // a bit for each child
    std::uint32_t rejected = 0;
    for (std::size_t i = 0; i < crossings.count; ++i) {
      const Steps& steps = steps_[level(kChild)][crossings.list[i].edge];
      for (std::size_t k = 0; k < kChildren; ++k) {
        values[i][k] = crossings.list[i].value + steps.to_child[k];
        rejected |= std::uint32_t{values[i][k] + steps.to_largest < 0} << k;
        crossed[i] |= std::uint32_t{values[i][k] + steps.to_smallest < 0} << k;
      }
    }
    const std::uint32_t remaining = ~rejected & 0xffff;
    if constexpr (kChild == 1) {
      for (int row = 0; row < std::min(4, setup_.bottom - y); ++row) {
        emit(y + row, x, remaining >> (4 * row) & 0xf, setup_.right, sink);
      }
    } else {
      for (std::uint32_t rest = remaining; rest != 0; rest &= rest - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(rest));
        const int child_x = x + static_cast<int>(k % 4) * kChild, child_y = y + static_cast<int>(k / 4) * kChild;
        // Beyond the box no pixel of the target is inside, and the target itself may have ended.
        if (child_x >= setup_.right || child_y >= setup_.bottom) continue;
        Crossings in_child;
        for (std::size_t i = 0; i < crossings.count; ++i) {
          if (crossed[i] >> k & 1) in_child.add(crossings.list[i].edge, values[i][k]);
        }
        descend<kChild>(child_x, child_y, in_child, sink);
      }
    }
  }

  const Setup& setup_;
  std::array<std::array<Steps, 3>, 3> steps_;
};

template <class F, class Sink>
constexpr void cover_larrabee(const FixedTriangle<F>& triangle, const Target& target, Sink&& sink) {
  static_assert((std::int64_t{kLargestBlock} - 1) * 2 * -std::int64_t{Edge<F>::Step::kMin} <=
                std::numeric_limits<std::int32_t>::max());
  const auto setup = set_up<F>(triangle, target, 4);
  if (setup) Larrabee(*setup).cover(sink);
}

}  // namespace edgecase::rasterizer::family
