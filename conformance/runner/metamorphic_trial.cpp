#include "conformance/runner/metamorphic_trial.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <span>
#include <vector>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

constexpr std::size_t kExperimentTriangles = 1024;

std::uint64_t bits_of(std::span<const std::uint64_t> words) {
  std::uint64_t count = 0;
  for (const std::uint64_t word : words) {
    if (word != 0) count += static_cast<std::uint64_t>(std::popcount(word));
  }
  return count;
}

class Experimenter {
 public:
  Experimenter(const Metamorphosis& metamorphosis, Subject& subject, const KnownDeviation* deviation, Trial& trial)
      : metamorphosis_(metamorphosis), subject_(subject), deviation_(deviation), trial_(trial) {}

  /// False if the trial ends here: it is refused, or has failed.
  bool draw(const Experiment& experiment, std::uint64_t index) {
    index_ = index;
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
    const bool known = as_predicted(experiment, pieces);
    ++(known ? outcome.known_triangles : outcome.unexplained);
    add_finding(experiment, pieces, comparison.first, known);
  }

  // What the base triangle covers of what the pieces show.
  std::span<const std::uint64_t> visible(MaskView base) {
    visible_.assign(base.begin(), base.end());
    for (std::size_t i = 0; i < visible_.size(); ++i) visible_[i] &= ~composition_.hidden[i];
    return visible_;
  }

  void add_finding(const Experiment& experiment, std::span<const Piece> pieces, std::optional<WrongSample> wrong,
                   bool known) {
    if (std::ranges::count(trial_.outcome.findings, known, &Finding::known) >= most_findings(known)) return;
    const std::size_t base = pieces.front().base;
    const Triangle& triangle = experiment.base.triangles[base];
    const MaskLayout layout(experiment.base.setting);
    Finding finding;
    finding.known = known;
    finding.part_index = index_;
    finding.change = Change{std::string(metamorphosis_.about), triangle};
    finding.window.setting = experiment.base.setting;
    finding.window.rules = experiment.base.rules;
    finding.expected.reset(layout, pieces.size());
    finding.observed.reset(layout, pieces.size());
    std::ranges::fill(finding.expected.data(), 0);
    std::ranges::copy(visible(base_[base]), finding.expected[0].begin());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Piece& piece = pieces[i];
      compose(experiment, pieces.subspan(i, 1), variants_, composition_);
      std::ranges::copy(composition_.covered, finding.observed[i].begin());
      Triangle& shown =
          finding.window.triangles.emplace_back(experiment.variants[piece.variant].triangles[piece.triangle]);
      for (Position& p : shown) p = {p.x + static_cast<float>(piece.dx), p.y + static_cast<float>(piece.dy)};
    }
    compose(experiment, pieces, variants_, composition_);
    if (!wrong) wrong = first_doubled(layout);
    finding.wrong = *wrong;
    finding.wrong.triangle = 0;
    const std::size_t bit = layout.bit(wrong->x, wrong->y, wrong->sample);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (covered(finding.observed[i], bit)) finding.wrong.triangle = i;
    }
    finding.scene = scene_to_blame(experiment, pieces);
    trial_.outcome.findings.push_back(std::move(finding));
  }

  WrongSample first_doubled(const MaskLayout& layout) const {
    const auto word = std::ranges::find_if(composition_.doubled, [](std::uint64_t w) { return w != 0; });
    return {WrongSample::Kind::doubled, 0, std::countr_zero(*word),
            static_cast<int>(word - composition_.doubled.begin()) / static_cast<int>(layout.row_words()), 0};
  }

  // Where the same is not covered, the rules are broken before the change or after it: the first triangle that breaks
  // them, alone.
  Scene scene_to_blame(const Experiment& experiment, std::span<const Piece> pieces) const {
    const auto alone = [](const Scene& scene, std::size_t triangle) {
      return Scene{scene.setting, scene.rules, {scene.triangles[triangle]}, {}};
    };
    const auto breaks_rules = [](const Scene& scene, MaskView mask) {
      std::vector<std::uint64_t> by_rules(mask.size());
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[0], by_rules);
      return !std::ranges::equal(by_rules, mask);
    };
    for (const Piece& piece : pieces) {
      Scene scene = alone(experiment.variants[piece.variant], piece.triangle);
      if (breaks_rules(scene, variants_[piece.variant][piece.triangle])) return scene;
    }
    return alone(experiment.base, pieces.front().base);
  }

  bool as_predicted(const Experiment& experiment, std::span<const Piece> pieces) {
    if (deviation_ == nullptr) return false;
    const auto follows = [&](const Scene& scene, const MaskBatch& masks, std::size_t i) {
      predicted_.resize(masks[i].size());
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], predicted_);
      if (deviation_->in_window.may_concern(scene.setting, scene.triangles[i])) {
        deviation_->in_window.predict(scene.setting, scene.triangles[i], predicted_);
      }
      return std::ranges::equal(predicted_, masks[i]);
    };
    return follows(experiment.base, base_, pieces.front().base) && std::ranges::all_of(pieces, [&](const Piece& p) {
             return follows(experiment.variants[p.variant], variants_[p.variant], p.triangle);
           });
  }

  const Metamorphosis& metamorphosis_;
  std::uint64_t index_ = 0;
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
  Experimenter experimenter(metamorphosis, subject, deviation, trial);
  const std::uint64_t count = metamorphic_count(options.count);
  for (std::uint64_t index = 0, done = 0; done < count; ++index) {
    const std::size_t triangles = std::min<std::uint64_t>(kExperimentTriangles, count - done);
    const Experiment experiment = make_experiment(metamorphosis, rules, options.seed, index, triangles);
    if (!experimenter.draw(experiment, index)) break;
    done += experiment.base.triangles.size();
    options.on_progress(experiment.base.triangles.size());
  }
  trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  trial.subject_seconds = subject.driver_seconds() - subject_seconds;
  return trial;
}

}  // namespace edgecase::conformance
