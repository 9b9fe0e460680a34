#include "conformance/runner/clipper_probe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "conformance/generators/generator.h"
#include "conformance/models/clip_model.h"
#include "conformance/runner/prediction.h"
#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

using enum ClipPlane;

// From -1 to 1.
float unit(Random& random) { return std::ldexp(static_cast<float>(random.between(-(1 << 22), 1 << 22)), -22); }

ClipPosition inside(Random& random) {
  const float w = random.one_in(2) ? 1 : std::exp2(2 * unit(random));
  const float x = unit(random);
  const float y = unit(random);
  return {x * w, y * w, (0.5F + 0.45F * unit(random)) * w, w};
}

void send_across(ClipPlane plane, ClipPosition& p, Random& random) {
  const float beyond = (1 + 1.5F * (1 + unit(random))) * p.w;
  switch (plane) {
    case left:
      p.x = -beyond;
      break;
    case right:
      p.x = beyond;
      break;
    case bottom:
      p.y = -beyond;
      break;
    case top:
      p.y = beyond;
      break;
    case near:
      p.z = random.one_in(2) ? -beyond : 0.5F * (p.w - beyond);
      break;
    case far:
      p.z = beyond;
      break;
  }
}

// The third vertex on the line between the others, as nearly as rounding lets it: what clipping and snapping leave of
// it may be wound either way.
void flatten(ClipTriangle& triangle) {
  const auto halfway = [&](float ClipPosition::*of) { return 0.5F * (triangle[0].*of + triangle[1].*of); };
  triangle[2].x = halfway(&ClipPosition::x);
  triangle[2].y = halfway(&ClipPosition::y);
  triangle[2].w = halfway(&ClipPosition::w);
}

bool same_but_for_positions(const TransformModel& a, const TransformModel& b) {
  return a.viewport_scissor == b.viewport_scissor && a.loose_multisample_scissor == b.loose_multisample_scissor &&
         a.winding == b.winding && a.fill == b.fill && a.also_culls == b.also_culls &&
         a.fan_ends_with_first == b.fan_ends_with_first;
}

// What clipping leaves in the window of a triangle that can be changed a little.
class Clipped {
 public:
  Clipped(const TransformModel& a, const TransformModel& b, Scene& scene) : a_(a), b_(b), scene_(scene) {}

  bool differs() {
    append(a_, of_a_);
    append(b_, of_b_);
    return of_a_ != of_b_;
  }

  // Models that differ in the last bit part only where that bit decides the snap. So one coordinate is moved, by
  // bisection, to where a vertex goes from one grid point to the next for the one model: for the other that may be the
  // next float, or the one before.
  bool move_until_it_differs(Random& random) {
    constexpr std::array kCoordinates{&ClipPosition::x, &ClipPosition::y, &ClipPosition::z, &ClipPosition::w};
    constexpr int kFloatsAround = 4;
    ClipPosition& vertex = scene_.clip->triangles.front()[static_cast<std::size_t>(random.between(0, 2))];
    float& moved = vertex.*kCoordinates[static_cast<std::size_t>(random.between(0, 3))];
    float low = moved;
    float high = low * (1 + 0x1p-7F);
    append(a_, of_low_);
    moved = high;
    append(a_, of_a_);
    if (of_a_ == of_low_) return false;
    for (float middle = low + (high - low) / 2; middle != low && middle != high; middle = low + (high - low) / 2) {
      moved = middle;
      append(a_, of_a_);
      (of_a_ == of_low_ ? low : high) = middle;
    }
    moved = low;
    for (int i = 0; i < kFloatsAround; ++i) moved = std::nextafter(moved, 2 * low - high);
    for (int i = -kFloatsAround; i <= kFloatsAround; ++i) {
      if (differs()) return true;
      moved = std::nextafter(moved, high + (high - low));
    }
    return false;
  }

 private:
  void append(const TransformModel& model, std::vector<WindowTriangle>& out) {
    out.clear();
    append_window_triangles(model, scene_.setting, scene_.clip->viewport, scene_.clip->triangles.front(), out);
  }

  const TransformModel& a_;
  const TransformModel& b_;
  Scene& scene_;
  std::vector<WindowTriangle> of_a_;
  std::vector<WindowTriangle> of_b_;
  std::vector<WindowTriangle> of_low_;
};

bool same_mask(const TransformModel& a, const TransformModel& b, const Scene& scene) {
  MaskBatch masks;
  const WindowScene window = predict(a, scene, masks);
  return !window.unpredicted.empty() || compare_with_prediction(b, scene, masks).wrong == 0;
}

}  // namespace

ClipScenes clip_arrangements(const Rules& rules) {
  ClipScenes all;
  for (const int samples : {1, 4}) {
    Scene scene;
    scene.rules = rules;
    const auto locations = standard_sample_locations(samples);
    scene.setting.sample_locations.assign(locations.begin(), locations.end());
    const auto add = [&](const Viewport& viewport) {
      scene.clip = ClipGeometry{viewport, {}};
      all.push_back(scene);
    };
    add({0, 0, 32, 32});
    add({-40, -30, 100, 75});
    add({2.5005F, 1.5015F, 20.25F, 26.75F});
    add({3.3F, 30.1F, 27.3F, -37.7F});
    scene.setting.scissor = Rect{5, 7, 19, 13};
    add({-9.3F, -11.7F, 41.1F, 47.9F});
    scene.setting.scissor.reset();
    scene.setting.cull = CullMode::back;
    add({0.3F, -1.7F, 33.1F, 27.9F});
  }
  return all;
}

ClipTriangle across(const std::vector<ClipPlane>& planes, Random& random) {
  ClipTriangle triangle{inside(random), inside(random), inside(random)};
  if (random.one_in(8)) flatten(triangle);
  for (const ClipPlane plane : planes) {
    for (std::int64_t moved = random.between(1, 2); moved > 0; --moved) {
      send_across(plane, triangle[static_cast<std::size_t>(random.between(0, 2))], random);
    }
  }
  return triangle;
}

ClipTriangle across_any(Random& random) {
  ClipTriangle triangle{inside(random), inside(random), inside(random)};
  if (random.one_in(8)) flatten(triangle);
  const float reach = std::ldexp(1.0F, static_cast<int>(random.between(0, 3)));
  const bool either_sign = random.one_in(3);
  const bool flat = random.one_in(2);
  for (ClipPosition& p : triangle) {
    p.x *= reach;
    p.y *= reach;
    p.z = flat ? 0.5F * p.w : (p.z - 0.5F * p.w) * 3 + 0.5F * p.w;
    if (either_sign && random.one_in(3)) p.w = -p.w;
  }
  return triangle;
}

ClipScenes culled_slivers(const Rules& rules, std::size_t count) {
  const auto generated = [&](std::string_view name) {
    const Generator& generator = *find_generator(name);
    Scene scene;
    scene.rules = rules;
    scene.setting = generator.setting;
    for (std::size_t i = 0; i < count; ++i) append_scene(generator, 1, i, scene);
    return scene;
  };
  ClipScenes scenes{generated("cull_turned"), generated("cull_across")};
  scenes[0].clip->triangles[count / 2] = scenes[1].clip->triangles[0];
  return scenes;
}

ClipScenes tell_apart(const TransformModel& a, const TransformModel& b, const ClipScenes& arrangements,
                      const std::function<ClipTriangle(Random&)>& make, std::size_t wanted, std::size_t tries) {
  ClipScenes found = arrangements;
  Random random = Random::stream(1, "tell_apart", 0);
  const bool positions_only = same_but_for_positions(a, b);
  Scene one;
  for (std::size_t i = 0; i < tries && wanted != 0; ++i) {
    const std::size_t arrangement = i % arrangements.size();
    one.setting = arrangements[arrangement].setting;
    one.rules = arrangements[arrangement].rules;
    one.clip = ClipGeometry{arrangements[arrangement].clip->viewport, {make(random)}};
    Clipped clipped(a, b, one);
    // Models that differ in more than positions may need either kind of triangle.
    const bool refined = positions_only || i % 2 == 0;
    if (refined && !clipped.differs() && !clipped.move_until_it_differs(random) && positions_only) continue;
    if (same_mask(a, b, one)) continue;
    found[arrangement].clip->triangles.push_back(one.clip->triangles.front());
    --wanted;
  }
  std::erase_if(found, [](const Scene& scene) { return scene.clip->triangles.empty(); });
  return found;
}

}  // namespace edgecase::conformance
