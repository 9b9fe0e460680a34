#include "conformance/subjects/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conformance/scene/coordinates.h"

namespace edgecase::conformance {
namespace {

std::optional<std::string> refused_viewport(const SubjectInfo& self, const Viewport& viewport) {
  if (viewport.height < 0 && !self.flipped_viewport) return "a viewport of negative height";
  const float extent = std::max(viewport.width, std::abs(viewport.height));
  if (!(extent <= self.max_viewport)) {
    return fmt::format("a viewport of {}x{} exceeds {} pixels a side", viewport.width, viewport.height,
                       self.max_viewport);
  }
  for (const float end : {viewport.x, viewport.x + viewport.width, viewport.y, viewport.y + viewport.height}) {
    if (!(std::abs(end) <= self.viewport_bound)) {
      return fmt::format("a viewport that reaches {} lies beyond {} px", end, self.viewport_bound);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> Subject::refusal_of_setting(const Scene& scene) const {
  const SubjectInfo& self = info();
  const Extent target = scene.setting.target;
  if (std::max(target.width, target.height) > self.max_target) {
    return fmt::format("target {}x{} exceeds {} pixels a side", target.width, target.height, self.max_target);
  }
  const int samples = scene.setting.samples();
  if (std::find(self.sample_counts.begin(), self.sample_counts.end(), samples) == self.sample_counts.end()) {
    return fmt::format("{} samples a pixel", samples);
  }
  if (scene.setting.scissor && !self.scissor) return "a scissor rectangle";
  if (scene.setting.cull != CullMode::none && !self.cull) return "culling";
  if (scene.assembly && !self.assembly) return "strips, fans and indices";
  if (scene.clip) {
    if (!self.clip) return "clip space";
    if (auto reason = refused_viewport(self, scene.clip->viewport)) return reason;
  }
  return std::nullopt;
}

std::optional<std::string> Subject::refusal(const Scene& scene) const {
  if (auto reason = refusal_of_setting(scene)) return reason;
  const SubjectInfo& self = info();
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    for (std::size_t v = 0; v < 3; ++v) {
      const Position& position = scene.triangles[i][v];
      for (const auto& [axis, value] : {std::pair{'x', position.x}, std::pair{'y', position.y}}) {
        if (!(std::abs(value) <= self.max_coordinate)) {
          return fmt::format("triangle {}, vertex {}: {} = {} lies beyond {} px", i, v, axis, value,
                             self.max_coordinate);
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace edgecase::conformance
