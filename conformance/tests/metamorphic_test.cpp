// The metamorphic checks: an exact rasterizer passes each, and each catches a rasterizer that is wrong in its way.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "conformance/metamorphic/metamorphosis.h"
#include "conformance/runner/metamorphic_trial.h"
#include "conformance/subjects/fault_subject.h"

namespace edgecase::conformance {
namespace {

using Spoil = std::function<void(const Scene&, MaskBatch&)>;

// An exact rasterizer whose masks are spoilt afterwards.
class Spoilt : public Subject {
 public:
  explicit Spoilt(Spoil spoil) : spoil_(std::move(spoil)) {}
  const SubjectInfo& info() const override { return exact_->info(); }
  std::optional<std::string> refusal(const Scene& scene) const override { return exact_->refusal(scene); }
  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    auto drawn = exact_->draw(scene, masks);
    spoil_(scene, masks);
    return drawn;
  }

 private:
  std::unique_ptr<Subject> exact_ = make_faultless_subject();
  Spoil spoil_;
};

Trial try_on(const char* name, Subject& subject, std::uint64_t count = 8000) {
  return try_metamorphosis(*find_metamorphosis(name), subject, subject.info().rules, nullptr, {count, 1});
}

std::uint64_t changed_by(const char* name, const Spoil& spoil) {
  Spoilt subject(spoil);
  const Trial trial = try_on(name, subject);
  EXPECT_FALSE(trial.failure);
  EXPECT_FALSE(trial.skipped);
  EXPECT_EQ(trial.outcome.findings.empty(), trial.outcome.unexplained == 0);
  return trial.outcome.unexplained;
}

void clear_column(MaskBatch& masks, int x) {
  for (std::uint64_t& row : masks.data()) row &= ~(std::uint64_t{1} << x);
}

TEST(Metamorphic, AnExactRasterizerPassesAll) {
  const auto exact = make_faultless_subject();
  for (const Metamorphosis& metamorphosis : metamorphoses()) {
    SCOPED_TRACE(metamorphosis.name);
    const Trial trial = try_metamorphosis(metamorphosis, *exact, {}, nullptr, {8000, 1});
    EXPECT_FALSE(trial.skipped);
    EXPECT_EQ(trial.outcome.unexplained, 0u);
    EXPECT_GE(trial.outcome.triangles.triangles, metamorphic_count(8000));
    EXPECT_GT(trial.outcome.triangles.samples_compared, trial.outcome.triangles.triangles * 100);
  }
}

TEST(Metamorphic, TranslationAndTilesCatchABorderThatIsDropped) {
  const Spoil left = [](const Scene&, MaskBatch& masks) { clear_column(masks, 0); };
  EXPECT_GT(changed_by("translation", left), 0u);
  EXPECT_GT(changed_by("tiles", left), 0u);
  const Spoil right = [](const Scene& scene, MaskBatch& masks) { clear_column(masks, scene.setting.target.width - 1); };
  EXPECT_GT(changed_by("translation", right), 0u);
  EXPECT_GT(changed_by("tiles", right), 0u);
}

TEST(Metamorphic, ScissorTilesCatchAScissorOneColumnShort) {
  EXPECT_GT(changed_by("scissor_tiles",
                       [](const Scene& scene, MaskBatch& masks) {
                         if (scene.setting.scissor) clear_column(masks, scene.setting.scissor->x);
                       }),
            0u);
  EXPECT_GT(changed_by("scissor_tiles",
                       [](const Scene& scene, MaskBatch& masks) {
                         for (std::size_t i = 0; scene.setting.scissor && i < masks.size(); ++i) {
                           if (scene.setting.scissor->x > 0) cover(masks[i], 0);
                         }
                       }),
            0u);
}

TEST(Metamorphic, VertexRotationCatchesAFirstVertexThatIsSpecial) {
  EXPECT_GT(changed_by("vertex_rotation",
                       [](const Scene& scene, MaskBatch& masks) {
                         for (std::size_t i = 0; i < masks.size(); ++i) {
                           const Triangle& t = scene.triangles[i];
                           if (t[0].x > t[1].x && t[0].x > t[2].x) masks[i][7] &= masks[i][7] - 1;
                         }
                       }),
            0u);
}

TEST(Metamorphic, WindingReversalCatchesOneWindingThatIsDropped) {
  const auto one_winding = make_fault_subject("one-winding");
  ASSERT_NE(one_winding, nullptr);
  EXPECT_GT(try_on("winding_reversal", *one_winding).outcome.unexplained, 0u);
}

TEST(Metamorphic, DrawingOrderCatchesALastTriangleThatIsLost) {
  EXPECT_GT(changed_by("drawing_order",
                       [](const Scene&, MaskBatch& masks) {
                         for (std::uint64_t& word : masks[masks.size() - 1]) word = 0;
                       }),
            0u);
}

TEST(Metamorphic, EdgeRefinementCatchesHolesAndDoubles) {
  const auto holes = make_fault_subject("all-exclusive");
  ASSERT_NE(holes, nullptr);
  const Outcome missing = try_on("edge_refinement", *holes).outcome;
  EXPECT_GT(missing.unexplained, 0u);
  EXPECT_GT(missing.triangles.missing, 0u);
  const auto doubles = make_fault_subject("right-inclusive");
  ASSERT_NE(doubles, nullptr);
  const Outcome doubled = try_on("edge_refinement", *doubles).outcome;
  EXPECT_GT(doubled.unexplained, 0u);
  EXPECT_GT(doubled.meshes.doubled, 0u);
}

// Each finding shows the sample that changed, before and after, and a scene in which the rules blame the subject for
// it.
TEST(Metamorphic, FindingsShowTheChange) {
  const auto by_rules = make_faultless_subject();
  for (const char* fault : {"all-exclusive", "right-inclusive"}) {
    const auto subject = make_fault_subject(fault);
    const auto findings = try_on("edge_refinement", *subject).outcome.findings;
    EXPECT_EQ(findings.size(), 3u);
    for (const Finding& finding : findings) {
      ASSERT_TRUE(finding.change);
      EXPECT_GE(finding.window.triangles.size(), 2u);
      const WrongSample& at = finding.wrong;
      const std::size_t bit = MaskLayout(finding.window.setting).bit(at.x, at.y, at.sample);
      int before = 0;
      int after = 0;
      for (std::size_t i = 0; i < finding.expected.size(); ++i) {
        before += covered(finding.expected[i], bit) ? 1 : 0;
        after += covered(finding.observed[i], bit) ? 1 : 0;
      }
      EXPECT_EQ(before, 1);
      const bool missing = at.kind == WrongSample::Kind::missing;
      EXPECT_TRUE(missing ? after == 0 : after >= 2) << after;
      MaskBatch right, drawn;
      ASSERT_TRUE(by_rules->draw(finding.scene, right) && subject->draw(finding.scene, drawn));
      EXPECT_FALSE(std::ranges::equal(right.data(), drawn.data()));
    }
  }
}

// Moved triangles are shown where they came from.
TEST(Metamorphic, FindingsAreShownInTheBaseScene) {
  Spoilt left([](const Scene&, MaskBatch& masks) { clear_column(masks, 0); });
  for (const Finding& finding : try_on("translation", left).outcome.findings) {
    EXPECT_EQ(finding.window.triangles, std::vector{finding.change->before});
  }
}

TEST(Metamorphic, WhatAModelPredictsIsKnown) {
  // A rasterizer without its top border, and the model of one that says so.
  Spoilt subject([](const Scene&, MaskBatch& masks) {
    for (std::size_t i = 0; i < masks.size(); ++i) masks[i][0] = 0;
  });
  const KnownDeviation model{"spoilt",
                             {},
                             "its top row is missing",
                             [](const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
                               Scene scene;
                               scene.setting = setting;
                               scene.triangles = {triangle};
                               MaskBatch masks;
                               ASSERT_TRUE(make_faultless_subject()->draw(scene, masks));
                               std::ranges::copy(masks[0], mask.begin());
                               mask[0] = 0;
                             }};
  const Metamorphosis& tiles = *find_metamorphosis("tiles");
  const Outcome known = try_metamorphosis(tiles, subject, {}, &model, {4000, 1}).outcome;
  EXPECT_GT(known.known_triangles, 0u);
  EXPECT_EQ(known.unexplained, 0u);
  Spoilt other([](const Scene&, MaskBatch& masks) { clear_column(masks, 0); });
  EXPECT_GT(try_metamorphosis(tiles, other, {}, &model, {4000, 1}).outcome.unexplained, 0u);
}

TEST(Metamorphic, TheSameArgumentsGiveTheSameExperiment) {
  const Metamorphosis& tiles = *find_metamorphosis("tiles");
  const auto triangles = [&](std::uint64_t seed, std::uint64_t index) {
    return make_experiment(tiles, {}, seed, index, 50).variants[3].triangles;
  };
  EXPECT_EQ(triangles(1, 2), triangles(1, 2));
  EXPECT_NE(triangles(1, 2), triangles(1, 3));
  EXPECT_NE(triangles(1, 2), triangles(2, 2));
}

}  // namespace
}  // namespace edgecase::conformance
