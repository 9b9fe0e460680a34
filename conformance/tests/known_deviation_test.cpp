// Known deviations: which subjects they are found for, and that they are judged both ways, in the window and in clip
// space: a subject that is no longer wrong where it is predicted to be fails as surely as one that is wrong elsewhere.
#include "conformance/runner/known_deviations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "conformance/generators/generator.h"
#include "conformance/runner/judge.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

const std::vector<KnownDeviation>& listed() {
  static const auto list =
      load_known_deviations(std::filesystem::path(EDGECASE_SOURCE_DIR) / "conformance/known_deviations.json").value();
  return list;
}

enum class Wrap {
  kept,      ///< as llvmpipe has it
  repaired,  ///< as the rules have it
  spread,    ///< one more triangle is lost, in the second half of the first scene
};

// Covers what llvmpipe covers, by our models and rasterizer.
class Llvmpipe : public Subject {
 public:
  explicit Llvmpipe(Wrap wrap) : wrap_(wrap) { info_.clip = true; }

  const SubjectInfo& info() const override { return info_; }
  std::optional<std::string> refusal(const Scene&) const override { return std::nullopt; }

  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    const KnownDeviation& known = *find_known_deviation(listed(), "lavapipe", "");
    if (!scene.clip) return draw_window(known.in_window, scene, masks);
    const WindowScene window = window_scene(lavapipe_model(), scene);
    MaskBatch parts;
    auto drawn = draw_window(known.of_part, window.scene, parts);
    unite(window, parts, masks);
    return drawn;
  }

 private:
  tl::expected<void, Error> draw_window(const DeviationModel& deviation, const Scene& scene, MaskBatch& masks) {
    auto drawn = rasterizer_->draw(scene, masks);
    for (std::size_t i = 0; i < masks.size(); ++i) {
      const std::vector<std::uint64_t> exact(masks[i].begin(), masks[i].end());
      if (wrap_ != Wrap::repaired && deviation.may_concern(scene.setting, scene.triangles[i])) {
        deviation.predict(scene.setting, scene.triangles[i], masks[i]);
      }
      const bool as_the_rules = std::ranges::equal(exact, masks[i]);
      if (wrap_ == Wrap::spread && !lost_ && i > masks.size() / 2 && as_the_rules &&
          exact != std::vector<std::uint64_t>(exact.size())) {
        std::ranges::fill(masks[i], 0);
        lost_ = true;
      }
    }
    return drawn;
  }

  Wrap wrap_;
  bool lost_ = false;
  SubjectInfo info_;
  std::unique_ptr<Subject> rasterizer_ = make_subject("edgecase").value();
};

// `confirmed`, if given, becomes how many triangles went to the oracles. `all_open`: every sample is.
Outcome judged(Wrap wrap, const char* name, std::uint64_t* confirmed = nullptr, bool all_open = false) {
  const Generator& generator = *find_generator(name);
  Batch batch;
  batch.scene.setting = generator.setting;
  for (std::uint64_t i = 0; i < 400; ++i) {
    batch.parts.push_back({i, triangle_count(batch.scene)});
    append_scene(generator, 1, i, batch.scene);
  }
  if (all_open)
    batch.may.assign(MaskLayout(batch.scene.setting).words() * batch.scene.triangles.size(), ~std::uint64_t{0});
  Llvmpipe subject(wrap);
  Reference reference(make_subject("edgecase").value(), lavapipe_model());
  Judge judge(subject, reference, find_known_deviation(listed(), "lavapipe", ""));
  Outcome outcome;
  const auto result = judge.judge(batch, 0, outcome);
  EXPECT_TRUE(result) << result.error().message;
  if (confirmed != nullptr) *confirmed = reference.confirmed();
  return outcome;
}

class JudgedBothWays : public testing::TestWithParam<const char*> {};

TEST_P(JudgedBothWays, IsKnownOnlyAsPredicted) {
  const Outcome kept = judged(Wrap::kept, GetParam());
  EXPECT_GT(kept.known_triangles, 20U);
  EXPECT_EQ(kept.known_triangles, kept.triangles.wrong_triangles);
  EXPECT_EQ(kept.unexplained, 0U);

  const Outcome repaired = judged(Wrap::repaired, GetParam());
  EXPECT_TRUE(repaired.triangles.all_right());
  EXPECT_EQ(repaired.known_triangles, 0U);
  EXPECT_EQ(repaired.unexplained, kept.known_triangles);
  EXPECT_EQ(repaired.obsolete, repaired.unexplained);

  const Outcome spread = judged(Wrap::spread, GetParam());
  EXPECT_EQ(spread.known_triangles, kept.known_triangles);
  EXPECT_GE(spread.unexplained, 1U);
  EXPECT_EQ(spread.obsolete, 0U);
}

INSTANTIATE_TEST_SUITE_P(Generators, JudgedBothWays,
                         testing::Values("far_corner", "far_corner_samples4", "near_corner_scissor",
                                         "near_corner_small", "scissor_samples4", "scissor_tiles_samples4",
                                         "far_rectangle", "clip_far", "clip_far_samples4"));

TEST(KnownDeviation, GivesTheOraclesAShareOfWhatIsPredictedAndAllElse) {
  constexpr std::uint64_t kOfAll = 400 / kOracleShare + 1;
  std::uint64_t confirmed = 0;
  const Outcome kept = judged(Wrap::kept, "far_corner", &confirmed);
  ASSERT_GT(kept.known_triangles, kKnownShare);
  EXPECT_EQ(confirmed, kOfAll + (kept.known_triangles + kKnownShare - 1) / kKnownShare);
  const Outcome spread = judged(Wrap::spread, "far_corner", &confirmed);
  ASSERT_EQ(spread.unexplained, 1U);
  EXPECT_EQ(confirmed, kOfAll + (kept.known_triangles + kKnownShare - 1) / kKnownShare + 1);
}

// Samples that llvmpipe is predicted to lose, and covers, as it may.
TEST(KnownDeviation, IsNotObsoleteWhereSamplesAreOpen) {
  const std::uint64_t all = judged(Wrap::repaired, "far_corner").obsolete;
  EXPECT_GT(all, 20U);
  EXPECT_LT(judged(Wrap::repaired, "far_corner", nullptr, true).obsolete, all / 2);
}

// Added to what the rules cover, or drawn in all that the driver reaches and filtered: two ways to the same masks.
TEST(KnownDeviation, PassesTheScissorAsTheModelInClipSpaceHasIt) {
  for (const char* name : {"scissor_samples4", "scissor_tiles_samples4"}) {
    Scene scene;
    scene.setting = find_generator(name)->setting;
    for (std::uint64_t i = 0; i < 400; ++i) append_scene(*find_generator(name), 1, i, scene);
    const auto rasterizer = make_subject("edgecase").value();
    const WindowScene window = window_scene(lavapipe_model(), scene);
    MaskBatch added, parts, filtered;
    ASSERT_TRUE(rasterizer->draw(window.scene, parts));
    unite(window, parts, filtered);
    ASSERT_TRUE(rasterizer->draw(scene, added));
    for (std::size_t i = 0; i < added.size(); ++i) {
      find_known_deviation(listed(), "lavapipe", "")->in_window.predict(scene.setting, scene.triangles[i], added[i]);
    }
    EXPECT_TRUE(std::ranges::equal(added.data(), filtered.data())) << name;
  }
}

// Its triangles are as predicted, and so is what that does to the mesh.
TEST(KnownDeviation, ExplainsTornMeshes) {
  const Outcome kept = judged(Wrap::kept, "far_rectangle");
  EXPECT_GT(kept.meshes.missing + kept.meshes.doubled, 0U);
  EXPECT_EQ(kept.unexplained, 0U);
}

TEST(KnownDeviation, IsFoundByNameOrByDevice) {
  const char* device = "llvmpipe (LLVM 19.1.7, 256 bits), llvmpipe Mesa 25.0.7";
  for (const char* subject : {"lavapipe", "lavapipe:bgra8", "osmesa-llvmpipe", "vulkan:build/some/icd.json"}) {
    const KnownDeviation* found = find_known_deviation(listed(), subject, device);
    ASSERT_NE(found, nullptr) << subject;
    EXPECT_FALSE(found->replaces_rules());
  }
  EXPECT_EQ(find_known_deviation(listed(), "vulkan:build/some/icd.json", "SwiftShader Device (Subzero)"), nullptr);
  EXPECT_EQ(find_known_deviation(listed(), "swiftshader", "SwiftShader Device (Subzero)"), nullptr);
  EXPECT_TRUE(find_known_deviation(listed(), "osmesa-softpipe", "softpipe")->replaces_rules());
}

}  // namespace
}  // namespace edgecase::conformance
