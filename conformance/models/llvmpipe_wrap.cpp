#include "conformance/models/llvmpipe_wrap.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "conformance/models/llvmpipe_setup.h"
#include "conformance/scene/coordinates.h"

namespace edgecase::conformance {
namespace {

using namespace llvmpipe;

/// The largest extent of triangles that are drawn in 32 bits from the start, in pixels.
constexpr std::int64_t kMostShort = 128;
/// Within so many pixels those with four edges are drawn at once.
constexpr int kBlock = 16;

bool negative_in_32_bits(std::int64_t value) { return (value >> 31 & 1) != 0; }

/// In the corner of a square of `size` pixels furthest inside.
bool is_out(const Edge& e, std::int64_t size) {
  return negative_in_32_bits((e.c >> kSubpixelBits) +
                             size * (std::max<std::int64_t>(e.a, 0) + std::max<std::int64_t>(e.b, 0)));
}
/// In the opposite corner.
bool is_in(const Edge& e, std::int64_t size) {
  return !negative_in_32_bits(((e.c - 1) >> kSubpixelBits) +
                              size * (std::min<std::int64_t>(e.a, 0) + std::min<std::int64_t>(e.b, 0)));
}

/// Those of the triangle and of the scissor's sides.
using Edges = boost::container::static_vector<Edge, 7>;

/// A side of the scissor is one more edge where the triangle crosses it. Between samples its constants make no
/// difference; of blocks they decide which are asked sample by sample.
void append_scissor_edges(const Setting& setting, const Box& box, const Box& scissor, Edges& edges) {
  const std::int64_t loose = setting.samples() > 1 ? 127 : 0;
  const auto low = [&](std::int64_t first) { return -((first - 1) * kPixel + loose); };
  const auto high = [&](std::int64_t last) { return last * kPixel + 127 + loose; };
  if (std::max<std::int64_t>(box.left, 0) < scissor.left) edges.push_back({low(scissor.left), 1, 0});
  if (box.right > scissor.right) edges.push_back({high(scissor.right), -1, 0});
  if (std::max<std::int64_t>(box.top, 0) < scissor.top) edges.push_back({low(scissor.top), 0, 1});
  if (box.bottom > scissor.bottom) edges.push_back({high(scissor.bottom), 0, -1});
}

/// Both extents at once, from the first pixel of a 4x4 block on.
std::int64_t extent(const Box& box) {
  constexpr auto rounded = [](std::int64_t first) { return first & ~std::int64_t{3}; };
  return (box.right - rounded(box.left)) | (box.bottom - rounded(box.top));
}

/// The most that an edge's value can come to at a sample of the triangle is twice its area, which is no more than its
/// box. One that reaches 2^29 is wider and higher than a block, and then ends in the first one if it ends in any.
bool may_wrap_by_four(const Setting& setting, const Box& box) {
  if (setting.samples() > 1 || box.right >= kBlock || box.bottom >= kBlock) return false;
  Edges sides;
  append_scissor_edges(setting, box, scissor_of(setting), sides);
  return sides.size() == 1;
}

/// The sign of 4 * (c - 1) in 32 bits is bit 29 of c - 1, of which bit 63 is the sign that the rules ask for: both are
/// 0 for what is inside.
constexpr std::uint64_t kOutsideByFour = std::uint64_t{1} << 63 | std::uint64_t{1} << 29;

void draw_by_four(const Setting& setting, const Edges& edges, const Box& box, MutableMaskView mask) {
  const MaskLayout layout(setting);
  Edges asked;
  for (const Edge& e : edges) {
    const std::int64_t least = e.at(e.a < 0 ? box.right : box.left, e.b < 0 ? box.bottom : box.top).c - 1;
    const std::int64_t most = e.at(e.a > 0 ? box.right : box.left, e.b > 0 ? box.bottom : box.top).c - 1;
    const bool all_inside = least >= 0 && most < std::int64_t{1} << 29;
    if (!all_inside) asked.push_back(e);
  }
  for (std::int64_t row = box.top; row <= box.bottom; ++row) {
    std::uint64_t inside = 0;
    for (std::int64_t column = box.left; column <= box.right; ++column) {
      std::uint64_t values = 0;
      for (const Edge& e : asked) values |= static_cast<std::uint64_t>(e.at(column, row).c - 1);
      inside |= std::uint64_t{(values & kOutsideByFour) == 0} << column;
    }
    mask[layout.bit(0, static_cast<int>(row), 0) / 64] = inside;
  }
}

class Tile {
 public:
  Tile(const Setting& setting, MutableMaskView mask) : setting_(setting), layout_(setting), mask_(mask) {}

  /// The square of `size` pixels at (x, y), in which `edges` have their origin, is drawn as 16 of a quarter's side.
  void draw(const Edges& edges, int x, int y, int size) {
    if (size == kSampled) return draw_samples(edges, x, y);
    const int quarter = size / 4;
    unsigned out = 0;
    unsigned in = 0xffff;
    for (const Edge& e : edges) {
      for (int i = 0; i < 16; ++i) {
        const Edge block = e.at(i % 4 * quarter, i / 4 * quarter);
        out |= unsigned{is_out(block, quarter)} << i;
        in &= ~(unsigned{!is_in(block, quarter)} << i);
      }
    }
    if (out == 0xffff) return;
    for (int i = 0; i < 16; ++i) {
      const int column = i % 4 * quarter, row = i / 4 * quarter;
      // A block may be both in and out, and then is in.
      if ((in >> i & 1) != 0) {
        fill(x + column, y + row, quarter);
      } else if ((out >> i & 1) == 0) {
        Edges of_block;
        for (const Edge& e : edges) of_block.push_back(e.at(column, row));
        draw(of_block, x + column, y + row, quarter);
      }
    }
  }

 private:
  static constexpr int kSampled = 4;  ///< the side of blocks of which the samples are asked

  /// An edge has the same sign in 32 bits at every sample if its value's bits from that one on are the same in the
  /// block's corners where it is least and greatest.
  void draw_samples(const Edges& edges, int x, int y) {
    constexpr int kSignBit = 31 + kSubpixelBits;
    const int columns = std::min(kSampled, setting_.target.width - x);
    const int rows = std::min(kSampled, setting_.target.height - y);
    Edges asked;
    for (const Edge& e : edges) {
      const std::int64_t across = std::min<std::int64_t>(e.a, 0) + std::min<std::int64_t>(e.b, 0);
      const std::int64_t back = std::max<std::int64_t>(e.a, 0) + std::max<std::int64_t>(e.b, 0);
      const std::int64_t least = (e.c - 1 + kSampled * kPixel * across) >> kSignBit;
      const std::int64_t most = (e.c - 1 + kSampled * kPixel * back) >> kSignBit;
      if (least != most) {
        asked.push_back(e);
      } else if ((least & 1) != 0) {
        return;
      }
    }
    if (asked.empty()) return fill(x, y, kSampled);
    for (int sample = 0; sample < setting_.samples(); ++sample) {
      std::uint32_t outside = 0;
      for (const Edge& e : asked) {
        const std::int64_t first = value_at(setting_, e, sample) - 1;
        for (int i = 0; i < kSampled * kSampled; ++i) {
          const std::int64_t c = first + (e.a * (i % kSampled) + e.b * (i / kSampled)) * kPixel;
          outside |= static_cast<std::uint32_t>(c >> kSignBit & 1) << i;
        }
      }
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
          if ((outside >> (row * kSampled + column) & 1) == 0) cover(mask_, layout_.bit(x + column, y + row, sample));
        }
      }
    }
  }

  void fill(int x, int y, int size) {
    const int end = std::min(x + size, setting_.target.width);
    for (int row = y; row < std::min(y + size, setting_.target.height); ++row) {
      if (x < end) cover_span(mask_, layout_.bit(x, row, 0), layout_.bit(end, row, 0));
    }
  }

  const Setting& setting_;
  MaskLayout layout_;
  MutableMaskView mask_;
};

/// Of nearly all triangles this is all that is asked: whether an edge's value within the tile could come to 2^23 px^2,
/// or at a sample of the first block to 2^13. In operations that take no branch.
struct Reach {
  bool huge;
  bool by_four;

  explicit Reach(const Triangle& t) {
    constexpr float kMargin = kTile + 1;
    const auto least = [](float a, float b) { return a < b ? a : b; };
    const auto greatest = [](float a, float b) { return a > b ? a : b; };
    const float right = greatest(greatest(t[0].x, t[1].x), t[2].x), bottom = greatest(greatest(t[0].y, t[1].y), t[2].y);
    const float width = right - least(least(t[0].x, t[1].x), t[2].x);
    const float height = bottom - least(least(t[0].y, t[1].y), t[2].y);
    huge = (width + kMargin) * (height + kMargin) >= 0x1p22F;
    by_four = (greatest(right, bottom) < kBlock + 1) & ((width + 1) * (height + 1) >= 0x1p13F);
  }
  bool far() const { return huge | by_four; }
};

/// Whether an edge has a value within the tile that 32 bits do not hold once it is shifted; if none has, every sign is
/// the exact one. Values are greatest and least in the tile's corners; 4 makes up for what shifts take away.
bool wraps(const std::array<Edge, 3>& edges) {
  constexpr std::int64_t kFits = (std::int64_t{1} << 31) - 4;
  return std::ranges::any_of(edges, [](const Edge& e) {
    const std::int64_t c = e.c >> kSubpixelBits;
    const std::int64_t least = std::min<std::int64_t>(e.a, 0) + std::min<std::int64_t>(e.b, 0);
    const std::int64_t most = std::max<std::int64_t>(e.a, 0) + std::max<std::int64_t>(e.b, 0);
    return c + kTile * least < -kFits || c + kTile * most > kFits;
  });
}

bool wraps_by_four(const Setting& setting, const std::array<Edge, 3>& edges) {
  const auto columns = std::min(kBlock, setting.target.width) - 1, rows = std::min(kBlock, setting.target.height) - 1;
  return std::ranges::any_of(
      edges, [&](const Edge& e) { return e.at(e.a > 0 ? columns : 0, e.b > 0 ? rows : 0).c > std::int64_t{1} << 29; });
}

bool wraps(const Setting& setting, const Box& box, const std::array<Edge, 3>& edges) {
  if (box.right < 0 || box.bottom < 0 || box.right >= kTile || box.bottom >= kTile) return false;
  if (extent(box) > kMostShort) return wraps(edges);
  return may_wrap_by_four(setting, box) && wraps_by_four(setting, edges);
}

}  // namespace

bool llvmpipe_may_wrap(const Triangle& triangle) { return Reach(triangle).far(); }

// With extents of at most 88 px neither limit of Reach is reached: 153^2 is below 2^22, and 89^2 below 2^13.
bool llvmpipe_any_may_wrap(std::span<const Triangle> triangles) {
  if (all_within(triangles, 44)) return false;
  bool any = false;
  for (const Triangle& triangle : triangles) any |= Reach(triangle).far();
  return any;
}

bool predict_llvmpipe_wrap(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  if (!llvmpipe_may_wrap(triangle)) return false;
  const auto points = snapped_points(setting, triangle);
  if (!points) return false;
  const Box box = box_of(setting, *points);
  const auto of_triangle = edges_of(setting, *points);
  if (!wraps(setting, box, of_triangle)) return false;
  std::ranges::fill(mask, 0);
  const Box scissor = scissor_of(setting), drawn = intersection(box, scissor);
  if (drawn.empty() || is_culled(setting, area_of(*points))) return true;
  Edges edges(of_triangle.begin(), of_triangle.end());
  append_scissor_edges(setting, box, scissor, edges);
  if (extent(box) <= kMostShort) {
    draw_by_four(setting, edges, drawn, mask);
  } else {
    Tile(setting, mask).draw(edges, 0, 0, kTile);
  }
  return true;
}

}  // namespace edgecase::conformance
