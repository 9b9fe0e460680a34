// Every setting at once, at random: targets of any size, scissors, samples, culling, fronts, viewports; triangles of
// any size on grids of any fineness, and across the planes of the view volume. The generators hold one setting each;
// what breaks where two of them meet is found here. Of each driver every sample is explained.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "conformance/generators/random.h"
#include "conformance/runner/clipper_probe.h"
#include "conformance/runner/judge.h"
#include "conformance/runner/known_deviations.h"
#include "conformance/runner/run.h"
#include "conformance/runner/subject_model.h"
#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

constexpr std::size_t kTriangles = 400;

int between(Random& random, int low, int high) { return static_cast<int>(random.between(low, high)); }

Setting random_setting(Random& random) {
  Setting setting;
  setting.target = {between(random, 1, 300), between(random, 1, 200)};
  const auto locations = standard_sample_locations(random.one_in(3) ? 4 : 1);
  setting.sample_locations.assign(locations.begin(), locations.end());
  if (random.one_in(2)) {
    setting.scissor =
        Rect{between(random, -20, 250), between(random, -20, 150), between(random, 0, 300), between(random, 0, 200)};
  }
  setting.cull = static_cast<CullMode>(random.between(0, 2));
  setting.front_face = static_cast<FrontFace>(random.between(0, 1));
  return setting;
}

// Of vertices up to `reach` outside of the target: anywhere, near each other, with edges along the axes, or flat but
// for a step of the grid.
class Triangles {
 public:
  Triangles(const Extent& target, Random& random)
      : target_(target), random_(random), reach_(1 << random.between(0, 12)), bits_(between(random, 0, 8)) {}

  Triangle operator()() {
    Triangle t{anywhere(), anywhere(), anywhere()};
    switch (random_.between(0, 3)) {
      case 1:
        for (Position& p : t) p = {near(t[0].x), near(t[0].y)};
        break;
      case 2:
        t[1].y = t[0].y;
        if (random_.one_in(2)) t[2].x = t[random_.one_in(2) ? 0 : 1].x;
        break;
      case 3:
        t[2] = {between_ends(t[0].x, t[1].x), between_ends(t[0].y, t[1].y)};
        break;
      default:
        break;
    }
    return t;
  }

 private:
  float on_grid(std::int64_t low, std::int64_t high) {
    return std::ldexp(static_cast<float>(random_.between(low << bits_, high << bits_)), -bits_);
  }
  Position anywhere() { return {on_grid(-reach_, target_.width + reach_), on_grid(-reach_, target_.height + reach_)}; }
  float near(float middle) {
    const std::int64_t size = std::int64_t{1} << random_.between(0, 7);
    return middle + on_grid(-size, size);
  }
  // The grid's unit in sixteen, so that the quotient has few bits.
  float between_ends(float from, float to) {
    const float along = static_cast<float>(random_.between(0, 16)) / 16;
    const float there = std::ldexp(std::round(std::ldexp(from + along * (to - from), bits_)), -bits_);
    return there + std::ldexp(static_cast<float>(random_.between(-1, 1)), -bits_);
  }

  Extent target_;
  Random& random_;
  std::int64_t reach_;
  int bits_;
};

Viewport random_viewport(const Extent& target, Random& random) {
  const auto part = [&](int low, int high) { return static_cast<float>(random.between(low * 256, high * 256)) / 256; };
  const float height = part(1, 2 * target.height);
  return {part(-target.width, target.width), part(-target.height, target.height), part(1, 2 * target.width),
          random.one_in(3) ? -height : height};
}

Scene random_scene(const Rules& window_rules, Random& random) {
  Scene scene;
  scene.setting = random_setting(random);
  scene.rules = window_rules;
  if (random.one_in(2)) {
    scene.clip = ClipGeometry{random_viewport(scene.setting.target, random), {}};
    for (std::size_t i = 0; i < kTriangles; ++i) scene.clip->triangles.push_back(across_any(random));
  } else {
    Triangles triangle(scene.setting.target, random);
    for (std::size_t i = 0; i < kTriangles; ++i) scene.triangles.push_back(triangle());
  }
  return scene;
}

class RandomSettings : public testing::TestWithParam<const char*> {
 protected:
  void expect_explained(std::uint64_t first, std::uint64_t scenes) {
    auto subject = make_subject(GetParam());
    if (!subject && subject.error().kind == ErrorKind::absent && std::string(GetParam()) == "swiftshader") {
      GTEST_SKIP() << subject.error().message;
    }
    ASSERT_TRUE(subject) << subject.error().message;
    const auto known =
        load_known_deviations(std::filesystem::path(EDGECASE_SOURCE_DIR) / "conformance/known_deviations.json").value();
    const auto model = SubjectModel::find(**subject, true);
    ASSERT_TRUE(model) << model.error().message;
    ASSERT_TRUE(model->clipper()) << model->unjudged();
    auto reference = reference_for(GetParam(), &*model);
    ASSERT_TRUE(reference) << reference.error().message;
    Judge judge(**subject, *reference, find_known_deviation(known, GetParam(), (*subject)->info().device));
    Outcome outcome;
    std::size_t drawn = 0;
    for (std::uint64_t i = first; i < first + scenes; ++i) {
      Random random = Random::stream(1, "random_settings", i);
      Batch batch;
      batch.scene = random_scene(Rules{}, random);
      batch.scene.rules = model->rules(batch.scene.setting.samples());
      batch.parts = {{i, 0}};
      if (judge.refusal(batch.scene)) continue;
      const auto judged = judge.judge(batch, i * kTriangles, outcome);
      ASSERT_TRUE(judged) << "scene " << i << ": " << judged.error().message;
      ASSERT_EQ(outcome.unexplained, 0U) << "scene " << i << ": " << describe(outcome.findings.back().wrong);
      ++drawn;
    }
    EXPECT_GT(drawn * 4, scenes);
    EXPECT_GT(outcome.triangles.samples_compared, scenes * kTriangles * 100);
    EXPECT_LT(outcome.unpredicted * 100, outcome.triangles.triangles);
    RecordProperty("samples", std::to_string(outcome.triangles.samples_compared));
  }
};

TEST_P(RandomSettings, EverySampleIsExplained) { expect_explained(0, 40); }

// Clipped slivers culled by their area in binary32, whose vertices OpenGL's llvmpipe has in another order, and slivers
// beside them that nothing is cut off; and a viewport that ends left of the target, where guard bands can be seen.
TEST_P(RandomSettings, ScenesThatOnceWereNot) {
  for (const std::uint64_t scene : {1156, 1408, 2588}) {
    expect_explained(scene, 1);
    if (HasFatalFailure() || IsSkipped()) return;
  }
}

using LongRandomSettings = RandomSettings;
TEST_P(LongRandomSettings, EverySampleIsExplained) { expect_explained(40, 3000); }

const auto kDrivers = testing::Values("lavapipe", "lavapipe:bgra8", "osmesa-llvmpipe", "swiftshader");
std::string alphanumeric(const testing::TestParamInfo<const char*>& subject) {
  std::string name = subject.param;
  std::erase_if(name, [](char c) { return c == ':' || c == '-'; });
  return name;
}
INSTANTIATE_TEST_SUITE_P(Drivers, RandomSettings, kDrivers, alphanumeric);
INSTANTIATE_TEST_SUITE_P(LongDrivers, LongRandomSettings, kDrivers, alphanumeric);

}  // namespace
}  // namespace edgecase::conformance
