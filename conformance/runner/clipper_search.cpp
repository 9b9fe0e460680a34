#include "conformance/runner/clipper_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "conformance/runner/clipper_probe.h"
#include "conformance/runner/prediction.h"

namespace edgecase::conformance {
namespace {

using enum ClipPlane;

constexpr std::array kPlanes{left, right, bottom, top, near, far};

// Of each arrangement, whatever the models say of them.
constexpr std::size_t kPlain = 100;
// Of those that tell two models apart.
constexpr std::size_t kTelling = 3;
constexpr std::size_t kTries = 1500;
// A model that is right predicts all but a few: vertices so close to w = 0 that no grid point stands for them.
constexpr std::size_t kOneUnpredictedIn = 50;

TransformModel with_clipper(const TransformModel& transform, const TransformModel& clipper) {
  TransformModel model = clipper;
  model.name = "found by drawing";
  model.rules = transform.rules;
  model.multiply_add = transform.multiply_add;
  model.shift = transform.shift;
  model.multisample_shift = transform.multisample_shift;
  return model;
}

// The known ones, and then everything but the order of the planes that a clipper may differ in.
std::vector<TransformModel> clippers(const TransformModel& transform) {
  std::vector<TransformModel> all;
  for (const TransformModel* known :
       {&lavapipe_model(), &osmesa_llvmpipe_model(), &lavapipe_bgra8_model(), &swiftshader_model()}) {
    all.push_back(with_clipper(transform, *known));
  }
  for (unsigned bits = 0; bits < 512; ++bits) {
    const auto bit = [&](unsigned i) { return (bits >> i & 1U) != 0; };
    TransformModel model = with_clipper(transform, lavapipe_model());
    model.depth = bit(0) ? DepthRange::minus_w_to_w : DepthRange::zero_to_w;
    model.interpolation = bit(1) ? Interpolation::crosswise : Interpolation::from_nearer_end;
    model.shrink = bit(2) ? 0.5F : 1;
    model.multisample_shrink = bit(3) ? 0.5F : 1;
    model.viewport_scissor = bit(4);
    model.loose_multisample_scissor = bit(5);
    model.winding = bit(6) ? Winding::binary32_before_clipping : Winding::exact;
    model.fill = bit(7) ? Fill::outline : Fill::each;
    model.also_culls = bit(8) ? kWholeDraw : 0;
    // Triangles that are wound exactly never take samples away.
    if (model.winding == Winding::exact && model.fill == Fill::outline) continue;
    // Two ways of being wound before the snap are one too many.
    if (model.winding != Winding::exact && model.also_culls != 0) continue;
    all.push_back(model);
  }
  return all;
}

class ClipperSearch {
 public:
  ClipperSearch(Subject& subject, const TransformModel& transform)
      : subject_(subject), arrangements_(clip_arrangements(transform.rules)), candidates_(clippers(transform)) {
    std::erase_if(arrangements_, [&](const Scene& scene) { return subject_.refusal(scene).has_value(); });
  }

  tl::expected<TransformModel, std::string> find() {
    if (arrangements_.empty()) return tl::unexpected(std::string("it draws none of the probes of its clipper"));
    const auto one_plane = [](Random& random) {
      return across({kPlanes[static_cast<std::size_t>(random.between(0, kPlanes.size() - 1))]}, random);
    };
    filter(plain(one_plane));
    while (!failure_ && candidates_.size() > 1) {
      const ClipScenes telling = tell_apart(candidates_[0], candidates_[1], arrangements_, one_plane, kTelling, kTries);
      if (telling.empty()) {
        candidates_.erase(candidates_.begin() + 1);
      } else {
        filter(telling);
      }
    }
    if (!failure_ && candidates_.size() == 1) find_order();
    if (!failure_ && candidates_.size() == 1) find_culled_together();
    if (!failure_ && candidates_.size() == 1) filter(plain(across_any));
    if (failure_) return tl::unexpected(*failure_);
    if (candidates_.empty()) {
      return tl::unexpected(fmt::format(
          "no known clipper explains it: the best explains {} triangles of the probe, and not the {} after them", best_,
          last_));
    }
    return candidates_.front();
  }

 private:
  ClipScenes plain(const std::function<ClipTriangle(Random&)>& make) const {
    ClipScenes scenes = arrangements_;
    Random random = Random::stream(1, "clipper", 0);
    for (Scene& scene : scenes) {
      for (std::size_t i = 0; i < kPlain; ++i) scene.clip->triangles.push_back(make(random));
    }
    return scenes;
  }

  // Leaves the candidates that explain what the subject draws of each scene.
  void filter(const ClipScenes& scenes) {
    for (const Scene& scene : scenes) {
      if (!draw(scene)) return;
      const std::size_t triangles = triangle_count(scene);
      std::erase_if(candidates_, [&](const TransformModel& model) { return !explains(model, scene); });
      last_ = triangles;
      if (candidates_.empty()) return;
      best_ += triangles;
    }
  }

  bool draw(const Scene& scene) {
    const auto drawn = subject_.draw(scene, observed_);
    if (!drawn) failure_ = drawn.error().message;
    return drawn.has_value();
  }

  bool explains(const TransformModel& model, const Scene& scene) const {
    const Agreement agreement = compare_with_prediction(model, scene, observed_);
    return agreement.wrong == 0 && agreement.unpredicted * kOneUnpredictedIn <= triangle_count(scene);
  }

  // Two planes at a time, because only those that a triangle crosses take part. Of the orders that have every two as
  // the subject has them, the known one if it is among them.
  void find_order() {
    const TransformModel model = candidates_.front();
    std::vector<TransformModel> orders{model};
    for (const TransformModel* known : {&lavapipe_model(), &swiftshader_model()}) {
      orders.push_back(model);
      orders.back().planes = known->planes;
    }
    std::array<ClipPlane, 6> order = kPlanes;
    do {
      orders.push_back(model);
      orders.back().planes = order;
    } while (std::ranges::next_permutation(order).found);
    for (std::size_t i = 0; i < kPlanes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto first = find_first(model, kPlanes[i], kPlanes[j]);
        if (failure_) return;
        if (!first) continue;
        const ClipPlane other = *first == kPlanes[i] ? kPlanes[j] : kPlanes[i];
        std::erase_if(orders, [&](const TransformModel& m) {
          return std::ranges::find(m.planes, *first) > std::ranges::find(m.planes, other);
        });
      }
    }
    // None: then the order is no order, as a different one for each octant would be none.
    candidates_.assign(orders.begin(), orders.begin() + (orders.empty() ? 0 : 1));
  }

  // Which of the two planes cuts first; nothing if that makes no difference, or neither explains what is drawn, which
  // the triangles across any planes will show.
  std::optional<ClipPlane> find_first(const TransformModel& model, ClipPlane a, ClipPlane b) {
    const auto with_first = [&](ClipPlane first, ClipPlane second) {
      TransformModel result = model;
      auto next = result.planes.begin();
      *next++ = first;
      *next++ = second;
      std::ranges::copy_if(kPlanes, next, [&](ClipPlane plane) { return plane != first && plane != second; });
      return result;
    };
    const TransformModel ab = with_first(a, b);
    const TransformModel ba = with_first(b, a);
    const auto both = [&](Random& random) { return across({a, b}, random); };
    bool ab_fits = true;
    bool ba_fits = true;
    const ClipScenes telling = tell_apart(ab, ba, arrangements_, both, kTelling, kTries);
    for (const Scene& scene : telling) {
      if (!draw(scene)) return std::nullopt;
      ab_fits = ab_fits && explains(ab, scene);
      ba_fits = ba_fits && explains(ba, scene);
    }
    if (ab_fits == ba_fits) return std::nullopt;
    return ab_fits ? a : b;
  }

  // Whether, and how many of a draw together, it culls a second time; SwiftShader's winding leaves no room for that.
  void find_culled_together() {
    const TransformModel model = candidates_.front();
    if (model.winding != Winding::exact) return;
    candidates_.clear();
    for (const std::size_t together : {lavapipe_model().also_culls, std::size_t{0}, std::size_t{1}, kWholeDraw}) {
      for (const bool other_order : {false, true}) {
        candidates_.push_back(model);
        candidates_.back().also_culls = together;
        candidates_.back().fan_ends_with_first = model.fan_ends_with_first != other_order;
      }
    }
    ClipScenes scenes = culled_slivers(arrangements_.front().rules, 3 * lavapipe_model().also_culls);
    std::erase_if(scenes, [&](const Scene& scene) { return subject_.refusal(scene).has_value(); });
    filter(scenes);
    if (!candidates_.empty()) candidates_.resize(1);
  }

  Subject& subject_;
  ClipScenes arrangements_;
  std::vector<TransformModel> candidates_;
  MaskBatch observed_;
  std::optional<std::string> failure_;
  std::size_t best_ = 0;  ///< triangles that some candidate has explained
  std::size_t last_ = 0;  ///< of the last scene
};

}  // namespace

tl::expected<TransformModel, std::string> find_clipper(Subject& subject, const TransformModel& transform) {
  return ClipperSearch(subject, transform).find();
}

}  // namespace edgecase::conformance
