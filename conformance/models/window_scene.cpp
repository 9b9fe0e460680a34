#include "conformance/models/window_scene.h"

#include <algorithm>
#include <functional>
#include <span>

#include "conformance/models/clip_model.h"

namespace edgecase::conformance {
namespace {

std::optional<Turn> append_snapped(const TransformModel& model, const Setting& setting, const Triangle& triangle,
                                   std::vector<WindowTriangle>& out) {
  Triangle result;
  for (std::size_t v = 0; v < 3; ++v) {
    const auto at = snapped(model, setting, triangle[v]);
    if (!at) return std::nullopt;
    result[v] = *at;
  }
  out.push_back({result});
  return Turn::none;
}

bool culled(const Setting& setting, Turn turn) {
  if (setting.cull == CullMode::none) return false;
  const Turn front = setting.front_face == FrontFace::clockwise ? Turn::clockwise : Turn::counter_clockwise;
  // A triangle without area, which can only be one that covers something after all, faces front.
  const bool faces_front = turn == front || turn == Turn::none;
  return faces_front == (setting.cull == CullMode::front);
}

// Of each triangle of the scene, whether llvmpipe's second culling concerns it.
std::vector<bool> culled_twice(const TransformModel& model, const Scene& scene) {
  const auto& triangles = scene.clip->triangles;
  std::vector<bool> result(triangles.size());
  if (scene.setting.cull == CullMode::none || model.also_culls == 0) return result;
  for (std::size_t first = 0, count = 0; first < triangles.size(); first += count) {
    count = std::min(model.also_culls, triangles.size() - first);
    const auto together = std::span(triangles).subspan(first, count);
    if (std::ranges::none_of(together,
                             [&](const ClipTriangle& triangle) { return leaves_view_volume(model, triangle); })) {
      continue;
    }
    std::fill_n(result.begin() + static_cast<std::ptrdiff_t>(first), count, true);
  }
  return result;
}

// What has no area before the snap is taken to face back.
bool culled_before_snap(const Setting& setting, Turn turn) {
  return turn == Turn::none ? setting.cull == CullMode::back : culled(setting, turn);
}

// One word of a mask: the samples that the parts of triangle `i` add more often than they take them away.
std::uint64_t outlined(const WindowScene& window, std::size_t i, const MaskBatch& parts, std::size_t from,
                       std::size_t word) {
  std::uint64_t result = 0;
  for (int bit = 0; bit < 64; ++bit) {
    int times = 0;
    for (std::size_t part = 0; part < window.parts_of(i); ++part) {
      const int inside = static_cast<int>(parts[from + part][word] >> bit & 1);
      times += window.takes_away[window.first[i] + part] ? -inside : inside;
    }
    if (times > 0) result |= std::uint64_t{1} << bit;
  }
  return result;
}

}  // namespace

WindowScene window_scene(const TransformModel& model, const Scene& scene) {
  const Viewport* viewport = scene.clip ? &scene.clip->viewport : nullptr;
  const Setting& setting = scene.setting;
  WindowScene result{.scene = {setting, {model.rules.subpixel_bits, SnapRounding::nearest_even}, {}, {}},
                     .unpredicted = {},
                     .takes_away = {},
                     .region = DrawnRegion(model, setting, viewport)};
  result.scene.setting.cull = CullMode::none;
  const ScissorReach& reach = result.region.reach();
  if (setting.scissor || reach.all() != Rect{0, 0, setting.target.width, setting.target.height}) {
    result.scene.setting.scissor = reach.all();
  }
  std::vector<Triangle>& out = result.scene.triangles;
  std::vector<WindowTriangle> parts;
  const std::vector<bool> twice = scene.clip ? culled_twice(model, scene) : std::vector<bool>();
  const std::size_t count = scene.clip ? scene.clip->triangles.size() : scene.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    parts.clear();
    const std::optional<Turn> turn =
        viewport != nullptr ? append_window_triangles(model, setting, *viewport, scene.clip->triangles[i], parts)
                            : append_snapped(model, setting, scene.triangles[i], parts);
    if (!turn) result.unpredicted.push_back(i);
    for (const auto& [part, turn_before_snap] : parts) {
      const bool as_whole = viewport != nullptr && model.winding == Winding::binary32_before_clipping;
      if (!reach.meets(part) || culled(setting, as_whole ? *turn : turn_of(part))) continue;
      if (viewport != nullptr && twice[i] && culled_before_snap(setting, turn_before_snap)) continue;
      out.push_back(part);
      const Turn adds = *turn == Turn::none ? Turn::clockwise : *turn;
      result.takes_away.push_back(as_whole && model.fill == Fill::outline && turn_of(part) != adds);
    }
    result.first.push_back(out.size());
  }
  return result;
}

ClippedView clipped_view(const WindowScene& window, std::size_t first, std::size_t count) {
  ClippedView result{Scene{window.scene.setting, window.scene.rules, {}, {}}, first, {}};
  std::vector<Triangle>& triangles = result.scene.triangles;
  for (std::size_t i = first; i < first + count; ++i) {
    result.bearers.push_back(triangles.size());
    triangles.insert(triangles.end(), window.scene.triangles.begin() + static_cast<std::ptrdiff_t>(window.first[i]),
                     window.scene.triangles.begin() + static_cast<std::ptrdiff_t>(window.first[i + 1]));
    if (triangles.size() == result.bearers.back()) triangles.push_back({});
  }
  return result;
}

void unite(const WindowScene& window, const MaskBatch& parts, MaskBatch& whole) {
  whole.reset(MaskLayout(window.scene.setting), window.size());
  for (std::size_t i = 0; i < window.size(); ++i) unite_parts(window, i, parts, window.first[i], whole[i]);
}

void unite_parts(const WindowScene& window, std::size_t i, const MaskBatch& parts, std::size_t from,
                 MutableMaskView whole) {
  std::ranges::fill(whole, 0);
  bool some_take_away = false;
  for (std::size_t part = 0; part < window.parts_of(i); ++part) {
    std::ranges::transform(whole, parts[from + part], whole.begin(), std::bit_or<>());
    some_take_away = some_take_away || window.takes_away[window.first[i] + part];
  }
  for (std::size_t word = 0; some_take_away && word < whole.size(); ++word) {
    if (whole[word] != 0) whole[word] = outlined(window, i, parts, from, word);
  }
  window.region.filter(whole);
}

}  // namespace edgecase::conformance
