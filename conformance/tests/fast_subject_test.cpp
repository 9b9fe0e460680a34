// The fast path as a subject, for every instruction set, on every generator: against the scalar one, and a share of it
// against the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "conformance/generators/generator.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/grid.h"
#include "conformance/subjects/edgecase_subject.h"
#include "rasterizer/fast/fast.h"

namespace edgecase::conformance {
namespace {

std::vector<std::string> variants() {
  std::vector<std::string> names;
  for (const rasterizer::Isa isa : rasterizer::available_isas()) names.emplace_back(rasterizer::name_of(isa));
  return names;
}

class FastSubject : public testing::TestWithParam<std::string> {
 protected:
  /// At least `count` triangles of each generator, with `bits` subpixel bits.
  void expect_exact(std::size_t count, int bits, std::size_t oracle_share) {
    for (const Generator& generator : generators()) {
      Scene scene;
      scene.setting = generator.setting;
      scene.rules.subpixel_bits = bits;
      std::uint64_t index = 0;
      for (std::size_t done = 0; done < count; done += scene.triangles.size()) {
        constexpr std::size_t kAtOnce = 10'000;
        scene.triangles.clear();
        scene.meshes.clear();
        while (scene.triangles.size() < std::min(count, kAtOnce)) append_scene(generator, 5, index++, scene);
        ASSERT_NO_FATAL_FAILURE(expect_exact(scene, oracle_share)) << generator.name << ", scenes up to " << index;
      }
    }
  }

 private:
  void expect_exact(const Scene& scene, std::size_t oracle_share) {
    ASSERT_EQ(fast_->refusal(scene), std::nullopt);
    ASSERT_TRUE(fast_->draw(scene, observed_) && scalar_->draw(scene, expected_));
    ASSERT_NO_FATAL_FAILURE(expect_recognized(scene));
    std::vector<std::uint64_t> mask(MaskLayout(scene.setting).words());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      ASSERT_TRUE(std::ranges::equal(observed_[i], expected_[i])) << "triangle " << i;
      if (i % oracle_share != 0) continue;
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], mask);
      ASSERT_TRUE(std::ranges::equal(observed_[i], mask)) << "the oracle, triangle " << i;
    }
  }

  /// draws() tells expected_ from masks with one bit changed, whatever the way of snapping, where it says that it can.
  void expect_recognized(Scene scene) {
    const auto on_grid = [&](int bits) { return all_on_grid(scene.triangles, std::ldexp(1.0F, bits)); };
    const int bits = scene.rules.subpixel_bits;
    const bool answers = bits <= 8 && scene.setting.cull == CullMode::none && on_grid(bits) && on_grid(8);
    const auto answer = [&](bool right) { return answers ? std::optional(right) : std::nullopt; };
    for (const SnapRounding rounding : {SnapRounding::nearest_even, SnapRounding::truncate}) {
      scene.rules.rounding = rounding;
      ASSERT_EQ(fast_->draws(scene, MaskBatchView(expected_)), answer(true));
      ASSERT_EQ(draws_short_rows(scene), answer(true));
    }
    for (const std::size_t word : {std::size_t{0}, expected_.data().size() / 2, expected_.data().size() - 1}) {
      expected_.data()[word] ^= 1;
      ASSERT_EQ(fast_->draws(scene, MaskBatchView(expected_)), answer(false)) << "word " << word;
      ASSERT_EQ(draws_short_rows(scene), answer(false)) << "word " << word;
      expected_.data()[word] ^= 1;
    }
  }

  /// The same of expected_ as a driver would have written it.
  std::optional<bool> draws_short_rows(const Scene& scene) {
    const MaskLayout layout(scene.setting);
    if (!layout.has_short_rows()) return fast_->draws(scene, MaskBatchView(expected_));
    const std::vector<std::uint32_t> rows(expected_.data().begin(), expected_.data().end());
    return fast_->draws(scene, DrawnMasks(layout, rows));
  }

  std::unique_ptr<Subject> fast_ = make_edgecase_subject(GetParam());
  std::unique_ptr<Subject> scalar_ = make_edgecase_subject("scalar");
  MaskBatch expected_, observed_;
};

TEST_P(FastSubject, IsExactOnEveryGenerator) { expect_exact(5'000, 8, 20); }
TEST_P(FastSubject, IsExactOnCoarserGrids) {
  for (const int bits : {1, 4, 7}) expect_exact(500, bits, 20);
}
// A finer grid is not its own: the scalar path stands in.
TEST_P(FastSubject, IsExactOnAFinerGrid) { expect_exact(200, 12, 20); }

INSTANTIATE_TEST_SUITE_P(Isas, FastSubject, testing::ValuesIn(variants()),
                         [](const auto& variant) { return variant.param; });

class LongFastSubject : public FastSubject {};
TEST_P(LongFastSubject, IsExactOnAMillionTrianglesOfEveryGenerator) { expect_exact(1'000'000, 8, 100); }
INSTANTIATE_TEST_SUITE_P(LongIsas, LongFastSubject, testing::ValuesIn(variants()),
                         [](const auto& variant) { return variant.param; });

// A processor with AVX-512 on which only SSE4 ran would show green above.
TEST(FastSubjects, EveryInstructionSetOfThisMachineIsThere) {
  EXPECT_TRUE(make_edgecase_subject("portable"));
#if defined(__x86_64__)
  __builtin_cpu_init();
  EXPECT_EQ(make_edgecase_subject("sse4") != nullptr, __builtin_cpu_supports("sse4.2") != 0);
  EXPECT_EQ(make_edgecase_subject("avx2") != nullptr, __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"));
  EXPECT_EQ(make_edgecase_subject("avx3") != nullptr,
            __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"));
#endif
  EXPECT_EQ(rasterizer::FastRasterizer().isa(), rasterizer::available_isas().back());
}

}  // namespace
}  // namespace edgecase::conformance
