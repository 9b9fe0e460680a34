// Which meshes are checked as a whole, and what that finds when the reference itself is wrong.
#include "conformance/runner/judge.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "conformance/generators/generator.h"
#include "conformance/models/transform_model.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

Batch meshes_of(const char* name, std::size_t count) {
  const Generator& generator = *find_generator(name);
  Batch batch;
  batch.scene.setting = generator.setting;
  for (std::uint64_t i = 0; batch.scene.meshes.size() < count; ++i) {
    batch.parts.push_back({i, triangle_count(batch.scene)});
    append_scene(generator, 1, i, batch.scene);
  }
  return batch;
}

Outcome judged(const Batch& batch, const char* drawing, const char* judging, std::size_t batches = 1) {
  const auto subject = make_subject(drawing).value();
  Reference reference(make_subject(judging).value());
  Judge judge(*subject, reference, nullptr);
  Outcome outcome;
  // From triangle 1 on, so that the oracles' first share comes late.
  for (std::size_t i = 0; i < batches; ++i) EXPECT_TRUE(judge.judge(batch, 1, outcome));
  return outcome;
}

TEST(JudgedMeshes, AreAShareOfThoseThatAgree) {
  const Batch batch = meshes_of("grid", 3 * kMeshShare + 1);
  EXPECT_EQ(judged(batch, "edgecase", "edgecase").meshes.meshes, 4U);
  const Outcome twice = judged(batch, "edgecase", "edgecase", 2);
  EXPECT_EQ(twice.agreed_meshes, 2 * batch.scene.meshes.size());
  EXPECT_EQ(twice.meshes.meshes, 7U);  // the share goes on from batch to batch
}

TEST(JudgedMeshes, AreAllOfABatchThatDiffers) {
  const Batch batch = meshes_of("triangulation", 20);
  const Outcome outcome = judged(batch, "fault:slanted-left-exclusive", "edgecase");
  EXPECT_GT(outcome.triangles.wrong_triangles, 0U);
  EXPECT_LT(outcome.triangles.wrong_triangles, batch.scene.triangles.size());
  EXPECT_EQ(outcome.meshes.meshes, 20U);
}

// Where nothing differs the oracles look at the subject's masks instead of ours: as many, of any way of snapping.
TEST(Reference, GivesTheOraclesTheirShareOfWhatAgrees) {
  Scene scene = meshes_of("grid", 40).scene;
  ASSERT_GT(scene.triangles.size(), 2 * kOracleShare);
  for (const bool half_pixel_first : {false, true}) {
    scene.rules.half_pixel_first = half_pixel_first;
    Reference reference(make_subject("edgecase").value());
    MaskBatch masks;
    ASSERT_TRUE(reference.expect(scene, 1, masks));
    const std::uint64_t share = reference.confirmed();
    EXPECT_EQ(share, (scene.triangles.size() + 1 + kOracleShare - 1) / kOracleShare - 1);
    ASSERT_EQ(reference.expects(1, MaskBatchView(masks)), true);
    EXPECT_EQ(reference.confirmed(), 2 * share);
    // As a driver has them.
    ASSERT_TRUE(MaskLayout(scene.setting).has_short_rows());
    std::vector<std::uint32_t> rows(masks.data().begin(), masks.data().end());
    ASSERT_EQ(reference.expects(1, DrawnMasks(MaskLayout(scene.setting), rows)), true);
    EXPECT_EQ(reference.confirmed(), 3 * share);
    rows[rows.size() - 7] ^= 4;
    ASSERT_EQ(reference.expects(1, DrawnMasks(MaskLayout(scene.setting), rows)), false);
    masks[scene.triangles.size() - 1][3] ^= 4;
    ASSERT_EQ(reference.expects(1, MaskBatchView(masks)), false);
  }
}

// Seen whole, one cut to a quad, one beyond a plane.
TEST(Reference, TellsInClipSpaceWithoutMasksWhereNoTriangleBecomesTwo) {
  const ClipTriangle seen{{{-0.5F, -0.5F, 0, 1}, {0.5F, -0.5F, 0, 1}, {0, 0.7F, 0, 1}}};
  const ClipTriangle cut{{{-0.5F, -0.5F, 0, 1}, {2, -0.5F, 0, 1}, {0, 0.7F, 0, 1}}};
  const ClipTriangle beyond{{{2, -0.5F, 0, 1}, {3, -0.5F, 0, 1}, {2, 0.7F, 0, 1}}};
  Scene scene;
  scene.setting.target = {32, 32};
  scene.clip = ClipGeometry{{0, 0, 32, 32}, {seen, beyond, seen}};
  Reference reference(make_subject("edgecase").value(), lavapipe_model());
  MaskBatch masks;
  ASSERT_TRUE(reference.expect(scene, 1, masks));
  EXPECT_EQ(reference.expects(1, MaskBatchView(masks)), true);
  for (const std::size_t i : {0U, 1U, 2U}) {
    masks[i][9] ^= 4;
    EXPECT_EQ(reference.expects(1, MaskBatchView(masks)), false) << i;
    masks[i][9] ^= 4;
  }
  scene.clip->triangles[1] = cut;
  ASSERT_TRUE(reference.expect(scene, 1, masks));
  EXPECT_EQ(reference.window().parts_of(1), 2U);
  EXPECT_EQ(reference.expects(1, MaskBatchView(masks)), false) << "it cannot tell";
}

MaskBatch of_parts(const Reference& reference) {
  MaskBatch masks;
  EXPECT_TRUE(make_subject("edgecase").value()->draw(reference.window().scene, masks));
  return masks;
}

// With several samples llvmpipe is given a scissor that is wider than what it lets through.
TEST(Reference, CannotTellWithoutMasksWhatIsFiltered) {
  Scene scene;
  scene.setting = find_generator("clip_grids_samples4")->setting;
  scene.setting.scissor = Rect{5, 7, 19, 13};
  scene.clip = ClipGeometry{{0, 0, 32, 32}, {{{{-0.9F, -0.9F, 0, 1}, {0.9F, -0.9F, 0, 1}, {0, 0.9F, 0, 1}}}}};
  Reference reference(make_subject("edgecase").value(), lavapipe_model());
  MaskBatch masks;
  ASSERT_TRUE(reference.expect(scene, 1, masks));
  const MaskBatch unfiltered = of_parts(reference);
  ASSERT_EQ(unfiltered.size(), 1U);
  ASSERT_FALSE(std::ranges::equal(unfiltered[0], masks[0]));
  EXPECT_EQ(reference.expects(1, MaskBatchView(unfiltered)), false);
}

// SwiftShader takes away what a triangle covers that the snap has turned over.
TEST(Reference, CannotTellWithoutMasksWhatIsTakenAway) {
  Scene slivers;
  slivers.setting = find_generator("cull_across")->setting;
  slivers.setting.cull = CullMode::none;
  for (std::uint64_t i = 0; i < 2000; ++i) append_scene(*find_generator("cull_across"), 1, i, slivers);
  Reference reference(make_subject("edgecase").value(), swiftshader_model());
  std::size_t taken_away = 0;
  for (const ClipTriangle& sliver : slivers.clip->triangles) {
    Scene scene;
    scene.setting = slivers.setting;
    scene.clip = ClipGeometry{slivers.clip->viewport, {sliver}};
    MaskBatch masks;
    ASSERT_TRUE(reference.expect(scene, 1, masks));
    const MaskBatch added = of_parts(reference);
    if (added.size() == 0 || std::ranges::equal(added[0], masks[0])) continue;
    ++taken_away;
    EXPECT_EQ(reference.expects(1, MaskBatchView(added)), false);
  }
  EXPECT_GT(taken_away, 0U);
}

// Every mask is as expected, and what is expected is wrong.
TEST(JudgedMeshes, ShowAFaultOfTheReference) {
  const Batch batch = meshes_of("fan", 3);
  ASSERT_LT(batch.scene.triangles.size(), kOracleShare - 1);
  const Outcome outcome = judged(batch, "fault:all-exclusive", "fault:all-exclusive");
  EXPECT_EQ(outcome.triangles.wrong_triangles, 0U);
  EXPECT_GT(outcome.meshes.missing, 0U);
  EXPECT_GT(outcome.unexplained, 0U);
}

}  // namespace
}  // namespace edgecase::conformance
