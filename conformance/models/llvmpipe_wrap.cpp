#include "conformance/models/llvmpipe_wrap.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "conformance/models/transform_model.h"

namespace edgecase::conformance {
namespace {

constexpr int kTile = 64;
constexpr int kSubpixelBits = 8;
constexpr std::int64_t kPixel = std::int64_t{1} << kSubpixelBits;
/// The largest extent of triangles that are drawn in 32 bits from the start, in pixels.
constexpr std::int64_t kMostShort = 128;
/// Within so many pixels those with four edges are drawn at once.
constexpr int kBlock = 16;

struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;
};
using Points = std::array<Point, 3>;

std::optional<Points> snapped_points(const Setting& setting, const Triangle& triangle) {
  Points points;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto position = snapped(lavapipe_model(), setting, triangle[i]);
    if (!position) return std::nullopt;
    points[i] = {static_cast<std::int64_t>(position->x * kPixel), static_cast<std::int64_t>(position->y * kPixel)};
  }
  return points;
}

/// From a pixel's corner to where its edge functions begin.
std::int64_t first_sample(const Setting& setting) { return setting.samples() > 1 ? 0 : kPixel / 2; }

struct Edge {
  std::int64_t c = 0;  ///< at the first centre or corner of the block; greater than 0 is inside
  std::int64_t a = 0;  ///< c >> 8 from column to column
  std::int64_t b = 0;  ///< c >> 8 from row to row

  Edge at(std::int64_t columns, std::int64_t rows) const { return {c + (a * columns + b * rows) * kPixel, a, b}; }
};

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

/// Pixels first to last, both included.
struct Box {
  std::int64_t left, top, right, bottom;
};

/// From the first pixel that the triangle reaches to the last.
Box box_of(const Setting& setting, const Points& p) {
  const std::int64_t s = first_sample(setting);
  const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto pixel = [&](std::int64_t v) { return (v - s) >> kSubpixelBits; };
  return {pixel(left), pixel(top), pixel(right - 1), pixel(bottom - 1)};
}

Box scissor_of(const Setting& setting) {
  const Extent target = setting.target;
  const Rect r = setting.scissor.value_or(Rect{0, 0, target.width, target.height});
  return {std::max(r.x, 0), std::max(r.y, 0), std::min<std::int64_t>(std::int64_t{r.x} + r.width, target.width) - 1,
          std::min<std::int64_t>(std::int64_t{r.y} + r.height, target.height) - 1};
}

bool meet(const Box& a, const Box& b) {
  return a.left <= b.right && b.left <= a.right && a.top <= b.bottom && b.top <= a.bottom;
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

std::vector<Edge> edges_of(const Setting& setting, const Points& p, bool clockwise) {
  std::vector<Edge> edges(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& from = p[clockwise ? i : (i + 1) % 3];
    const Point& to = p[clockwise ? (i + 1) % 3 : i];
    const std::int64_t a = from.y - to.y, b = to.x - from.x;
    const bool top_left = a > 0 || (a == 0 && b > 0);
    const std::int64_t s = first_sample(setting);
    edges[i] = {a * (s - from.x) + b * (s - from.y) + (top_left ? 1 : 0), a, b};
  }
  return edges;
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
      const SampleLocation& location = setting_.sample_locations[static_cast<std::size_t>(sample)];
      constexpr std::int64_t kSampleUnit = kPixel >> kSampleGridBits;
      const bool outside = std::ranges::any_of(edges, [&](const Edge& e) {
        Edge pixel = e.at(column - x, row - y);
        if (setting_.samples() > 1) pixel.c += (e.a * location.x + e.b * location.y) * kSampleUnit;
        return negative_in_32_bits((pixel.c - 1) >> kSubpixelBits);
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

}  // namespace

bool llvmpipe_may_wrap(const Setting& setting, const Triangle& triangle) {
  // Of nearly all triangles this is all that is asked: whether an edge's value within the tile could come to 2^23 px^2,
  // or at a sample of the first block to 2^13.
  const auto [least_x, greatest_x] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
  const auto [least_y, greatest_y] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  constexpr float kMargin = kTile + 1;
  const float width = greatest_x - least_x, height = greatest_y - least_y;
  const bool huge = (width + kMargin) * (height + kMargin) >= 0x1p22F;
  const bool by_four = std::max(greatest_x, greatest_y) < kBlock + 1 && (width + 1) * (height + 1) >= 0x1p13F;
  if (!huge && !by_four) return false;
  const auto points = snapped_points(setting, triangle);
  if (!points) return false;
  const Box box = box_of(setting, *points);
  if (box.right < 0 || box.bottom < 0 || box.right >= kTile || box.bottom >= kTile) return false;
  if (extent(box) <= kMostShort) return by_four && may_wrap_by_four(setting, box);
  // The most that an edge's value can come to within the tile, in pixels.
  const std::int64_t columns = box.right - box.left + 1, rows = box.bottom - box.top + 1;
  return rows * (columns + kTile) + columns * (rows + kTile) >= std::int64_t{1} << (31 - kSubpixelBits);
}

void predict_llvmpipe_wrap(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  std::ranges::fill(mask, 0);
  const auto points = snapped_points(setting, triangle);
  if (!points) return;
  const auto& [p, q, r] = *points;
  const std::int64_t area = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  const bool front = (area > 0) == (setting.front_face == FrontFace::clockwise);
  if (area == 0 || (setting.cull != CullMode::none && front == (setting.cull == CullMode::front))) return;
  const Box box = box_of(setting, *points), scissor = scissor_of(setting);
  if (!meet(box, scissor)) return;
  std::vector<Edge> edges = edges_of(setting, *points, area > 0);
  append_scissor_edges(setting, box, scissor, edges);
  if (extent(box) <= kMostShort) return draw_by_four(setting, edges, mask);
  Tile(setting, mask).draw(edges, 0, 0, kTile);
}

}  // namespace edgecase::conformance
