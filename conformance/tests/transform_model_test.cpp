// The models alone, by numbers that can be worked out by hand; clip_model_test.cpp holds them against the drivers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "conformance/models/clip_model.h"
#include "conformance/models/window_scene.h"

namespace edgecase::conformance {
namespace {

using testing::ElementsAre;

Setting setting_of(int width, int height) {
  Setting setting;
  setting.target = {width, height};
  return setting;
}

Setting four_samples(int width, int height) {
  Setting setting = setting_of(width, height);
  setting.sample_locations = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
  return setting;
}

// 1/512 is half way between two points of the grid, and a little more is nearer to the second. Taking half a pixel off
// first leaves 24 bits below 1/2, too few for the little.
TEST(TransformModel, HalfAPixelTakenOffFirstLosesALittle) {
  TransformModel model = lavapipe_model();
  const Position just_above{0x1p-9F + 0x1p-31F, 1};
  model.shift = HalfPixelShift::none;
  EXPECT_EQ(snapped(model, setting_of(8, 8), just_above)->x, 0x1p-8F);
  model.shift = HalfPixelShift::before_scaling;
  EXPECT_EQ(snapped(model, setting_of(8, 8), just_above)->x, 0);
  EXPECT_EQ(snapped(model, four_samples(8, 8), just_above)->x, 0x1p-8F) << "with samples llvmpipe takes nothing off";
  model.shift = HalfPixelShift::within_viewport;
  EXPECT_EQ(snapped(model, setting_of(8, 8), just_above)->x, 0);
}

// (1 + 2^-12)^2 has a bit at 2^-24, which the rounded product loses; what is added brings the sum to 1/512, a tie, or
// to 2^-24 above it.
TEST(TransformModel, FusedAndSeparateDifferWhereTheProductIsInexact) {
  const AxisTransform axis{1 + 0x1p-12F, -1 - 0x1p-11F + 0x1p-9F};
  TransformModel model = lavapipe_model();
  model.shift = HalfPixelShift::none;
  EXPECT_EQ(transformed(model, axis, MultiplyAdd::separate, false, 1 + 0x1p-12F, 1)->snapped, 0);
  EXPECT_EQ(transformed(model, axis, MultiplyAdd::fused, false, 1 + 0x1p-12F, 1)->snapped, 0x1p-8F);
}

TEST(TransformModel, RoundingRulesDifferOnTies) {
  TransformModel model = lavapipe_model();
  model.shift = HalfPixelShift::none;
  const auto at = [&](SnapRounding rounding, float x) {
    model.rules.rounding = rounding;
    return snapped(model, setting_of(8, 8), {x, 0})->x * 256;
  };
  constexpr float kTie = 2.5F / 256;
  EXPECT_EQ(at(SnapRounding::nearest_even, kTie), 2);
  EXPECT_EQ(at(SnapRounding::half_up, kTie), 3);
  EXPECT_EQ(at(SnapRounding::half_up, -kTie), -2);
  EXPECT_EQ(at(SnapRounding::half_away, -kTie), -3);
  EXPECT_EQ(at(SnapRounding::truncate, -kTie), -2);
}

TEST(TransformModel, IsFoundByNameAndByDevice) {
  EXPECT_EQ(find_transform_model("osmesa-llvmpipe", ""), &osmesa_llvmpipe_model());
  EXPECT_EQ(find_transform_model("vulkan:x.json", "llvmpipe (LLVM 15.0.6)"), &lavapipe_model());
  EXPECT_EQ(find_transform_model("vulkan:Swift", "SwiftShader Device (Subzero)"), &swiftshader_model());
  EXPECT_EQ(find_transform_model("vulkan:x", "another"), nullptr);
  EXPECT_EQ(find_transform_model("osmesa-softpipe", "llvmpipe"), nullptr);
}

std::vector<Triangle> windows(const TransformModel& model, const ClipTriangle& triangle) {
  std::vector<WindowTriangle> parts;
  EXPECT_TRUE(append_window_triangles(model, setting_of(8, 8), {0, 0, 8, 8}, triangle, parts));
  std::vector<Triangle> out;
  for (const WindowTriangle& part : parts) out.push_back(part.triangle);
  return out;
}

// From the middle of the viewport to twice its right end and back: the part beyond x = w is cut off in the middle.
TEST(ClipModel, CutsAtTheBorderAndFansFromTheFirstVertex) {
  const ClipTriangle triangle{{{0, 0, 0, 1}, {2, 0, 0, 1}, {0, 1, 0, 1}}};
  for (const TransformModel* model : {&lavapipe_model(), &osmesa_llvmpipe_model(), &swiftshader_model()}) {
    EXPECT_THAT(windows(*model, triangle),
                ElementsAre(Triangle{{{4, 4}, {8, 4}, {8, 6}}}, Triangle{{{4, 4}, {8, 6}, {4, 8}}}))
        << model->name;
  }
  // In the guard band nothing is cut.
  EXPECT_THAT(windows(lavapipe_bgra8_model(), triangle), ElementsAre(Triangle{{{4, 4}, {12, 4}, {4, 8}}}));
}

TEST(ClipModel, OutsideOfOnePlaneNothingIsLeft) {
  EXPECT_TRUE(windows(lavapipe_model(), {{{2, 0, 0, 1}, {3, 0, 0, 1}, {2, 9, 0, 1}}}).empty());
  // Nor in the guard band.
  EXPECT_TRUE(windows(lavapipe_bgra8_model(), {{{1.25F, 0, 0, 1}, {1.5F, 0, 0, 1}, {1.25F, 0.5F, 0, 1}}}).empty());
}

// z = -1/2 lies behind Vulkan's near plane and before OpenGL's.
TEST(ClipModel, TheNearPlaneLiesWhereTheInterfaceHasIt) {
  const ClipTriangle triangle{{{0, 0, -0.5F, 1}, {1, 0, -0.5F, 1}, {0, 1, -0.5F, 1}}};
  EXPECT_TRUE(windows(lavapipe_model(), triangle).empty());
  EXPECT_THAT(windows(osmesa_llvmpipe_model(), triangle), ElementsAre(Triangle{{{4, 4}, {8, 4}, {4, 8}}}));
}

TEST(ClipModel, SaysWhereItDoesNotReach) {
  std::vector<WindowTriangle> out;
  const auto predicted = [&](const ClipTriangle& triangle) {
    return append_window_triangles(lavapipe_model(), setting_of(8, 8), {0, 0, 8, 8}, triangle, out).has_value();
  };
  const ClipTriangle fine{{{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}}};
  EXPECT_TRUE(predicted(fine));
  out.clear();
  for (const float bad : {0x1p41F, 0x1p-41F, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    ClipTriangle triangle = fine;
    triangle[1].y = bad;
    EXPECT_FALSE(predicted(triangle)) << bad;
  }
  EXPECT_FALSE(predicted({{{0, 0, 0, 0}, {1, 0, 0, 1}, {0, 1, 0, 1}}})) << "0 / 0";
  EXPECT_TRUE(out.empty());
}

std::vector<std::string> rows(const DrawnRegion& region, const Setting& setting) {
  const MaskLayout layout(setting);
  std::vector<std::uint64_t> mask(layout.words());
  const Rect& reach = region.reach().all();
  for (int y = reach.y; y < reach.y + reach.height; ++y) {
    for (int x = reach.x; x < reach.x + reach.width; ++x) {
      for (int s = 0; s < layout.samples; ++s) cover(mask, layout.bit(x, y, s));
    }
  }
  region.filter(mask);
  std::vector<std::string> result;
  for (int y = 0; y < setting.target.height; ++y) {
    std::string row;
    for (int x = 0; x < setting.target.width; ++x) {
      for (int s = 0; s < layout.samples; ++s) row += covered(mask, layout.bit(x, y, s)) ? '#' : '.';
      row += ' ';
    }
    result.push_back(row);
  }
  return result;
}

TEST(DrawnRegion, MultisampledScissorOfLlvmpipeLetsHalfAPixelThrough) {
  Setting setting = four_samples(4, 3);
  setting.scissor = Rect{2, 1, 1, 9};
  EXPECT_THAT(rows(DrawnRegion(swiftshader_model(), setting, nullptr), setting),
              ElementsAre(".... .... .... .... ", ".... .... #### .... ", ".... .... #### .... "));
  const DrawnRegion region(lavapipe_model(), setting, nullptr);
  EXPECT_THAT(rows(region, setting),
              ElementsAre(".... ...# ..## .... ", ".... .#.# #### .... ", ".... .#.# #### .... "));
  EXPECT_FALSE(region.reach().meets({{{0, 1}, {2, 1}, {0, 3}}})) << "it lies in the pixels left of the scissor";
  EXPECT_TRUE(region.reach().meets({{{0, 1}, {2.25F, 1}, {0, 3}}}));
}

TEST(DrawnRegion, ViewportsHideWhatTheirRoundedEndsLeaveOut) {
  const Setting setting = setting_of(8, 8);
  const Viewport viewport{1.501F, 1.499F, 4.0F, 4.003F};  // to 5.501 and 5.502
  EXPECT_EQ(ScissorReach(lavapipe_model(), setting, &viewport).all(), (Rect{2, 1, 4, 5}));
  EXPECT_EQ(ScissorReach(osmesa_llvmpipe_model(), setting, &viewport).all(), (Rect{0, 0, 8, 8}));
  const Viewport flipped{0.5F, 5.5F, 4, -4};
  EXPECT_EQ(ScissorReach(lavapipe_model(), setting, &flipped).all(), (Rect{0, 1, 4, 4}));
}

// A sliver whose turned-over part takes away a sample that the other part adds.
TEST(WindowScene, OutlinesSubtractWhatIsTurnedOver) {
  Scene scene;
  scene.setting = setting_of(64, 1);
  WindowScene window = window_scene(swiftshader_model(), scene);
  window.first = {0, 2};
  window.takes_away = {false, true};
  MaskBatch parts;
  parts.reset(MaskLayout(scene.setting), 2);
  parts[0][0] = 0b1110;
  parts[1][0] = 0b1011;
  MaskBatch whole;
  unite(window, parts, whole);
  EXPECT_EQ(whole[0][0], 0b0100U);
  window.takes_away = {false, false};
  unite(window, parts, whole);
  EXPECT_EQ(whole[0][0], 0b1111U);
}

TEST(WindowScene, CullsByTheSnappedVertices) {
  Scene scene;
  scene.setting = setting_of(8, 8);
  scene.triangles = {Triangle{{{0, 0}, {8, 0}, {0, 8}}}, Triangle{{{0, 0}, {0, 8}, {8, 0}}}};  // clockwise, then not
  scene.setting.cull = CullMode::back;
  EXPECT_THAT(window_scene(lavapipe_model(), scene).first, ElementsAre(0, 1, 1));
  scene.setting.front_face = FrontFace::counter_clockwise;
  EXPECT_THAT(window_scene(lavapipe_model(), scene).first, ElementsAre(0, 0, 1));
  scene.setting.cull = CullMode::front;
  EXPECT_THAT(window_scene(lavapipe_model(), scene).first, ElementsAre(0, 1, 1));
}

// The third vertex, between the others, lies above the line between them: 5/8 of a subpixel down where the line is at
// 7/8. Snapped, it is at 1 and the line at 1/2.
TEST(WindowScene, CullsByTheVerticesBeforeTheSnapBesideWhatIsClipped) {
  constexpr float kSubpixel = 0x1p-8F;
  const auto at = [](float x, float y) { return ClipPosition{(x - 4) / 4, (y - 4) / 4, 0, 1}; };
  const ClipTriangle turned{
      {at(1, 1 + 0.375F * kSubpixel), at(3, 1 + 1.375F * kSubpixel), at(2, 1 + 0.625F * kSubpixel)}};
  const ClipTriangle beyond{{at(4, 4), at(4, 9), at(3, 9)}};
  Scene scene;
  scene.setting = setting_of(8, 8);
  scene.setting.cull = CullMode::back;
  scene.clip = ClipGeometry{{0, 0, 8, 8}, {turned, turned, turned}};
  TransformModel model = lavapipe_model();
  model.also_culls = 2;
  EXPECT_THAT(window_scene(model, scene).first, ElementsAre(0, 1, 2, 3));
  scene.clip->triangles.push_back(beyond);
  EXPECT_THAT(window_scene(model, scene).first, ElementsAre(0, 1, 2, 2, 3)) << "the third is drawn with the fourth";
  model.also_culls = kWholeDraw;
  EXPECT_THAT(window_scene(model, scene).first, ElementsAre(0, 0, 0, 0, 1));
  model.also_culls = 1;
  EXPECT_THAT(window_scene(model, scene).first, ElementsAre(0, 1, 2, 3, 4));
  scene.setting.cull = CullMode::none;
  model.also_culls = kWholeDraw;
  EXPECT_THAT(window_scene(model, scene).first, ElementsAre(0, 1, 2, 3, 4));
}

}  // namespace
}  // namespace edgecase::conformance
