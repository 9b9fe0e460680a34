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

// `strip` is a part of one row or of one column.
void cover_strip(const Setting& setting, const std::array<Edge, 3>& edges, const Box& strip, const ScissorReach& reach,
                 MutableMaskView mask) {
  if (strip.empty()) return;
  const MaskLayout layout(setting);
  const bool down = strip.left == strip.right;
  const auto x = static_cast<int>(strip.left), y = static_cast<int>(strip.top);
  const auto last_x = static_cast<int>(strip.right), last_y = static_cast<int>(strip.bottom);
  const int count = down ? last_y - y + 1 : last_x - x + 1;
  for (int sample = 0; sample < setting.samples(); ++sample) {
    const SampleLocation& location = setting.sample_locations[static_cast<std::size_t>(sample)];
    // If it is not in the last pixel, the furthest from the corner, it is in none.
    if (!reach.lets_through(last_x, last_y, location)) continue;
    std::array<std::int64_t, 3> values, steps;
    for (std::size_t i = 0; i < 3; ++i) {
      values[i] = value_at(setting, edges[i].at(x, y), sample);
      steps[i] = (down ? edges[i].b : edges[i].a) * kPixel;
    }
    for (int i = 0; i < count; ++i) {
      const int column = down ? x : x + i, row = down ? y + i : y;
      const bool inside = values[0] > 0 && values[1] > 0 && values[2] > 0;
      if (inside && reach.lets_through(column, row, location)) cover(mask, layout.bit(column, row, sample));
      for (std::size_t k = 0; k < 3; ++k) values[k] += steps[k];
    }
  }
}

// The rules say what is covered within the scissor.
void draw_past_scissor(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  const auto points = snapped_points(setting, triangle);
  if (!points || is_culled(setting, area_of(*points))) return;
  const Strips strips(setting);
  const Box box = llvmpipe::box_of(setting, *points);
  if (intersection(box, box_of(strips.reach.told())).empty()) return;
  const auto edges = edges_of(setting, *points);
  cover_strip(setting, edges, intersection(box, strips.column), strips.reach, mask);
  cover_strip(setting, edges, intersection(box, strips.row), strips.reach, mask);
}

}  // namespace

bool llvmpipe_passes_scissor(const Setting& setting) { return setting.samples() > 1 && setting.scissor; }

bool llvmpipe_may_deviate(const Setting& setting, const Triangle& triangle) {
  return llvmpipe_passes_scissor(setting) || llvmpipe_may_wrap(triangle);
}

bool llvmpipe_any_may_deviate(const Setting& setting, std::span<const Triangle> triangles) {
  return llvmpipe_passes_scissor(setting) || llvmpipe_any_may_wrap(triangles);
}

void predict_llvmpipe(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  if (predict_llvmpipe_wrap(setting, triangle, mask) || !llvmpipe_passes_scissor(setting)) return;
  draw_past_scissor(setting, triangle, mask);
}

}  // namespace edgecase::conformance
