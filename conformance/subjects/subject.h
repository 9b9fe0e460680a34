// Subject: a rasterizer under test.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/drawn_masks.h"
#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// What a subject says of itself; drivers are asked, not assumed.
struct SubjectInfo {
  /// The name on the command line: `lavapipe`, `edgecase:scalar`, `fault:truncate`.
  std::string name;
  /// The device and version as the subject itself reports them; empty for ours.
  std::string device;
  /// The snap that this subject declares; expectations are computed with it.
  Rules rules;
  /// Whether it draws under the rules that each scene asks for, rather than always under `rules`.
  bool follows_scene_rules = false;
  std::vector<int> sample_counts{1};
  int max_target = kMaxTargetExtent;
  /// Whether a scissor rectangle can be set.
  bool scissor = false;
  /// Whether triangles can be culled by the way they face.
  bool cull = false;
  /// Whether it draws an Assembly as such, and numbers the triangles as the scene does.
  bool assembly = false;
  /// Whether it draws ClipGeometry: clips, divides by w and transforms to any viewport itself.
  bool clip = false;
  /// Whether a viewport's height may be negative.
  bool flipped_viewport = false;
  /// The largest width and height of a viewport, and how far its edges may lie from the window's origin, in pixels.
  float max_viewport = 0;
  float viewport_bound = 0;
  /// Window coordinates from -max_coordinate to +max_coordinate reach the rasterizer exactly.
  double max_coordinate = 0;
};

class Subject {
 public:
  virtual ~Subject() = default;

  virtual const SubjectInfo& info() const = 0;

  /// Why this scene lies outside what the subject can do, in one phrase; nothing if it can be drawn. The default judges
  /// by info(): the target's size, the sample count, what else the setting asks for, the kind of geometry, its
  /// viewport, and every coordinate against max_coordinate. Positions off the subpixel grid are fine.
  virtual std::optional<std::string> refusal(const Scene& scene) const;

  /// The same for all but the coordinates.
  std::optional<std::string> refusal_of_setting(const Scene& scene) const;

  /// Draws every triangle of `scene` on its own into `masks`, which it resizes: mask i holds exactly the samples that
  /// triangle i covered. Called only for scenes that are not refused.
  virtual tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) = 0;

  /// The same for who only looks at the masks: they lie where the subject has them, or in `scratch`, and stay there
  /// until it draws again.
  virtual tl::expected<DrawnMasks, Error> draw_in_place(const Scene& scene, MaskBatch& scratch) {
    if (auto drawn = draw(scene, scratch); !drawn) return tl::unexpected(drawn.error());
    return DrawnMasks(scratch);
  }

  /// Whether draw() would give just the masks `observed`, padding included; nothing if the subject cannot tell without
  /// drawing them. May be asked of any scene, and answers for any way of snapping.
  virtual std::optional<bool> draws(const Scene&, const DrawnMasks& /*observed*/) { return std::nullopt; }

  /// Seconds that all draws so far took inside the driver itself, from submission to the last finished sample: what
  /// would be spent without this suite around it. 0 for a subject that does not measure it.
  virtual double driver_seconds() const { return 0; }
};

/// The subject of that name, ready to draw, or why there is none (ErrorKind::absent for a driver that is not installed,
/// ErrorKind::bad_input for a name that no subject has; the message then proposes the nearest).
tl::expected<std::unique_ptr<Subject>, Error> make_subject(const std::string& name);

}  // namespace edgecase::conformance
