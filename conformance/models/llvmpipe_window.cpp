#include "conformance/models/llvmpipe_window.h"

#include <algorithm>

#include "conformance/models/drawn_region.h"
#include "conformance/models/llvmpipe_setup.h"
#include "conformance/models/llvmpipe_wrap.h"

namespace edgecase::conformance {
namespace {

using namespace llvmpipe;

bool loose_scissor(const Setting& setting) { return setting.samples() > 1 && setting.scissor; }

// Whether the triangle's box has to do with the column of pixels left of the scissor or the row above it.
bool may_pass_scissor(const Setting& setting, const Triangle& triangle) {
  if (!loose_scissor(setting)) return false;
  const auto points = snapped_points(setting, triangle);
  if (!points) return false;
  const Box box = box_of(setting, *points), scissor = scissor_of(setting);
  if (scissor.left > scissor.right || scissor.top > scissor.bottom) return false;
  const Box left{scissor.left - 1, scissor.top - 1, scissor.left - 1, scissor.bottom};
  const Box above{scissor.left - 1, scissor.top - 1, scissor.right, scissor.top - 1};
  return meet(box, left) || meet(box, above);
}

// As the rules have it, but with what the scissor lets through.
void draw_past_scissor(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  std::ranges::fill(mask, 0);
  const auto points = snapped_points(setting, triangle);
  const DrawnRegion region(lavapipe_model(), setting, nullptr);
  if (!points || is_culled(setting, area_of(*points)) || !region.meets(triangle)) return;
  const auto edges = edges_of(setting, *points);
  const MaskLayout layout(setting);
  const Rect& reach = region.reach();
  for (int row = reach.y; row < reach.y + reach.height; ++row) {
    for (int column = reach.x; column < reach.x + reach.width; ++column) {
      for (int sample = 0; sample < setting.samples(); ++sample) {
        if (std::ranges::all_of(
                edges, [&](const Edge& edge) { return value_at(setting, edge.at(column, row), sample) > 0; })) {
          cover(mask, layout.bit(column, row, sample));
        }
      }
    }
  }
  region.filter(mask);
}

}  // namespace

bool llvmpipe_may_deviate(const Setting& setting, const Triangle& triangle) {
  return llvmpipe_may_wrap(setting, triangle) || may_pass_scissor(setting, triangle);
}

bool llvmpipe_any_may_deviate(const Setting& setting, std::span<const Triangle> triangles) {
  return loose_scissor(setting) || any_may_wrap(triangles);
}

void predict_llvmpipe(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  if (llvmpipe_may_wrap(setting, triangle)) return predict_llvmpipe_wrap(setting, triangle, mask);
  draw_past_scissor(setting, triangle, mask);
}

}  // namespace edgecase::conformance
