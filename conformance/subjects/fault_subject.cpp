#include "conformance/subjects/fault_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "conformance/scene/assemble.h"
#include "conformance/scene/window_position.h"
#include "conformance/subjects/fault_raster.h"

namespace edgecase::conformance {
namespace {

Triangle projected(const Viewport& viewport, const ClipTriangle& clip) {
  const auto window = [](float position, float w, float start, float size) {
    return start + (position / w + 1) * (size / 2);
  };
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    triangle[i] = {window(clip[i].x, clip[i].w, viewport.x, viewport.width),
                   window(clip[i].y, clip[i].w, viewport.y, viewport.height)};
  }
  return triangle;
}

/// Every other triangle of a strip as its vertices come, not turned.
void unturn(const Assembly& strip, std::vector<Triangle>& triangles) {
  std::size_t triangle = 0;
  std::size_t since_restart = 0;
  const std::size_t count = strip.indices.empty() ? strip.vertices.size() : strip.indices.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool restart = !strip.indices.empty() && strip.indices[i] == kRestartIndex;
    since_restart = restart ? 0 : since_restart + 1;
    if (since_restart < 3) continue;
    if (since_restart % 2 == 0) std::swap(triangles[triangle][0], triangles[triangle][1]);
    ++triangle;
  }
}

/// As many triangles as the scene has, in the window. Of clip space only that is drawn which no clipper has to cut and
/// no transform has to round.
std::vector<Triangle> window_triangles(const Scene& scene, Fault fault) {
  std::vector<Triangle> triangles = scene.clip ? *exact_window_triangles(scene) : scene.triangles;
  if (scene.clip && fault == Fault::behind_drawn) {
    for (std::size_t i = 0; i < triangles.size(); ++i)
      triangles[i] = projected(scene.clip->viewport, scene.clip->triangles[i]);
  }
  if (scene.assembly && scene.assembly->topology == Topology::strip && fault == Fault::strip_unturned) {
    unturn(*scene.assembly, triangles);
  }
  if (scene.assembly && fault == Fault::restart_ignored) {
    Assembly endless = *scene.assembly;
    std::erase(endless.indices, kRestartIndex);
    triangles = assemble(endless);
    triangles.resize(scene.triangles.size());
  }
  return triangles;
}

class FaultSubject : public Subject {
 public:
  FaultSubject(Fault fault, std::string_view name) : fault_(fault) {
    info_.name = fmt::format("fault:{}", name);
    info_.follows_scene_rules = true;
    info_.sample_counts.resize(16);
    std::iota(info_.sample_counts.begin(), info_.sample_counts.end(), 1);
    info_.max_coordinate = 32768.0 - 1.0 / 256;
    info_.scissor = true;
    info_.cull = true;
    info_.assembly = true;
    info_.clip = true;
    info_.flipped_viewport = true;
    info_.max_viewport = kMaxTargetExtent;
    info_.viewport_bound = 32768;
  }

  const SubjectInfo& info() const override { return info_; }

  std::optional<std::string> refusal(const Scene& scene) const override {
    if (scene.rules.rounding != SnapRounding::nearest_even || scene.rules.half_pixel_first) {
      return "snaps to nearest even only";
    }
    if (scene.clip && !exact_window_triangles(scene)) return "clip space that has to be cut or rounded";
    return Subject::refusal(scene);
  }

  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    const std::vector<Triangle> triangles = window_triangles(scene, fault_);
    const bool flipped = scene.clip && scene.clip->viewport.height < 0;
    const Fault fault = fault_ == Fault::flip_turns_rule && !flipped ? Fault::none : fault_;
    masks.reset(MaskLayout(scene.setting), triangles.size());
    std::fill(masks.data().begin(), masks.data().end(), std::uint64_t{0});
    for (std::size_t i = 0; i < triangles.size(); ++i) draw_with_fault(scene, triangles[i], fault, masks[i]);
    return {};
  }

 private:
  Fault fault_;
  SubjectInfo info_;
};

constexpr auto kInfos = [] {
  std::array<FaultInfo, std::size(kPlanted)> infos;
  std::transform(std::begin(kPlanted), std::end(kPlanted), infos.begin(),
                 [](const auto& planted) { return planted.info; });
  return infos;
}();

}  // namespace

std::span<const FaultInfo> faults() { return kInfos; }

std::unique_ptr<Subject> make_fault_subject(std::string_view name) {
  const auto planted = std::find_if(std::begin(kPlanted), std::end(kPlanted),
                                    [&](const PlantedFault& candidate) { return candidate.info.name == name; });
  if (planted == std::end(kPlanted)) return nullptr;
  return std::make_unique<FaultSubject>(planted->fault, name);
}

std::unique_ptr<Subject> make_faultless_subject() { return std::make_unique<FaultSubject>(Fault::none, "none"); }

}  // namespace edgecase::conformance
