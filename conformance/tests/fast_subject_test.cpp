// The fast path as a subject, for every instruction set, on every generator: against the scalar one, and a share of it
// against the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "conformance/generators/generator.h"
#include "conformance/oracle/oracle.h"
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
  /// `count` triangles of each generator, with `bits` subpixel bits.
  void expect_exact(std::size_t count, int bits, std::size_t oracle_share) const {
    const auto fast = make_edgecase_subject(GetParam());
    const auto scalar = make_edgecase_subject("scalar");
    MaskBatch expected, observed;
    for (const Generator& generator : generators()) {
      Scene scene;
      scene.setting = generator.setting;
      scene.rules.subpixel_bits = bits;
      for (std::uint64_t index = 0; scene.triangles.size() < count; ++index) append_scene(generator, 5, index, scene);
      ASSERT_EQ(fast->refusal(scene), std::nullopt);
      ASSERT_TRUE(fast->draw(scene, observed) && scalar->draw(scene, expected));
      std::vector<std::uint64_t> mask(MaskLayout(scene.setting).words());
      for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        ASSERT_TRUE(std::ranges::equal(observed[i], expected[i])) << generator.name << ", triangle " << i;
        if (i % oracle_share != 0) continue;
        oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], mask);
        ASSERT_TRUE(std::ranges::equal(observed[i], mask)) << generator.name << ", triangle " << i;
      }
    }
  }
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
