#include "conformance/runner/metamorphic_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <span>
#include <vector>

namespace edgecase::conformance {
namespace {

constexpr std::size_t kExperimentTriangles = 1024;

std::uint64_t bits_of(std::span<const std::uint64_t> words) {
  std::uint64_t count = 0;
  for (const std::uint64_t word : words) count += static_cast<std::uint64_t>(std::popcount(word));
  return count;
}

class Experimenter {
 public:
  Experimenter(Subject& subject, const KnownDeviation* deviation, Trial& trial)
      : subject_(subject), deviation_(deviation), trial_(trial) {}

  /// False if the trial ends here: it is refused, or has failed.
  bool draw(const Experiment& experiment) {
    variants_.resize(experiment.variants.size());
    if (!draw_scene(experiment.base, base_)) return false;
    for (std::size_t i = 0; i < experiment.variants.size(); ++i) {
      if (!draw_scene(experiment.variants[i], variants_[i])) return false;
    }
    for (auto piece = experiment.pieces.begin(); piece != experiment.pieces.end();) {
      const auto end =
          std::find_if(piece, experiment.pieces.end(), [&](const Piece& p) { return p.base != piece->base; });
      compare(experiment, {piece, end});
      piece = end;
    }
    return true;
  }

 private:
  bool draw_scene(const Scene& scene, MaskBatch& masks) {
    trial_.skipped = subject_.refusal(scene);
    if (trial_.skipped) return false;
    if (auto drawn = subject_.draw(scene, masks); !drawn) trial_.failure = drawn.error();
    return !trial_.failure;
  }

  void compare(const Experiment& experiment, std::span<const Piece> pieces) {
    compose(experiment, pieces, variants_, composition_);
    const std::size_t base = pieces.front().base;
    const MaskLayout layout(experiment.base.setting);
    Outcome& outcome = trial_.outcome;
    Comparison comparison;
    compare_masks(layout, visible(base_[base]), composition_.hidden, composition_.covered, outcome.triangles.triangles,
                  comparison);
    const std::uint64_t doubled = bits_of(composition_.doubled);
    outcome.triangles.add(comparison);
    outcome.meshes.doubled += doubled;
    if (comparison.all_right() && doubled == 0) return;
    if (doubled != 0 && comparison.all_right()) ++outcome.triangles.wrong_triangles;
    if (as_predicted(experiment, pieces)) {
      ++outcome.known_triangles;
      return;
    }
    ++outcome.unexplained;
    if (!trial_.changed) trial_.changed = first_change(experiment, base, comparison);
  }

  // What the base triangle covers of what the pieces show.
  std::span<const std::uint64_t> visible(MaskView base) {
    visible_.assign(base.begin(), base.end());
    for (std::size_t i = 0; i < visible_.size(); ++i) visible_[i] &= ~composition_.hidden[i];
    return visible_;
  }

  std::string first_change(const Experiment& experiment, std::size_t base, const Comparison& comparison) const {
    const Triangle& t = experiment.base.triangles[base];
    std::string what = "a sample covered twice";
    if (comparison.first) {
      what = fmt::format(
          "pixel ({}, {}) covered {}", comparison.first->x, comparison.first->y,
          comparison.first->kind == WrongSample::Kind::missing ? "before and not after" : "after and not before");
    }
    return fmt::format("({}, {}) ({}, {}) ({}, {}): {}", t[0].x, t[0].y, t[1].x, t[1].y, t[2].x, t[2].y, what);
  }

  bool as_predicted(const Experiment& experiment, std::span<const Piece> pieces) {
    if (deviation_ == nullptr) return false;
    const auto follows = [&](const Scene& scene, const MaskBatch& masks, std::size_t i) {
      predicted_.resize(masks[i].size());
      deviation_->predict(scene.setting, scene.triangles[i], predicted_);
      return std::ranges::equal(predicted_, masks[i]);
    };
    return follows(experiment.base, base_, pieces.front().base) && std::ranges::all_of(pieces, [&](const Piece& p) {
             return follows(experiment.variants[p.variant], variants_[p.variant], p.triangle);
           });
  }

  Subject& subject_;
  const KnownDeviation* deviation_;
  Trial& trial_;
  MaskBatch base_;
  std::vector<MaskBatch> variants_;
  Composition composition_;
  std::vector<std::uint64_t> visible_;
  std::vector<std::uint64_t> predicted_;
};

}  // namespace

std::uint64_t metamorphic_count(std::uint64_t count) { return std::max<std::uint64_t>(1, count / 4); }

Trial try_metamorphosis(const Metamorphosis& metamorphosis, Subject& subject, const Rules& rules,
                        const KnownDeviation* deviation, const TrialOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const double subject_seconds = subject.driver_seconds();
  Trial trial;
  Experimenter experimenter(subject, deviation, trial);
  const std::uint64_t count = metamorphic_count(options.count);
  for (std::uint64_t index = 0, done = 0; done < count; ++index) {
    const std::size_t triangles = std::min<std::uint64_t>(kExperimentTriangles, count - done);
    const Experiment experiment = make_experiment(metamorphosis, rules, options.seed, index, triangles);
    if (!experimenter.draw(experiment)) break;
    done += experiment.base.triangles.size();
    options.on_progress(experiment.base.triangles.size());
  }
  trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  trial.subject_seconds = subject.driver_seconds() - subject_seconds;
  return trial;
}

}  // namespace edgecase::conformance
