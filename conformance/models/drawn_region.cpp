#include "conformance/models/drawn_region.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace edgecase::conformance {
namespace {

// llvmpipe's tiles, beyond which even its loose scissor lets nothing through.
constexpr int kTile = 64;

// Pixels first to last, both included.
struct Range {
  int first = 0;
  int last = -1;
};

Range meet(const Range& a, const Range& b) { return {std::max(a.first, b.first), std::min(a.last, b.last)}; }

Range pixels(int from, int size, int limit) {
  const std::int64_t end = std::int64_t{from} + size;
  return {std::max(from, 0), static_cast<int>(std::clamp<std::int64_t>(end, 0, limit)) - 1};
}

// As llvmpipe computes them from the scale and offset of the transform. Points that lie half way are pixel centres, and
// 1/1000 keeps them from being decided by rounding.
Range viewport_pixels(const AxisTransform& axis) {
  const float half = std::abs(axis.half);
  const float low = axis.centre - half;
  const float high = half * 2 + low;
  return {static_cast<int>(low + 0.499F), static_cast<int>(high - 0.501F)};
}

Rect rectangle(const Range& x, const Range& y) {
  if (x.first > x.last || y.first > y.last) return {};
  return {x.first, y.first, x.last - x.first + 1, y.last - y.first + 1};
}

}  // namespace

ScissorReach::ScissorReach(const TransformModel& model, const Setting& setting, const Viewport* viewport)
    : test_boxes_(model.loose_multisample_scissor && setting.samples() > 1) {
  const Extent target = setting.target;
  const Rect scissor = setting.scissor.value_or(Rect{0, 0, target.width, target.height});
  Range x = pixels(scissor.x, scissor.width, target.width);
  Range y = pixels(scissor.y, scissor.height, target.height);
  if (model.viewport_scissor && viewport != nullptr) {
    x = meet(x, viewport_pixels(AxisTransform::of(viewport->x, viewport->width)));
    y = meet(y, viewport_pixels(AxisTransform::of(viewport->y, viewport->height)));
  }
  told_ = rectangle(x, y);
  all_ = told_;
  if (!test_boxes_ || told_.width == 0) return;
  const Range wide{x.first % kTile == 0 ? x.first : x.first - 1, x.last};
  const Range tall{y.first % kTile == 0 ? y.first : y.first - 1, y.last};
  all_ = rectangle(wide, tall);
}

bool ScissorReach::meets(const Triangle& triangle) const {
  if (!test_boxes_) return true;
  const auto [left, right] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
  const auto [top, bottom] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  // The last pixel that a box reaches into: one that ends on a pixel's border does not reach beyond it.
  return std::floor(left) < static_cast<float>(told_.x + told_.width) &&
         std::ceil(right) > static_cast<float>(told_.x) &&
         std::floor(top) < static_cast<float>(told_.y + told_.height) &&
         std::ceil(bottom) > static_cast<float>(told_.y);
}

DrawnRegion::DrawnRegion(const TransformModel& model, const Setting& setting, const Viewport* viewport)
    : reach_(model, setting, viewport) {
  const Rect& all = reach_.all();
  if (all == reach_.told()) return;
  const MaskLayout layout(setting);
  passed_.resize(layout.words());
  for (int row = all.y; row < all.y + all.height; ++row) {
    for (int column = all.x; column < all.x + all.width; ++column) {
      for (int s = 0; s < layout.samples; ++s) {
        if (!reach_.lets_through(column, row, setting.sample_locations[static_cast<std::size_t>(s)])) continue;
        cover(passed_, layout.bit(column, row, s));
      }
    }
  }
}

void DrawnRegion::filter(MutableMaskView mask) const {
  if (!passed_.empty()) std::ranges::transform(mask, passed_, mask.begin(), std::bit_and<>());
}

}  // namespace edgecase::conformance
