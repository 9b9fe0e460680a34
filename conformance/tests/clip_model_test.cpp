// The models against the drivers: no wrong sample in clip space, in viewports of any kind, and on positions made to
// tell apart how they are rounded.
#include "conformance/models/clip_model.h"

#include <cstdlib>

#include "conformance/generators/generator.h"
#include "conformance/tests/clip_scenes.h"

namespace edgecase::conformance {
namespace {

const Viewport kViewports[] = {
    {0, 0, 64, 60},                // the target
    {0, 0, 100, 75},               // larger than the target, and no power of two
    {7, 3, 41, 50},                // inside the target
    {0.3F, -1.7F, 61.1F, 47.9F},   // fractional
    {2.5005F, 1.5015F, 40, 40},    // ends that lie between the thresholds of rounding
    {-40, -30, 300, 200},          // all around the target
    {-2000, -1000, 5000, 3000},    // far around it
    {0, 60, 64, -60},              // upside down
    {3.3F, 70.1F, 57.3F, -77.7F},  // upside down and fractional
    {5, 5, 1, 1},                  // one pixel
};

Setting target(int samples) {
  Setting setting = square_setting(64, samples);
  setting.target.height = 60;
  return setting;
}

const auto kSubjects = testing::Values("lavapipe", "lavapipe:bgra8", "osmesa-llvmpipe", "swiftshader");

std::string alphanumeric(const testing::TestParamInfo<const char*>& subject) {
  std::string name(subject.param);
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

class Predicted : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    auto made = make_subject(GetParam());
    if (!made && std::string(GetParam()) == "swiftshader" && made.error().kind == ErrorKind::absent) {
      GTEST_SKIP() << made.error().message;
    }
    ASSERT_TRUE(made) << made.error().message;
    subject_ = std::move(*made);
    model_ = find_transform_model(GetParam(), subject_->info().device);
    ASSERT_NE(model_, nullptr);
    ASSERT_EQ(subject_->info().rules, model_->rules);
  }

  /// All kinds of triangles in every viewport; adds up what was found.
  Tally every_family(const Setting& setting, std::size_t count, unsigned seed) {
    Tally tally;
    for (const Viewport& viewport : kViewports) {
      if (viewport.height < 0 && !subject_->info().flipped_viewport) continue;
      for (const Homogeneous w : {Homogeneous::one, Homogeneous::positive, Homogeneous::either_sign}) {
        for (const float reach : {1.0F, 1.5F, 8.0F}) {
          for (const float depth_reach : {-1.0F, 0.7F}) {
            for (const int lattice : {0, 8}) {
              const Scene scene = clip_scene(setting, viewport, {w, reach, depth_reach, lattice}, count, seed++);
              EXPECT_EQ(subject_->refusal(scene), std::nullopt);
              tally += compared(*subject_, *model_, scene);
            }
          }
        }
      }
    }
    return tally;
  }

  void expect_every_family(int samples, std::size_t count, unsigned seed) {
    const Tally tally = every_family(target(samples), count, seed);
    EXPECT_EQ(tally.wrong, 0U) << "of " << tally.covered << " samples; " << tally.first;
    // Only a vertex with w = 0, or one as far away, is beyond the models.
    EXPECT_LE(tally.unpredicted * 500, tally.triangles);
    EXPECT_GT(tally.covered, 10 * tally.triangles);
    RecordProperty("triangles", std::to_string(tally.triangles));
    RecordProperty("unpredicted", std::to_string(tally.unpredicted));
  }

  std::unique_ptr<Subject> subject_;
  const TransformModel* model_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Drivers, Predicted, kSubjects, alphanumeric);

TEST_P(Predicted, InClipSpaceWithOneSample) { expect_every_family(1, 60, 1); }
TEST_P(Predicted, InClipSpaceWithFourSamples) { expect_every_family(4, 30, 1000); }

using LongPredicted = Predicted;
INSTANTIATE_TEST_SUITE_P(LongDrivers, LongPredicted, kSubjects, alphanumeric);
TEST_P(LongPredicted, InClipSpaceWithOneSample) { expect_every_family(1, 5000, 10'000); }
TEST_P(LongPredicted, InClipSpaceWithFourSamples) { expect_every_family(4, 2000, 20'000); }

TEST_P(Predicted, EveryGeneratorInClipSpace) {
  for (const Generator& generator : clip_generators()) {
    Scene scene;
    scene.setting = generator.setting;
    scene.rules = subject_->info().rules;
    for (std::uint64_t i = 0; i < 2000; ++i) append_scene(generator, 1, i, scene);
    if (generator.viewport->height < 0 && !subject_->info().flipped_viewport) continue;
    const Tally tally = compared(*subject_, *model_, scene);
    EXPECT_EQ(tally.wrong, 0U) << generator.name << ": of " << tally.covered << " samples; " << tally.first;
    EXPECT_LE(tally.unpredicted * 500, tally.triangles) << generator.name;
  }
}

TEST_P(Predicted, CulledInClipSpace) {
  for (const CullMode cull : {CullMode::front, CullMode::back}) {
    for (const FrontFace front : {FrontFace::clockwise, FrontFace::counter_clockwise}) {
      Setting setting = target(1);
      setting.cull = cull;
      setting.front_face = front;
      const Tally tally = every_family(setting, 15, 77);
      EXPECT_EQ(tally.wrong, 0U) << "of " << tally.covered << " samples; " << tally.first;
    }
  }
}

TEST_P(Predicted, ScissoredInClipSpace) {
  for (const int samples : {1, 4}) {
    for (const Rect& scissor : {Rect{10, 20, 31, 17}, Rect{-5, -5, 20, 200}, Rect{63, 59, 1, 1}, Rect{20, 20, 0, 5},
                                Rect{100, 0, 10, 10}, Rect{-2147483647, 30, 2147483647, 2147483647}}) {
      Setting setting = target(samples);
      setting.scissor = scissor;
      const Tally tally = every_family(setting, 5, 177);
      EXPECT_EQ(tally.wrong, 0U) << "of " << tally.covered << " samples; " << tally.first;
    }
  }
}

// Window positions that differ from a tie of the snap by nothing or by the least that binary32 can tell. Near 0 that is
// far less than elsewhere.
Scene window_tie_scene(Subject& subject, int samples) {
  Scene scene;
  scene.setting = square_setting(32, samples);
  std::mt19937 random(5);
  const auto coordinate = [&](int low, int high) {
    std::uniform_int_distribution<int> steps(low * 512, high * 512);
    float value = static_cast<float>(steps(random)) / 512.0F;
    for (auto step = random() % 3; step > 0; --step) {
      value = std::nextafter(value, random() % 2 == 0 ? -100.0F : 100.0F);
    }
    return value;
  };
  for (int i = 0; i < 10'000; ++i) {
    const int far = random() % 4 == 0 ? 100 : 1;
    Scene one = scene;
    one.triangles = {Triangle{{{coordinate(-far, far), coordinate(-far, far)},
                               {coordinate(-far, far), coordinate(-far, far)},
                               {coordinate(-8, 40), coordinate(-8, 40)}}}};
    // Subnormal neighbours of 0 do not reach a driver.
    if (!subject.refusal(one)) scene.triangles.push_back(one.triangles[0]);
  }
  return scene;
}

TEST_P(Predicted, OffTheGridByTheLeastBit) {
  for (const int samples : {1, 4}) {
    const Scene scene = window_tie_scene(*subject_, samples);
    ASSERT_GT(scene.triangles.size(), 8000U);
    const Tally tally = compared(*subject_, *model_, scene);
    EXPECT_EQ(tally.wrong, 0U) << "of " << tally.covered << " samples; " << tally.first;
    EXPECT_EQ(tally.unpredicted, 0U);
  }
}

// The same in clip space, in viewports whose transform rounds: positions whose exact image is a tie.
Scene tie_scene(const Setting& setting, const Viewport& viewport, unsigned seed) {
  Scene scene = clip_scene(setting, viewport, {}, 1500, seed);
  std::mt19937 random(seed);
  const auto tie = [&](float origin, float extent, float& clip) {
    const double window =
        static_cast<double>(origin) + (static_cast<double>(clip) + 1) / 2 * static_cast<double>(extent);
    const double target = (std::floor(window * 256) + 0.5) / 256;
    clip = static_cast<float>((target - static_cast<double>(origin)) / static_cast<double>(extent) * 2 - 1);
    for (auto step = random() % 3; step > 0; --step) clip = std::nextafter(clip, random() % 2 == 0 ? -2.0F : 2.0F);
  };
  for (ClipTriangle& triangle : scene.clip->triangles) {
    for (ClipPosition& p : triangle) {
      tie(viewport.x, viewport.width, p.x);
      tie(viewport.y, viewport.height, p.y);
    }
  }
  return scene;
}

TEST_P(Predicted, TiesOfEveryViewport) {
  for (const int samples : {1, 4}) {
    Tally tally;
    for (const Viewport& viewport : kViewports) {
      if (viewport.height < 0 && !subject_->info().flipped_viewport) continue;
      tally += compared(*subject_, *model_, tie_scene(target(samples), viewport, 9));
    }
    EXPECT_EQ(tally.wrong, 0U) << "of " << tally.covered << " samples; " << tally.first;
  }
}

// What the declared models say is needed: each change of one is seen.
TEST(TransformModels, EveryOtherModelIsFoundWrong) {
  const auto lavapipe = subject_or_failure("lavapipe");
  ASSERT_NE(lavapipe, nullptr);
  std::vector<Scene> scenes{window_tie_scene(*lavapipe, 1)};
  scenes.push_back(tie_scene(target(1), kViewports[1], 3));
  scenes.push_back(clip_scene(target(1), kViewports[3], {Homogeneous::positive, 2, 0.7F, 0}, 20'000, 4));
  std::vector<MaskBatch> found;
  for (const Scene& scene : scenes) found.push_back(drawn(*lavapipe, scene));
  const auto wrong = [&](const TransformModel& model) {
    std::size_t samples = 0;
    for (std::size_t i = 0; i < scenes.size(); ++i) samples += compared(found[i], model, scenes[i]).wrong;
    return samples;
  };
  EXPECT_EQ(wrong(lavapipe_model()), 0U);
  const auto changed = [](auto change) {
    TransformModel model = lavapipe_model();
    change(model);
    return model;
  };
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.multiply_add = MultiplyAdd::separate; })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.shift = HalfPixelShift::none; })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.shift = HalfPixelShift::within_viewport; })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.rules.rounding = SnapRounding::half_up; })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.rules.rounding = SnapRounding::truncate; })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.interpolation = Interpolation::crosswise; })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.depth = DepthRange::minus_w_to_w; })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { std::ranges::reverse(m.planes); })), 0U);
  EXPECT_GT(wrong(changed([](TransformModel& m) { m.shrink = 0.5F; })), 0U);
}

}  // namespace
}  // namespace edgecase::conformance
