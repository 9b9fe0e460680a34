#include "conformance/scene/mask.h"

#include <gtest/gtest.h>

namespace edgecase::conformance {
namespace {

TEST(MaskLayout, RowsArePaddedToWholeWords) {
  Setting setting;
  setting.target = {65, 3};
  const MaskLayout layout(setting);
  EXPECT_EQ(layout.row_words(), 2u);
  EXPECT_EQ(layout.words(), 6u);
  EXPECT_EQ(layout.sample_count(), 195u);
  EXPECT_EQ(layout.bit(64, 2, 0), 2u * 128 + 64);
}

TEST(MaskLayout, SamplesOfAPixelAreNeighbours) {
  Setting setting;
  setting.target = {16, 1};
  setting.sample_locations.assign(8, SampleLocation{});
  const MaskLayout layout(setting);
  EXPECT_EQ(layout.row_words(), 2u);
  EXPECT_EQ(layout.bit(8, 0, 3), 67u);
}

TEST(MaskBatch, MasksDoNotOverlap) {
  Setting setting;
  setting.target = {10, 2};
  MaskBatch batch;
  batch.reset(MaskLayout(setting), 3);
  for (auto& word : batch.data()) word = 0;
  cover(batch[1], MaskLayout(setting).bit(9, 1, 0));
  EXPECT_TRUE(covered(batch[1], 64 + 9));
  EXPECT_FALSE(covered(batch[0], 64 + 9));
  EXPECT_FALSE(covered(batch[2], 64 + 9));
}

TEST(CoverSpan, CoversItsBitsAndNoOthers) {
  for (std::size_t begin = 0; begin <= 192; ++begin) {
    for (std::size_t end = 0; end <= 192; ++end) {
      std::vector<std::uint64_t> mask{0, std::uint64_t{1} << 40, 0};
      std::vector<std::uint64_t> one_by_one = mask;
      cover_span(mask, begin, end);
      for (std::size_t bit = begin; bit < end; ++bit) cover(one_by_one, bit);
      ASSERT_EQ(mask, one_by_one) << begin << " to " << end;
    }
  }
}

}  // namespace
}  // namespace edgecase::conformance
