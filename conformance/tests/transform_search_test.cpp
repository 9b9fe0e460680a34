#include "conformance/runner/transform_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "conformance/generators/random.h"
#include "conformance/runner/transform_probe.h"
#include "conformance/subjects/fault_subject.h"
#include "conformance/subjects/registry.h"
#include "conformance/tests/modelled_subject.h"

namespace edgecase::conformance {
namespace {

std::string pair_of(const TransformModel& a, const TransformModel& b) {
  return describe_transform(a) + " | " + describe_transform(b);
}

bool same_axes(const TransformModel& a, const TransformModel& b) {
  return a.rules == b.rules && a.multiply_add == b.multiply_add && a.shift == b.shift &&
         a.multisample_shift == b.multisample_shift;
}

// No pair is left over: every two candidates are told apart by some binary32 position.
TEST(TransformProbe, TellsEveryTwoCandidatesApart) {
  for (const int bits : {4, 8}) {
    for (const int samples : {1, 4}) {
      for (const bool clip : {false, true}) {
        ModelledSubject subject({}, bits);
        subject.info().clip = clip;
        const auto candidates = transform_candidates(bits, clip);
        const TransformProbe probe = transform_probe(candidates, samples, subject);
        ASSERT_EQ(probe.group.size(), candidates.size());
        for (std::size_t i = 0; i < candidates.size(); ++i) {
          for (std::size_t j = 0; j < i; ++j) {
            EXPECT_NE(probe.group[i], probe.group[j])
                << samples << " samples: " << pair_of(candidates[i], candidates[j]);
          }
        }
      }
    }
  }
}

// Why fewer candidates are left without clip space: what is left out snaps no position elsewhere.
TEST(TransformProbe, LeavesOutOnlyWhatIsTheSameInTheWindow) {
  Random random(1);
  TransformModel before = lavapipe_model();
  TransformModel within = before;
  within.shift = HalfPixelShift::within_viewport;
  for (int i = 0; i < 100'000; ++i) {
    const auto any = [&] {
      const auto bits = static_cast<float>(random.between(1 << 23, (1 << 24) - 1));
      return std::ldexp(random.one_in(2) ? bits : -bits, static_cast<int>(random.between(-40, -10)));
    };
    const Position position{any(), any()};
    ASSERT_EQ(snapped(before, {}, position), snapped(within, {}, position)) << position.x << ' ' << position.y;
  }
}

TEST(TransformProbe, HasNoMoreTrianglesThanItNeeds) {
  ModelledSubject subject({}, 8);
  std::size_t triangles = 0;
  for (const Scene& scene : transform_probe(transform_candidates(8, true), 1, subject).scenes) {
    triangles += triangle_count(scene);
  }
  EXPECT_GT(triangles, 200u);
  EXPECT_LT(triangles, 500u);
}

TEST(TransformCandidates, AreEveryCombination) {
  EXPECT_EQ(transform_candidates(8, true).size(), 7u * 4 * 3 * 2);  // 4 to 10 bits
  EXPECT_EQ(transform_candidates(4, true).size(), 6u * 4 * 3 * 2);  // 3 to 8
  EXPECT_EQ(transform_candidates(8, false).size(), 7u * 4 * 2);
}

void expect_found(const TransformModel& model, int reported_bits, bool clip = true) {
  ModelledSubject subject(model, reported_bits);
  subject.info().clip = clip;
  const auto found = find_transform(subject);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(same_axes(*found, model)) << describe_transform(model) << " taken for " << describe_transform(*found);
}

// The candidates number `first`, and every `step`th after it.
void expect_found_every(std::size_t first, std::size_t step) {
  for (const int bits : {4, 8}) {
    const std::vector<TransformModel> candidates = transform_candidates(bits, true);
    for (std::size_t i = first; i < candidates.size(); i += step) expect_found(candidates[i], bits);
  }
}

// 61 meets most values of the axes, other bits than those reported included.
TEST(TransformSearch, FindsCandidates) { expect_found_every(5, 61); }
TEST(LongTransformSearch, FindsEveryCandidate) { expect_found_every(0, 1); }

TEST(TransformSearch, FindsAnotherShiftWithSeveralSamples) {
  for (const HalfPixelShift shift :
       {HalfPixelShift::none, HalfPixelShift::before_scaling, HalfPixelShift::within_viewport}) {
    TransformModel model = lavapipe_model();
    model.multisample_shift = shift;
    expect_found(model, 8);
  }
}

TEST(TransformSearch, DoesWithoutClipSpace) {
  for (const TransformModel& model : transform_candidates(8, false)) {
    if (model.rules.subpixel_bits == 8) expect_found(model, 8, false);
  }
}

TEST(TransformSearch, FailsIfNothingFits) {
  const auto floor = make_fault_subject("snap-floor");
  const auto found = find_transform(*floor);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("fault:snap-floor"), std::string::npos);
}

// llvmpipe subtracts the half pixel in binary32 before it scales and rounds, if there is one sample a pixel: the last
// bits of a coordinate near zero go with it, and what was just past a tie becomes the tie.
TEST(TransformSearch, FindsHowDriversTransform) {
  for (const auto& [name, model] :
       {std::pair{"lavapipe", &lavapipe_model()}, std::pair{"lavapipe:bgra8", &lavapipe_bgra8_model()},
        std::pair{"osmesa-llvmpipe", &osmesa_llvmpipe_model()}, std::pair{"swiftshader", &swiftshader_model()}}) {
    auto subject = make_subject(name);
    if (!subject && subject.error().kind == ErrorKind::absent && std::string(name) == "swiftshader") continue;
    ASSERT_TRUE(subject) << subject.error().message;
    const auto found = find_transform(**subject);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_TRUE(same_axes(*found, *model)) << name << ": " << describe_transform(*found);
  }
}

TEST(TransformSearch, SaysWhatWindowPositionsAreJudgedBy) {
  EXPECT_EQ(window_rules(lavapipe_model(), 1), (Rules{8, SnapRounding::nearest_even, true}));
  EXPECT_EQ(window_rules(lavapipe_model(), 4), (Rules{8, SnapRounding::nearest_even, false}));
  EXPECT_EQ(window_rules(swiftshader_model(), 4), (Rules{4, SnapRounding::nearest_even, true}));
}

}  // namespace
}  // namespace edgecase::conformance
