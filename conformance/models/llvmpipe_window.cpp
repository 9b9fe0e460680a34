#include "conformance/models/llvmpipe_window.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "conformance/models/drawn_region.h"
#include "conformance/models/llvmpipe_setup.h"
#include "conformance/models/llvmpipe_wrap.h"

namespace edgecase::conformance {
namespace {

using namespace llvmpipe;

bool loose_scissor(const Setting& setting) { return setting.samples() > 1 && setting.scissor; }

// The column of pixels left of the scissor and the row above it, with the pixel where they meet.
struct Strips {
  ScissorReach reach;
  Box column{0, 0, -1, -1};
  Box row{0, 0, -1, -1};

  explicit Strips(const Setting& setting) : reach(lavapipe_model(), setting, nullptr) {
    const Rect& all = reach.all();
    const Rect& told = reach.told();
    const std::int64_t right = std::int64_t{all.x} + all.width - 1, bottom = std::int64_t{all.y} + all.height - 1;
    if (all.x != told.x) column = {all.x, all.y, all.x, bottom};
    if (all.y != told.y) row = {told.x, all.y, right, all.y};
  }
};

Box box_of(const Rect& r) { return {r.x, r.y, std::int64_t{r.x} + r.width - 1, std::int64_t{r.y} + r.height - 1}; }

bool may_pass_scissor(const Setting& setting, const Triangle& triangle) {
  if (!loose_scissor(setting)) return false;
  const auto points = snapped_points(setting, triangle);
  if (!points) return false;
  const Strips strips(setting);
  const Box box = llvmpipe::box_of(setting, *points);
  if (intersection(box, box_of(strips.reach.told())).empty()) return false;
  return !intersection(box, strips.column).empty() || !intersection(box, strips.row).empty();
}

void cover_where_inside(const Setting& setting, const std::array<Edge, 3>& edges, const Box& box,
                        const ScissorReach& reach, MutableMaskView mask) {
  const MaskLayout layout(setting);
  for (int sample = 0; sample < setting.samples(); ++sample) {
    const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(sample)];
    for (std::int64_t row = box.top; row <= box.bottom; ++row) {
      std::array<std::int64_t, 3> values;
      std::ranges::transform(edges, values.begin(),
                             [&](const Edge& e) { return value_at(setting, e.at(box.left, row), sample); });
      for (std::int64_t column = box.left; column <= box.right; ++column) {
        const bool inside = values[0] > 0 && values[1] > 0 && values[2] > 0;
        const int x = static_cast<int>(column), y = static_cast<int>(row);
        if (inside && reach.lets_through(x, y, location)) cover(mask, layout.bit(x, y, sample));
        for (std::size_t i = 0; i < 3; ++i) values[i] += edges[i].a * kPixel;
      }
    }
  }
}

// The rules say what is covered within the scissor.
void draw_past_scissor(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  const auto points = snapped_points(setting, triangle);
  if (!points || is_culled(setting, area_of(*points))) return;
  const Strips strips(setting);
  const auto edges = edges_of(setting, *points);
  const Box box = llvmpipe::box_of(setting, *points);
  cover_where_inside(setting, edges, intersection(box, strips.column), strips.reach, mask);
  cover_where_inside(setting, edges, intersection(box, strips.row), strips.reach, mask);
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
