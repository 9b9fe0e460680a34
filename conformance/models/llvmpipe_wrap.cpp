#include "conformance/models/llvmpipe_wrap.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

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

/// A side of the scissor is one more edge where the triangle crosses it. Between samples its constants make no
/// difference; of blocks they decide which are asked sample by sample.
void append_scissor_edges(const Setting& setting, const Box& box, const Box& scissor, std::vector<Edge>& edges) {
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
  std::vector<Edge> sides;
  append_scissor_edges(setting, box, scissor_of(setting), sides);
  return sides.size() == 1;
}

void draw_by_four(const Setting& setting, const std::vector<Edge>& edges, MutableMaskView mask) {
  const MaskLayout layout(setting);
  for (int row = 0; row < std::min(kBlock, setting.target.height); ++row) {
    for (int column = 0; column < std::min(kBlock, setting.target.width); ++column) {
      const bool outside = std::ranges::any_of(edges, [&](const Edge& e) {
        const std::int64_t c = e.at(column, row).c;
        return c <= 0 || negative_in_32_bits(4 * (c - 1));
      });
      if (!outside) cover(mask, layout.bit(column, row, 0));
    }
  }
}

class Tile {
 public:
  Tile(const Setting& setting, MutableMaskView mask) : setting_(setting), layout_(setting), mask_(mask) {}

  /// The square of `size` pixels at (x, y), in which `edges` have their origin, is drawn as 16 of a quarter's side.
  void draw(const std::vector<Edge>& edges, int x, int y, int size) {
    const int quarter = size / 4;
    if (quarter == 1) return draw_samples(edges, x, y);
    std::array<std::vector<Edge>, 16> blocks;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const int column = static_cast<int>(i % 4) * quarter, row = static_cast<int>(i / 4) * quarter;
      for (const Edge& e : edges) blocks[i].push_back(e.at(column, row));
    }
    const auto out = [&](const std::vector<Edge>& block) {
      return std::ranges::any_of(block, [&](const Edge& e) { return is_out(e, quarter); });
    };
    if (std::ranges::all_of(blocks, out)) return;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const int column = x + static_cast<int>(i % 4) * quarter, row = y + static_cast<int>(i / 4) * quarter;
      // A block may be both in and out, and then is in.
      if (std::ranges::all_of(blocks[i], [&](const Edge& e) { return is_in(e, quarter); })) {
        fill(column, row, quarter);
      } else if (!out(blocks[i])) {
        draw(blocks[i], column, row, quarter);
      }
    }
  }

 private:
  void draw_samples(const std::vector<Edge>& edges, int x, int y) {
    for_each_sample(x, y, 4, [&](int column, int row, int sample) {
      const bool outside = std::ranges::any_of(edges, [&](const Edge& e) {
        const std::int64_t c = value_at(setting_, e.at(column - x, row - y), sample);
        return negative_in_32_bits((c - 1) >> kSubpixelBits);
      });
      if (!outside) cover(mask_, layout_.bit(column, row, sample));
    });
  }

  void fill(int x, int y, int size) {
    for_each_sample(x, y, size,
                    [&](int column, int row, int sample) { cover(mask_, layout_.bit(column, row, sample)); });
  }

  template <class Visit>
  void for_each_sample(int x, int y, int size, Visit&& visit) {
    for (int row = y; row < std::min(y + size, setting_.target.height); ++row)
      for (int column = x; column < std::min(x + size, setting_.target.width); ++column)
        for (int sample = 0; sample < setting_.samples(); ++sample) visit(column, row, sample);
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

}  // namespace

bool llvmpipe_may_wrap(const Setting& setting, const Triangle& triangle) {
  const Reach reach(triangle);
  if (!reach.far()) return false;
  const auto points = snapped_points(setting, triangle);
  if (!points) return false;
  const Box box = box_of(setting, *points);
  if (box.right < 0 || box.bottom < 0 || box.right >= kTile || box.bottom >= kTile) return false;
  if (extent(box) <= kMostShort) return reach.by_four && may_wrap_by_four(setting, box);
  // The most that an edge's value can come to within the tile, in pixels.
  const std::int64_t columns = box.right - box.left + 1, rows = box.bottom - box.top + 1;
  return rows * (columns + kTile) + columns * (rows + kTile) >= std::int64_t{1} << (31 - kSubpixelBits);
}

// With extents of at most 88 px neither limit of Reach is reached: 153^2 is below 2^22, and 89^2 below 2^13.
bool any_may_wrap(std::span<const Triangle> triangles) {
  if (all_within(triangles, 44)) return false;
  bool any = false;
  for (const Triangle& triangle : triangles) any |= Reach(triangle).far();
  return any;
}

void predict_llvmpipe_wrap(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  std::ranges::fill(mask, 0);
  const auto points = snapped_points(setting, triangle);
  if (!points || is_culled(setting, area_of(*points))) return;
  const Box box = box_of(setting, *points), scissor = scissor_of(setting);
  if (!meet(box, scissor)) return;
  const auto of_triangle = edges_of(setting, *points);
  std::vector<Edge> edges(of_triangle.begin(), of_triangle.end());
  append_scissor_edges(setting, box, scissor, edges);
  if (extent(box) <= kMostShort) return draw_by_four(setting, edges, mask);
  Tile(setting, mask).draw(edges, 0, 0, kTile);
}

}  // namespace edgecase::conformance
