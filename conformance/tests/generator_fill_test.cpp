// Scenes of a generator made in vectors, against the same ones made one by one.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "conformance/generators/generator.h"

namespace edgecase::conformance {
namespace {

void expect_filled(const Generator& generator, int bits = 8) {
  const SceneStream stream(generator, 3);
  Scene filled, expected;
  filled.setting = expected.setting = generator.setting;
  filled.rules.subpixel_bits = expected.rules.subpixel_bits = bits;
  std::uint64_t next = 0, begun = 0;
  // From any number on, lists of any length, behind others.
  for (const std::size_t more : {1u, 7u, 64u, 65u, 200u, 1u}) {
    const std::size_t wanted = filled.triangles.size() + more;
    next = stream.fill(next, wanted, filled, [&](std::uint64_t number, std::size_t first) {
      EXPECT_EQ(number, begun++) << generator.name;
      EXPECT_EQ(first, expected.triangles.size()) << generator.name;
      stream.append(number, expected);
    });
    EXPECT_EQ(next, begun) << generator.name;
    EXPECT_GE(filled.triangles.size(), wanted) << generator.name;
    EXPECT_EQ(filled.triangles, expected.triangles) << generator.name;
    EXPECT_EQ(filled.meshes, expected.meshes) << generator.name;
  }
}

TEST(FilledScenes, AreThoseAppendedOneByOne) {
  for (const Generator& generator : generators()) expect_filled(generator);
}

TEST(FilledScenes, AreTheSameWithEveryInstructionSet) {
  int in_vectors = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (const Generator& generator : generators()) {
      if (generator.append_each == nullptr) continue;
      ++in_vectors;
      for (const int bits : {1, 4, 8, 12}) expect_filled(generator, bits);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GT(in_vectors, 0);
}

}  // namespace
}  // namespace edgecase::conformance
