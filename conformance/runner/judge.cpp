#include "conformance/runner/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <span>

#include "conformance/runner/triangle_choices.h"
#include "conformance/scene/window_position.h"

namespace edgecase::conformance {
namespace {

// The first sample in which that triangle's mask is not what is predicted, but for those left open.
std::optional<WrongSample> first_wrong(const Batch& batch, MaskView predicted, MaskView observed,
                                       std::size_t triangle) {
  const MaskView may =
      batch.may.empty() ? MaskView{} : MaskView(batch.may).subspan(triangle * predicted.size(), predicted.size());
  Comparison comparison;
  compare_masks(MaskLayout(batch.scene.setting), predicted, may, observed, triangle, comparison);
  return comparison.first;
}

}  // namespace

std::optional<std::string> Judge::refusal(const Scene& scene, const RuleSet& rule_set) const {
  if (auto refused = subject_.refusal(scene)) return refused;
  if (!rule_set.exact()) {
    if (exact_window_triangles(scene)) return std::nullopt;
    return fmt::format("{} does not say how clipping and the viewport transform are rounded", rule_set.name);
  }
  if (!reference_.judges(scene)) return reference_.unjudged();
  return std::nullopt;
}

tl::expected<void, Error> Judge::judge(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  const auto drawn = subject_.draw_in_place(batch.scene, scratch_);
  if (!drawn) return tl::unexpected(drawn.error());
  drawn_ = *drawn;
  observed_ = {};
  wrong_.clear();
  window_.reset();
  if (batch.scene.clip && !batch.rule_set->exact()) {
    window_ =
        Scene{batch.scene.setting, batch.scene.rules, exact_window_triangles(batch.scene).value(), batch.scene.meshes};
  }
  reference_.take_up(judged_scene(batch));
  agreed_ = false;
  if (is_plain(batch)) {
    auto agreed = reference_.expects(first_triangle, drawn_);
    if (!agreed) return tl::unexpected(agreed.error());
    agreed_ = *agreed;
  }
  if (agreed_) {
    outcome.triangles.triangles += triangle_count(batch.scene);
    outcome.triangles.samples_compared += triangle_count(batch.scene) * MaskLayout(batch.scene.setting).sample_count();
    if (!batch.scene.clip && may_deviate(batch)) {
      observe();
      if (auto judged = judge_triangles(batch, outcome); !judged) return judged;
    }
  } else {
    observe();
    if (auto compared = compare(batch, first_triangle, outcome); !compared) return compared;
  }
  judge_meshes(batch, first_triangle, outcome);
  return {};
}

// Nearly all batches, and nearly all of these are right: what is expected need not be kept then. In clip space it has
// to be where the parts of a triangle may deviate, of which only the whole is observed.
bool Judge::is_plain(const Batch& batch) const {
  if (!batch.may.empty() || !batch.rule_set->exact()) return false;
  if (deviation_ == nullptr) return true;
  return batch.scene.clip ? !may_deviate(batch) : !deviation_->concerns_most(batch.scene.setting);
}

bool Judge::may_deviate(const Batch& batch) const {
  if (deviation_ == nullptr) return false;
  const Scene& scene = judged_scene(batch);
  if (!scene.clip) return deviation_->in_window.may_concern_any(scene.setting, scene.triangles);
  const Scene& parts = reference_.window().scene;
  return deviation_->of_part.may_concern_any(parts.setting, parts.triangles);
}

tl::expected<void, Error> Judge::compare(const Batch& batch, std::size_t first_triangle, Outcome& outcome) {
  if (auto known = reference_.expect(first_triangle, expected_); !known) return known;
  if (!batch.rule_set->exact()) {
    const auto granted =
        grant_choices(judged_scene(batch), *batch.rule_set, first_triangle, observed_, reference_, expected_);
    if (!granted) return tl::unexpected(granted.error());
    outcome.may += *granted;
  }

  // What nobody predicts is not compared, and not counted as compared.
  const MaskLayout layout(batch.scene.setting);
  const std::size_t unpredicted = reference_.unpredicted().size();
  for (const std::size_t i : reference_.unpredicted()) std::ranges::copy(observed_[i], expected_[i].begin());
  outcome.unpredicted += unpredicted;

  Comparison comparison;
  compare_masks(layout, expected_.data(), batch.may, observed_.data(), first_triangle, comparison, &wrong_);
  for (WrongSample& wrong : wrong_) wrong.triangle -= first_triangle;
  comparison.triangles -= unpredicted;
  comparison.samples_compared -= unpredicted * layout.sample_count();
  outcome.triangles.add(comparison);
  if (wrong_.empty() && !may_deviate(batch)) return {};
  return judge_triangles(batch, outcome);
}

// Reached only where something is wrong or predicted to be: here every triangle is looked at on its own, and one that
// is wrong otherwise than predicted goes to both oracles before anybody is blamed.
tl::expected<void, Error> Judge::judge_triangles(const Batch& batch, Outcome& outcome) {
  auto next_wrong = wrong_.begin();
  for (std::size_t i = 0; i < triangle_count(batch.scene); ++i) {
    const bool wrong = next_wrong != wrong_.end() && next_wrong->triangle == i;
    const bool concerned = may_deviate(judged_scene(batch), i);
    if (!wrong && !concerned) continue;
    const bool known = concerned && as_predicted(batch, i);
    if (wrong) {
      const bool confirms = !known || outcome.known_triangles % kKnownShare == 0;
      if (confirms && batch.rule_set->exact()) {  // else grant_choices has seen to it
        if (auto confirmed = reference_.confirm(batch.scene, i, expected_[i]); !confirmed) return confirmed;
      }
      ++(known ? outcome.known_triangles : outcome.unexplained);
      add_finding(batch, i, 1, *next_wrong++, known, outcome);
    } else if (!known) {
      // Right where it is predicted to be wrong: the prediction, or the subject, is no longer what it was.
      const auto obsolete = first_wrong(batch, predicted_, observed_[i], i);
      if (!obsolete) continue;
      ++outcome.unexplained;
      ++outcome.obsolete;
      add_finding(batch, i, 1, *obsolete, false, outcome);
    }
  }
  return {};
}

bool Judge::may_deviate(const Scene& scene, std::size_t triangle) const {
  if (deviation_ == nullptr) return false;
  if (!scene.clip) return deviation_->in_window.may_concern(scene.setting, scene.triangles[triangle]);
  const WindowScene& window = reference_.window();
  const auto parts = std::span(window.scene.triangles).subspan(window.first[triangle], window.parts_of(triangle));
  return std::ranges::any_of(
      parts, [&](const Triangle& part) { return deviation_->of_part.may_concern(window.scene.setting, part); });
}

bool Judge::as_predicted(const Batch& batch, std::size_t triangle) {
  const Scene& scene = judged_scene(batch);
  if (scene.clip) {
    predict_clipped(triangle);
  } else {
    predicted_.assign(expected()[triangle].begin(), expected()[triangle].end());
    deviation_->in_window.predict(scene.setting, scene.triangles[triangle], predicted_);
  }
  return std::ranges::equal(predicted_, observed_[triangle]);
}

// Each of the triangles that clipping left as the rules and the scissor that the driver itself is given have it, or as
// the deviation does: what a triangle gains by that may lie beyond the scissor. Of drivers that deviate so, none fills
// the outline as a whole.
void Judge::predict_clipped(std::size_t triangle) {
  const WindowScene& window = reference_.window();
  Setting setting = window.scene.setting;
  setting.scissor = window.region.reach().told();
  predicted_.assign(observed_[triangle].size(), 0);
  for (std::size_t i = window.first[triangle]; i < window.first[triangle + 1]; ++i) {
    part_.assign(reference_.part(i).begin(), reference_.part(i).end());
    window.region.filter(part_);
    if (deviation_->of_part.may_concern(setting, window.scene.triangles[i])) {
      deviation_->of_part.predict(setting, window.scene.triangles[i], part_);
    }
    std::ranges::transform(predicted_, part_, predicted_.begin(), std::bit_or<>());
  }
}

}  // namespace edgecase::conformance
