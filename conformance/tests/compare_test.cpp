#include "conformance/compare/compare.h"

#include <gtest/gtest.h>

#include <random>

namespace edgecase::conformance {
namespace {

Setting setting(int width, int height, int samples) {
  return {{width, height}, std::vector<SampleLocation>(static_cast<std::size_t>(samples))};
}

MaskBatch empty_masks(const MaskLayout& layout, std::size_t count) {
  MaskBatch masks;
  masks.reset(layout, count);
  std::fill(masks.data().begin(), masks.data().end(), 0);
  return masks;
}

TEST(Compare, CountsEqualMasksAsCompared) {
  const MaskLayout layout(setting(20, 10, 4));
  MaskBatch masks = empty_masks(layout, 3);
  cover(masks[1], layout.bit(4, 5, 2));
  Comparison total;
  compare_masks(layout, masks.data(), {}, masks.data(), 0, total);
  EXPECT_TRUE(total.all_right());
  EXPECT_EQ(total.triangles, 3u);
  EXPECT_EQ(total.samples_compared, 3u * 20 * 10 * 4);
  EXPECT_FALSE(total.first);
}

TEST(Compare, NamesTheFirstWrongSampleAcrossBatches) {
  const MaskLayout layout(setting(20, 10, 4));
  const MaskBatch must = empty_masks(layout, 2);
  MaskBatch expected = must;
  MaskBatch observed = must;
  cover(observed[1], layout.bit(19, 9, 3));
  cover(expected[1], layout.bit(17, 9, 1));

  Comparison total;
  compare_masks(layout, must.data(), {}, must.data(), 100, total);
  compare_masks(layout, expected.data(), {}, observed.data(), 102, total);
  compare_masks(layout, observed.data(), {}, must.data(), 104, total);
  EXPECT_EQ(total.triangles, 6u);
  EXPECT_EQ(total.missing, 2u);
  EXPECT_EQ(total.unexpected, 1u);
  EXPECT_EQ(total.wrong_triangles, 2u);
  ASSERT_TRUE(total.first);
  EXPECT_EQ(*total.first, (WrongSample{WrongSample::Kind::missing, 103, 17, 9, 1}));
  EXPECT_EQ(describe(*total.first), "missing: pixel (17, 9), sample 1, triangle 103");
}

TEST(Compare, NamesTheFirstWrongSampleOfEachWrongTriangle) {
  const MaskLayout layout(setting(20, 10, 4));
  const MaskBatch must = empty_masks(layout, 4);
  MaskBatch observed = must;
  cover(observed[1], layout.bit(3, 4, 0));
  cover(observed[1], layout.bit(2, 4, 1));
  cover(observed[3], layout.bit(0, 0, 2));
  observed[2][1] = std::uint64_t{1} << 63;  // padding
  Comparison total;
  std::vector<WrongSample> firsts;
  compare_masks(layout, must.data(), {}, observed.data(), 10, total, &firsts);
  ASSERT_EQ(firsts.size(), 2u);
  EXPECT_EQ(firsts[0], (WrongSample{WrongSample::Kind::unexpected, 11, 2, 4, 1}));
  EXPECT_EQ(firsts[1], (WrongSample{WrongSample::Kind::unexpected, 13, 0, 0, 2}));
}

TEST(Compare, LeavesOpenSamplesOut) {
  const MaskLayout layout(setting(3, 2, 1));
  MaskBatch must = empty_masks(layout, 2);
  MaskBatch may = must;
  MaskBatch observed = must;
  cover(may[0], layout.bit(0, 0, 0));
  cover(may[0], layout.bit(1, 0, 0));
  cover(observed[0], layout.bit(1, 0, 0));
  // `must` wins over `may`: this one is not open.
  cover(may[1], layout.bit(2, 1, 0));
  cover(must[1], layout.bit(2, 1, 0));

  Comparison total;
  compare_masks(layout, must.data(), may.data(), observed.data(), 0, total);
  EXPECT_EQ(total.samples_compared, 2u * 6 - 2);
  EXPECT_EQ(total.missing, 1u);
  EXPECT_EQ(total.unexpected, 0u);
  EXPECT_EQ(total.first->triangle, 1u);

  Comparison equal;
  compare_masks(layout, must.data(), may.data(), must.data(), 0, equal);
  EXPECT_EQ(equal.samples_compared, 2u * 6 - 2);
  EXPECT_TRUE(equal.all_right());
}

TEST(Compare, IgnoresPadding) {
  const MaskLayout layout(setting(3, 2, 1));
  const MaskBatch must = empty_masks(layout, 1);
  MaskBatch observed = must;
  observed.data()[0] = ~std::uint64_t{7};
  Comparison total;
  compare_masks(layout, must.data(), {}, observed.data(), 0, total);
  EXPECT_TRUE(total.all_right());
  EXPECT_EQ(total.wrong_triangles, 0u);
}

TEST(Compare, AddKeepsTheFirst) {
  Comparison a;
  Comparison b;
  b.missing = 2;
  b.doubled = 1;
  b.triangles = 5;
  b.first = WrongSample{WrongSample::Kind::missing, 1, 2, 3, 0};
  a.add(b);
  Comparison c = b;
  c.first->triangle = 9;
  a.add(c);
  EXPECT_EQ(a.triangles, 10u);
  EXPECT_EQ(a.wrong_samples(), 6u);
  EXPECT_EQ(a.first->triangle, 1u);
}

// The word-wise comparison against the definition, sample by sample.
TEST(Compare, AgreesWithTheDefinition) {
  std::mt19937_64 random(7);
  for (const auto& [width, height, samples] : {std::tuple{5, 7, 1}, {64, 2, 1}, {33, 3, 2}, {7, 5, 16}, {9, 3, 3}}) {
    const MaskLayout layout(setting(width, height, samples));
    MaskBatch must = empty_masks(layout, 8);
    MaskBatch may = must;
    MaskBatch observed = must;
    for (MaskBatch* masks : {&must, &may, &observed}) {
      for (std::uint64_t& word : masks->data()) word = random() & random() & random();
    }
    Comparison expected;
    for (std::size_t i = 0; i < must.size(); ++i) {
      ++expected.triangles;
      bool wrong = false;
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          for (int s = 0; s < samples; ++s) {
            const std::size_t bit = layout.bit(x, y, s);
            const bool should = covered(must[i], bit);
            const bool is = covered(observed[i], bit);
            const bool open = !should && covered(may[i], bit);
            if (open) continue;
            ++expected.samples_compared;
            if (should == is) continue;
            ++(should ? expected.missing : expected.unexpected);
            wrong = true;
            const auto kind = should ? WrongSample::Kind::missing : WrongSample::Kind::unexpected;
            if (!expected.first) expected.first = WrongSample{kind, i, x, y, s};
          }
        }
      }
      if (wrong) ++expected.wrong_triangles;
    }
    Comparison actual;
    compare_masks(layout, must.data(), may.data(), observed.data(), 0, actual);
    EXPECT_EQ(actual.triangles, expected.triangles);
    EXPECT_EQ(actual.samples_compared, expected.samples_compared);
    EXPECT_EQ(actual.missing, expected.missing);
    EXPECT_EQ(actual.unexpected, expected.unexpected);
    EXPECT_EQ(actual.wrong_triangles, expected.wrong_triangles);
    EXPECT_EQ(actual.first, expected.first);
  }
}

}  // namespace
}  // namespace edgecase::conformance
