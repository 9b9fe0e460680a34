// What the rules demand of a batch of triangles: a fast answer, and the oracles to judge it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/compare/clip_mesh.h"
#include "conformance/models/window_scene.h"
#include "conformance/scene/drawn_masks.h"
#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"
#include "conformance/scene/window_position.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// One in this many triangles that our fast rasterizer answers for is given to both oracles as well.
inline constexpr std::uint64_t kOracleShare = 256;

/// The vertices as hexadecimal floats.
std::string coordinates(const Triangle& triangle);

class Reference {
 public:
  /// `fast` answers in bulk, and the oracles judge it; without it the oracle by definition answers for every triangle.
  /// `model` says what the subject's clipper and transform do; without it clip space is judged only where it has
  /// exact_window_triangles, and `unjudged` says why.
  explicit Reference(std::unique_ptr<Subject> fast, std::optional<TransformModel> model = {}, std::string unjudged = {})
      : fast_(std::move(fast)), model_(std::move(model)), unjudged_(std::move(unjudged)) {}

  /// Whether expect() can say something about `scene`.
  bool judges(const Scene& scene) const { return !scene.clip || model_ || exact_window_triangles(scene); }
  const std::string& unjudged() const { return unjudged_; }

  /// Takes up `scene` for the questions that follow, until when it has to stay: one in clip space, as the model has it
  /// in the window.
  void take_up(const Scene& scene);

  /// Fills `must` with one mask per triangle of the scene. `first_index` counts on through a run and picks the share
  /// that the oracles check. Of triangles in clip space, it is what the model predicts. An error is a fault of ours:
  /// two of the three answers differ.
  tl::expected<void, Error> expect(std::uint64_t first_index, MaskBatch& must);
  tl::expected<void, Error> expect(const Scene& scene, std::uint64_t first_index, MaskBatch& must) {
    take_up(scene);
    return expect(first_index, must);
  }

  /// Whether expect() would give just the masks `observed`, padding included; the oracles have their share of it. Says
  /// no, too, where clipping has made more than one triangle of any, or what is drawn of one has to be filtered. Where
  /// the fast rasterizer cannot tell without masks, they are made and compared part by part, within the processor's
  /// cache, and none is kept.
  tl::expected<bool, Error> expects(std::uint64_t first_index, const DrawnMasks& observed);

  /// Where the subject's near plane lies, as far as that is known.
  NearPlane near_plane() const {
    return model_ && model_->depth == DepthRange::minus_w_to_w ? NearPlane::minus_w : NearPlane::zero;
  }

  /// The triangles of the scene for which the model does not reach far enough; their masks mean nothing.
  std::span<const std::size_t> unpredicted() const {
    return window_ ? std::span<const std::size_t>(window_->unpredicted) : std::span<const std::size_t>();
  }

  /// The scene, which is in clip space, as the model has it in the window: what an exact rasterizer has to cover.
  const WindowScene& window() const { return *window_; }
  /// What the rules cover of triangle `index` of its scene, once expect() has been asked.
  MaskView part(std::size_t index) const { return parts_[index]; }

  /// Gives triangle `index` of `scene`, the one taken up, to both oracles, or in clip space all that the
  /// model makes of it; an error if one of them differs from `must`.
  tl::expected<void, Error> confirm(const Scene& scene, std::size_t index, MaskView must);

  /// Triangles given to both oracles so far.
  std::uint64_t confirmed() const { return confirmed_; }

 private:
  /// The scene in the window, mask by mask; null if there is no such.
  const Scene* one_for_each();
  tl::expected<void, Error> expect_window(const Scene& scene, std::uint64_t first_index, MaskBatch& must);
  tl::expected<void, Error> confirm_window(const Scene& scene, std::size_t index, MaskView must);
  /// Gives the oracles their share of `scene`; `masks` as `must` of expect().
  tl::expected<void, Error> confirm_share(const Scene& scene, std::uint64_t first_index, const DrawnMasks& masks);
  /// Fills snapped_ with the scene's vertices as its rules snap them.
  void snap_all(const Scene& scene);

  std::unique_ptr<Subject> fast_;
  std::optional<TransformModel> model_;
  std::string unjudged_;
  const Scene* scene_ = nullptr;
  std::optional<WindowScene> window_;
  Scene one_for_each_;
  MaskBatch parts_;
  Scene part_;
  Scene snapped_;
  std::vector<std::uint64_t> scratch_;
  MaskBatch whole_;
  std::uint64_t confirmed_ = 0;
};

}  // namespace edgecase::conformance
