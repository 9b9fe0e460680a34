// OSMesa's llvmpipe must be exact; what softpipe does instead is told by softpipe_model_test.cpp.
#include <cstdlib>

#include "conformance/tests/driver_subject_checks.h"

namespace edgecase::conformance {
namespace {

class OsmesaLlvmpipe : public testing::Test {
 protected:
  void SetUp() override {
    subject_ = subject_or_failure("osmesa-llvmpipe");
    ASSERT_NE(subject_, nullptr);
  }
  std::unique_ptr<Subject> subject_;
};

TEST_F(OsmesaLlvmpipe, StatesTheDriversOwnLimits) {
  const SubjectInfo& info = subject_->info();
  EXPECT_THAT(info.device, testing::StartsWith("llvmpipe"));
  EXPECT_EQ(info.rules, Rules{});
  EXPECT_THAT(info.sample_counts, testing::ElementsAre(1, 4));
  EXPECT_EQ(info.max_target, 16384);
  EXPECT_EQ(info.max_coordinate, 8192);
}

TEST_F(OsmesaLlvmpipe, HandCheckedMasks) { expect_hand_checked_masks(*subject_); }
TEST_F(OsmesaLlvmpipe, RandomTrianglesOfOneSample) { expect_exact_random_triangles(*subject_, 1); }
TEST_F(OsmesaLlvmpipe, RandomTrianglesOfFourSamples) { expect_exact_random_triangles(*subject_, 4); }
TEST_F(OsmesaLlvmpipe, BatchesLargerThanTheBuffer) {
  expect_exact(*subject_, random_scene(square_setting(12), 60'000, -4, 16, 64, 4));
}

TEST(Osmesa, BothDriversLiveSideBySide) {
  setenv("GALLIUM_DRIVER", "softpipe", 1);  // the worker's own choice comes first
  const auto llvmpipe = subject_or_failure("osmesa-llvmpipe");
  const auto softpipe = subject_or_failure("osmesa-softpipe");
  unsetenv("GALLIUM_DRIVER");
  ASSERT_NE(llvmpipe, nullptr);
  ASSERT_NE(softpipe, nullptr);
  EXPECT_THAT(llvmpipe->info().device, testing::StartsWith("llvmpipe"));
  EXPECT_THAT(softpipe->info().device, testing::StartsWith("softpipe"));
  expect_hand_checked_masks(*llvmpipe);
  EXPECT_THAT(softpipe->info().sample_counts, testing::ElementsAre(1));
}

}  // namespace
}  // namespace edgecase::conformance
