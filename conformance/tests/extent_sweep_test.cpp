// Limits found by bisection: the exact extent at which a subject turns wrong, or refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "conformance/runner/extent_sweep.h"
#include "conformance/runner/run.h"
#include "conformance/subjects/fault_subject.h"

namespace edgecase::conformance {
namespace {

float reach(const Triangle& triangle) {
  float result = 0;
  for (const Position& p : triangle) result = std::max({result, std::abs(p.x), std::abs(p.y)});
  return result;
}

// Exact, but for triangles that reach beyond one distance; and refuses those beyond another.
class Bounded : public Subject {
 public:
  Bounded(float exact, float accepted) : bound_(exact), accepted_(accepted) {}
  const SubjectInfo& info() const override { return host_->info(); }
  std::optional<std::string> refusal(const Scene& scene) const override {
    for (const Triangle& t : scene.triangles) {
      if (reach(t) > accepted_) return "too far";
    }
    return host_->refusal(scene);
  }
  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    auto drawn = host_->draw(scene, masks);
    for (std::size_t i = 0; i < masks.size(); ++i) {
      if (reach(scene.triangles[i]) > bound_) masks[i][0] ^= 1;
    }
    return drawn;
  }

 private:
  std::unique_ptr<Subject> host_ = make_faultless_subject();
  float bound_;
  float accepted_;
};

Limit limit_of(Subject& subject, std::size_t triangles = 100, const KnownDeviation* deviation = nullptr) {
  auto reference = reference_for("bounded").value();
  const auto limit = find_limit(subject, subject.info().rules, reference, deviation, 1, triangles);
  EXPECT_TRUE(limit) << limit.error().message;
  return limit.value_or(Limit{});
}

constexpr float kNever = std::numeric_limits<float>::infinity();

TEST(ExtentSweep, ScenesReachTheExtentAndNotFurther) {
  for (const std::int64_t extent : {std::int64_t{1}, std::int64_t{255}, std::int64_t{256}, std::int64_t{5000},
                                    std::int64_t{8'388'607}, std::int64_t{16'777'216}}) {
    std::size_t through_a_centre = 0;
    for (const Triangle& t : extent_scene({}, extent, 1, 300).triangles) {
      EXPECT_EQ(reach(t) * 256, static_cast<float>(extent));
      for (std::size_t v = 0; v < 3; ++v) {
        const auto centred = [](float a, float b) { return std::fmod((a + b) / 2, 1.0F) == 0.5F; };
        const Position& a = t[v];
        const Position& b = t[(v + 1) % 3];
        through_a_centre += centred(a.x, b.x) && centred(a.y, b.y) ? 1 : 0;
      }
    }
    EXPECT_TRUE(extent < 256 || through_a_centre > 100) << extent;
  }
}

TEST(ExtentSweep, FindsWhereASubjectTurnsWrong) {
  for (const float bound : {1.0F, 1.00390625F, 37.5F, 4096.0F, 20000.25F}) {
    Bounded subject(bound, kNever);
    const Limit limit = limit_of(subject);
    EXPECT_EQ(limit.pixels(), bound);
    EXPECT_FALSE(limit.refused);
  }
}

TEST(ExtentSweep, FindsWhereASubjectRefuses) {
  Bounded subject(kNever, 8192);
  const Limit limit = limit_of(subject);
  EXPECT_EQ(limit.pixels(), 8192);
  EXPECT_EQ(limit.refused, "too far");
  EXPECT_EQ(describe_limit(limit), "exact to ±8,192 px; beyond: not accepted");
  Bounded wrong_before(100.25F, 8192);
  EXPECT_EQ(describe_limit(limit_of(wrong_before)), "exact to ±100.25 px; beyond: wrong samples");
  Bounded never(0, kNever);
  EXPECT_EQ(describe_limit(limit_of(never)), "wrong at ±1 px already");
}

// As Bounded, but wrong from 100 px on, which is all that is known of it.
void predict_bounded(const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
  Scene scene;
  scene.setting = setting;
  scene.triangles = {triangle};
  MaskBatch masks;
  ASSERT_TRUE(Bounded(100, kNever).draw(scene, masks));
  std::ranges::copy(masks[0], mask.begin());
}

TEST(ExtentSweep, ADeviationExplainsFurther) {
  const KnownDeviation all{"bounded", "", "", predict_bounded};
  Bounded accepted(100, 8192);
  EXPECT_EQ(describe_limit(limit_of(accepted, 100, &all)),
            "exact to ±100 px, as its known deviation predicts to ±8,192 px; beyond: not accepted");
  const KnownDeviation half{"bounded", "", "", {predict_bounded, [](const Setting&, const Triangle& triangle) {
                                                  return reach(triangle) <= 5000;
                                                }}};
  EXPECT_EQ(describe_limit(limit_of(accepted, 100, &half)),
            "exact to ±100 px, as its known deviation predicts to ±5,000 px; beyond: wrong samples");
  // Wrong, but not as predicted: nothing is explained.
  const KnownDeviation other{"bounded", "", "",
                             [](const Setting&, const Triangle&, MutableMaskView mask) { std::ranges::fill(mask, 0); }};
  EXPECT_EQ(describe_limit(limit_of(accepted, 100, &other)), "exact to ±100 px; beyond: wrong samples");
}

// The largest value of an edge within the target's blocks, (E + 64.5)(E + 32.5) px^2, is that of a right angle which
// reaches E to the left and above and ends with the first tile. It comes to 2^23 between 2,847.8515625 and one subpixel
// more.
TEST(ExtentSweep, LlvmpipesLimitIsWhereItsEdgesWrap) {
  const auto product = [](double extent) { return (extent + 64.5) * (extent + 32.5); };
  ASSERT_LT(product(2847.8515625), 0x1p23);
  ASSERT_GE(product(2847.8515625 + 1.0 / 256), 0x1p23);
  auto lavapipe = make_subject("lavapipe").value();
  EXPECT_EQ(describe_limit(limit_of(*lavapipe, 2000)), "exact to ±2,847.8515625 px; beyond: wrong samples");
}

TEST(ExtentSweep, OursIsExactOverTheWholeFormatAndAnOverflowIsNot) {
  auto ours = make_subject("edgecase").value();
  auto oracle = reference_for("edgecase").value();
  const auto limit = find_limit(*ours, {}, oracle, nullptr, 1, 300);
  ASSERT_TRUE(limit) << limit.error().message;
  EXPECT_EQ(describe_limit(*limit), "exact to ±32,767.99609375 px; beyond: not accepted");
  const auto overflow = make_fault_subject("overflow-c");
  const Limit found = limit_of(*overflow, 300);
  EXPECT_GT(found.pixels(), 16);
  EXPECT_LT(found.pixels(), 4096);
  EXPECT_FALSE(found.refused);
}

}  // namespace
}  // namespace edgecase::conformance
