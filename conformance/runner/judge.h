// Judging one batch of triangles: what the subject drew against what the rules demand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/compare/clip_mesh.h"
#include "conformance/compare/compare.h"
#include "conformance/compare/watertight.h"
#include "conformance/runner/known_deviations.h"
#include "conformance/runner/reference.h"
#include "conformance/scene/drawn_masks.h"
#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// Triangles to draw at once. The scenes they came from, in order, tell where each triangle can be found again.
struct Batch {
  struct Part {
    std::uint64_t index = 0;  ///< the generator's scene number
    std::size_t first = 0;    ///< its first triangle in `scene`
  };
  Scene scene;
  std::vector<Part> parts;
  /// One mask a triangle of samples that the case leaves open; empty if there are none.
  std::vector<std::uint64_t> may{};
  /// What the triangles are judged by.
  const RuleSet* rule_set = &kExactRules;
};

/// A change that must not matter, and did.
struct Change {
  std::string about;
  Triangle before;  ///< what the finding's triangles cover together was this one's
};

/// One wrong sample with all it takes to show it: the triangle alone, or the mesh if it is the mesh that is torn.
struct Finding {
  Scene scene;
  Scene window;  ///< the scene, or what the subject's model or a change makes of it in the window
  MaskBatch expected;
  MaskBatch observed;
  WrongSample wrong;             ///< its triangle counts in `window`
  std::uint64_t part_index = 0;  ///< the generator's scene number
  bool known = false;            ///< predicted by a known deviation's model
  std::optional<Change> change{};
  const RuleSet* rule_set = &kExactRules;
  bool crack = false;  ///< a mesh that clipping tore; known if the model of the clipper predicts it
};

/// How many of a kind are kept to be shown. What is known is explained where it is listed.
inline std::ptrdiff_t most_findings(bool known) { return known ? 1 : 3; }

/// What came of one subject on one case or generator. Sums up over batches.
struct Outcome {
  Comparison triangles;
  Watertightness meshes;              ///< of those checked
  std::uint64_t agreed_meshes = 0;    ///< of these, one in kMeshShare was checked
  Cracks cracks;                      ///< of meshes in clip space
  std::uint64_t known_triangles = 0;  ///< wrong as predicted
  std::uint64_t unpredicted = 0;      ///< in clip space beyond the reach of the model; not compared
  std::uint64_t may = 0;              ///< samples that the rule set leaves open, covered otherwise than by Rules
  std::uint64_t unexplained = 0;      ///< triangles wrong and not predicted, or predicted wrong and right
  std::uint64_t obsolete = 0;         ///< of these, predicted to be wrong and right
  /// The first of each kind: up to most_findings().
  std::vector<Finding> findings;
};

/// One in this many meshes of batches that are as the rules have them is checked as a mesh, too; of all other batches,
/// every one. Where each mask is that of the top-left rule, a mesh is watertight because the rule makes it so: what its
/// check can still find is a fault that the subject and our reference have in common. The oracles look for those in one
/// of kOracleShare triangles; this looks in many more, in another way, and without a rule.
inline constexpr std::uint64_t kMeshShare = 16;

/// One in this many triangles that are wrong as a known deviation's model predicts is given to both oracles; of all
/// other wrong ones, every one. Two answers agree on each of its samples already, the subject's and the model's, and
/// both start from the rules that the oracles' share of all triangles confirms.
inline constexpr std::uint64_t kKnownShare = 64;

class Judge {
 public:
  /// `deviation` may be null. Keeps the references.
  Judge(Subject& subject, Reference& reference, const KnownDeviation* deviation)
      : subject_(subject), reference_(reference), deviation_(deviation) {}

  /// Why the scene cannot be judged: the subject refuses it, or nobody knows what it has to cover.
  std::optional<std::string> refusal(const Scene& scene, const RuleSet& rule_set = kExactRules) const;

  /// Draws `batch`, which must not be refused, and adds what came of it. `first_triangle` is the number of the
  /// batch's first triangle in the whole run. An error means that subject or suite failed, not that samples are wrong.
  tl::expected<void, Error> judge(const Batch& batch, std::size_t first_triangle, Outcome& outcome);

 private:
  /// The scene in the window if the rule set is not exact: no model of a driver has a say in what it demands.
  const Scene& judged_scene(const Batch& batch) const { return window_ ? *window_ : batch.scene; }
  /// Whether it is likely that the masks of the batch are all as the reference has them, and enough to know that.
  bool is_plain(const Batch& batch) const;
  /// Whether the known deviation may concern any triangle of the batch.
  bool may_deviate(const Batch& batch) const;
  /// Makes observed_ what drawn_ is, if it is not yet.
  void observe() {
    if (observed_.size() == 0) observed_ = drawn_.whole(scratch_);
  }
  /// Compares mask by mask.
  tl::expected<void, Error> compare(const Batch& batch, std::size_t first_triangle, Outcome& outcome);
  /// The masks that the last batch should have.
  MaskBatchView expected() const { return agreed_ ? observed_ : MaskBatchView(expected_); }
  /// One by one; wrong_ is of the batch.
  tl::expected<void, Error> judge_triangles(const Batch& batch, Outcome& outcome);
  /// Whether it may concern that triangle of the scene that the reference has taken up.
  bool may_deviate(const Scene& scene, std::size_t triangle) const;
  /// Whether the subject drew what its known deviation predicts for that triangle.
  bool as_predicted(const Batch& batch, std::size_t triangle);
  void predict_clipped(std::size_t triangle);

  // In judge_meshes.cpp.
  void judge_meshes(const Batch& batch, std::size_t first_triangle, Outcome& outcome);
  void judge_clip_meshes(const Batch& batch, std::size_t first_triangle, Outcome& outcome);

  // In judge_findings.cpp.
  void add_finding(const Batch& batch, std::size_t first, std::size_t count, const WrongSample& wrong, bool known,
                   Outcome& outcome) const;
  /// `inside` is what has to be covered once.
  void add_crack(const Batch& batch, const Mesh& mesh, const WrongSample& wrong, MaskView inside, bool known,
                 Outcome& outcome) const;
  void show_clipped(std::size_t first, std::size_t count, Finding& finding) const;

  Subject& subject_;
  Reference& reference_;
  const KnownDeviation* deviation_;
  bool agreed_ = false;  ///< the last batch was drawn as expected, and expected_ says nothing
  MaskBatch expected_;
  DrawnMasks drawn_;        ///< where the subject has them, or in scratch_
  MaskBatchView observed_;  ///< the same, whole: where a batch agrees, only if need be
  MaskBatch scratch_;
  MaskBatch mesh_masks_;
  std::optional<Scene> window_;
  std::vector<WrongSample> wrong_;  ///< the first one of each wrong triangle, which is counted from the batch's first
  std::vector<std::uint64_t> predicted_;
  std::vector<std::uint64_t> part_;
  std::vector<GridTriangle> snapped_;
  std::optional<WatertightChecker> checker_;  ///< for the setting of the last batch with meshes
};

}  // namespace edgecase::conformance
