// lavapipe through Vulkan, with the validation layer on: anything it says fails the draw.
#include <cstdlib>

#include "conformance/tests/driver_subject_checks.h"

namespace edgecase::conformance {
namespace {

// Its masks drawn into the memory that the processes share, which it takes, or copied there, as for those that do not.
class VulkanSubject : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    setenv("EDGECASE_VALIDATION", "1", 1);
    setenv("EDGECASE_COPY_MASKS", GetParam(), 1);
    subject_ = subject_or_failure("lavapipe");
    ASSERT_NE(subject_, nullptr);
  }
  void TearDown() override { unsetenv("EDGECASE_COPY_MASKS"); }
  std::unique_ptr<Subject> subject_;
};

TEST_P(VulkanSubject, StatesTheDriversOwnLimits) {
  const SubjectInfo& info = subject_->info();
  EXPECT_EQ(info.name, "lavapipe");
  EXPECT_THAT(info.device, testing::HasSubstr("llvmpipe"));
  EXPECT_EQ(info.rules, Rules{});
  EXPECT_THAT(info.sample_counts, testing::ElementsAre(1, 4));
  EXPECT_EQ(info.max_target, 16384);
  EXPECT_EQ(info.max_coordinate, 8192);
}

TEST_P(VulkanSubject, HandCheckedMasks) { expect_hand_checked_masks(*subject_); }
TEST_P(VulkanSubject, RandomTrianglesOfOneSample) { expect_exact_random_triangles(*subject_, 1); }
TEST_P(VulkanSubject, RandomTrianglesOfFourSamples) { expect_exact_random_triangles(*subject_, 4); }

// 20,000 masks of 1 KiB are ten buffers' worth; the parts must not overlap, and none may be left out.
TEST_P(VulkanSubject, BatchesLargerThanTheBuffer) {
  expect_exact(*subject_, random_scene(square_setting(12), 100'000, -4, 16, 64, 4));
  const Scene large = random_scene(square_setting(64), 20'000, 20, 24, 1, 5);
  expect_exact(*subject_, large);
}

TEST_P(VulkanSubject, AlternatingSettingsKeepNothingOfTheLastBatch) {
  for (unsigned round = 0; round < 3; ++round) {
    for (const int side : {40, 8, 24}) {
      expect_exact(*subject_, random_scene(square_setting(side), 50 + 100 * round, 0, side, 1, round));
      expect_exact(*subject_, random_scene(square_setting(side, 4), 70, 0, side, 1, round));
    }
  }
}

TEST_P(VulkanSubject, EmptyBatch) {
  EXPECT_EQ(drawn(*subject_, random_scene(square_setting(8), 0, 0, 8, 1, 0)).size(), 0U);
}

TEST_P(VulkanSubject, LargestTarget) {
  Scene scene;
  scene.setting = square_setting(16384);
  scene.triangles = {Triangle{{{8000, 8000}, {8192, 8000}, {8000, 8192}}}};
  const MaskBatch masks = drawn(*subject_, scene);
  ASSERT_EQ(masks.size(), 1U);
  const MaskLayout layout(scene.setting);
  std::size_t found = 0;
  for (const std::uint64_t word : masks.data()) found += static_cast<std::size_t>(std::popcount(word));
  // Rows 8000 + i, i from 0 to 191, cover the centres x + 1/2 < 192 - (i + 1/2); on the hypotenuse, a right edge, none.
  EXPECT_EQ(found, 191U * 192U / 2);
  EXPECT_TRUE(covered(masks[0], layout.bit(8000, 8000, 0)));
  EXPECT_TRUE(covered(masks[0], layout.bit(8190, 8000, 0)));
  EXPECT_FALSE(covered(masks[0], layout.bit(8191, 8000, 0)));
}

TEST_P(VulkanSubject, DriverSecondsGrowWithEachDraw) {
  const Scene scene = random_scene(square_setting(16), 500, 0, 16, 1, 6);
  EXPECT_EQ(subject_->driver_seconds(), 0);
  drawn(*subject_, scene);
  const double once = subject_->driver_seconds();
  EXPECT_GT(once, 0);
  drawn(*subject_, scene);
  EXPECT_GT(subject_->driver_seconds(), once);
}

TEST_P(VulkanSubject, RefusesWhatItCannotDoWithTheReason) {
  Scene scene = random_scene(square_setting(8), 3, 0, 8, 1, 7);
  EXPECT_EQ(subject_->refusal(scene), std::nullopt);

  scene.triangles[1][2] = {8192.5F, 0};
  EXPECT_EQ(subject_->refusal(scene), "triangle 1, vertex 2: x = 8192.5 lies beyond 8192 px");
  // Divided by 8192 this is subnormal.
  scene.triangles[1][2] = {0, 1e-38F};
  EXPECT_EQ(subject_->refusal(scene),
            "triangle 1, vertex 2: (0, 1e-38) does not pass the viewport transform unchanged");
  scene.triangles[1][2] = {0, 0};
  scene.setting.sample_locations = {{4, 4}};
  EXPECT_EQ(subject_->refusal(scene), "sample locations other than the standard ones");
  scene.setting = square_setting(8, 16);
  EXPECT_EQ(subject_->refusal(scene), "16 samples a pixel");
  scene.setting = square_setting(16384, 4);
  EXPECT_EQ(subject_->refusal(scene), std::nullopt) << "its mask fits the largest buffer exactly";
  scene.setting = square_setting(16385);
  EXPECT_EQ(subject_->refusal(scene), "target 16385x16385 exceeds 16384 pixels a side");
}

INSTANTIATE_TEST_SUITE_P(Masks, VulkanSubject, testing::Values("0", "1"), [](const auto& copied) {
  return std::string_view(copied.param) == "1" ? "Copied" : "InPlace";
});

// Shows that the layer of the other tests really is asked for.
TEST(VulkanValidation, MissingLayerIsAbsent) {
  setenv("EDGECASE_VALIDATION", "1", 1);
  setenv("VK_LAYER_PATH", "/nonexistent", 1);
  const auto made = make_subject("lavapipe");
  unsetenv("VK_LAYER_PATH");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::absent);
  EXPECT_THAT(made.error().message, testing::HasSubstr("VK_LAYER_KHRONOS_validation"));
  EXPECT_THAT(made.error().message, testing::HasSubstr("package vulkan-validationlayers"));
}

TEST(VulkanSelectionByName, TakesDevicesAndIcdFiles) {
  for (const char* name : {"vulkan:LLVMpipe", "vulkan:lvp_icd.x86_64.json"}) {
    const auto subject = subject_or_failure(name);
    ASSERT_NE(subject, nullptr);
    EXPECT_EQ(subject->info().name, name);
    expect_hand_checked_masks(*subject);
  }
}

TEST(VulkanSelectionByName, MissingDriverIsAbsent) {
  const auto device = make_subject("vulkan:Voodoo");
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::absent);
  EXPECT_THAT(device.error().message, testing::StartsWith("vulkan:Voodoo: no Vulkan 1.2 device is called \"Voodoo\""));

  const auto file = make_subject("vulkan:/nonexistent/icd.json");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::absent);
  EXPECT_EQ(file.error().message, "vulkan:/nonexistent/icd.json: no ICD file /nonexistent/icd.json");

  setenv("VK_DRIVER_FILES", "/nonexistent.json", 1);
  const auto none = make_subject("lavapipe");
  unsetenv("VK_DRIVER_FILES");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::absent);
  EXPECT_THAT(none.error().message, testing::HasSubstr("package mesa-vulkan-drivers"));
}

}  // namespace
}  // namespace edgecase::conformance
