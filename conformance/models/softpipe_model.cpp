#include "conformance/models/softpipe_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace edgecase::conformance {
namespace {

constexpr float kHalfPixel = 0.5F;

// C's conversion on x86, which yields INT_MIN for what does not fit.
int truncated(float value) {
  constexpr float kLimit = 2147483648.0F;
  return value >= -kLimit && value < kLimit ? static_cast<int>(value) : std::numeric_limits<int>::min();
}

// One edge, followed downwards row by row.
struct Edge {
  float slope = 0;      // columns per row
  float x = 0;          // in the first row, plus half a pixel
  float first_row = 0;  // a whole number
  int rows = 0;

  Edge(const Position& from, const Position& to) {
    const float dx = to.x - from.x;
    const float dy = to.y - from.y;
    const float top = from.y - kHalfPixel;
    first_row = std::ceil(top);
    rows = truncated(std::ceil((to.y - kHalfPixel) - first_row));
    slope = dy != 0 ? dx / dy : 0;
    x = (from.x + kHalfPixel) + (first_row - top) * slope;
  }

  float at(int row) const { return x + static_cast<float>(row) * slope; }

  void advance(int by) {
    x = at(by);
    first_row += static_cast<float>(by);
  }
};

// The rows that `left` and `right` bound together; moves both edges past them.
void fill(Edge& left, Edge& right, int rows, const MaskLayout& layout, MutableMaskView mask) {
  const int first = truncated(left.first_row);
  const int begin = std::max(first, 0);
  const int end = std::min(first + rows, layout.target.height);
  for (int y = begin; y < end; ++y) {
    const int from = std::max(truncated(left.at(y - first)), 0);
    const int to = std::min(truncated(right.at(y - first)), layout.target.width);
    if (from < to) cover_span(mask, layout.bit(from, y, 0), layout.bit(to, y, 0));
  }
  left.advance(rows);
  right.advance(rows);
}

}  // namespace

void predict_softpipe(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  const MaskLayout layout(setting);
  std::ranges::fill(mask, 0);
  std::array<Position, 3> v = triangle;
  // Of two vertices at one height either may be called the middle one: the edge between them has no rows, the other two
  // edges are the same, and the area's sign turns with their roles.
  std::ranges::stable_sort(v, {}, &Position::y);

  Edge major(v[0], v[2]);
  Edge lower(v[0], v[1]);
  Edge upper(v[1], v[2]);
  const float area = (v[2].x - v[0].x) * (v[1].y - v[0].y) - (v[1].x - v[0].x) * (v[2].y - v[0].y);
  const float inverse_area = 1.0F / area;
  if (!std::isfinite(inverse_area)) return;
  const bool major_is_left = inverse_area < 0;
  for (Edge* minor : {&lower, &upper}) {
    fill(major_is_left ? major : *minor, major_is_left ? *minor : major, minor->rows, layout, mask);
  }
}

}  // namespace edgecase::conformance
