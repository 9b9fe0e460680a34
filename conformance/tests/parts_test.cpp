#include "rasterizer/threads/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace edgecase::rasterizer {
namespace {

std::vector<std::size_t> sizes(const Parts& parts) {
  std::vector<std::size_t> sizes(parts.count());
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = parts.begin(i + 1) - parts.begin(i);
  return sizes;
}

using Sizes = std::vector<std::size_t>;

TEST(Parts, EvenOnesDifferByAChunk) {
  EXPECT_EQ(sizes(Parts::even(12, 4)), (Sizes{3, 3, 3, 3}));
  EXPECT_EQ(sizes(Parts::even(3, 5)), (Sizes{1, 0, 1, 0, 1}));
  EXPECT_DOUBLE_EQ(Parts::even(12, 4).work_before(3), 0.75);
}

TEST(Parts, BatchesTakeHalfOfWhatIsLeft) {
  const Parts parts = Parts::falling(64, 2, std::array{1.0});
  EXPECT_EQ(sizes(parts), (Sizes{16, 16, 8, 8, 4, 4, 2, 2, 1, 1, 1, 1}));
  EXPECT_DOUBLE_EQ(parts.work_before(0), 0);
  EXPECT_DOUBLE_EQ(parts.work_before(3), 0.625);
  EXPECT_DOUBLE_EQ(parts.work_before(parts.count()), 1);
}

TEST(Parts, FewChunksAreEachAPart) {
  EXPECT_EQ(sizes(Parts::falling(1, 8, std::array{1.0})), (Sizes{1}));
  EXPECT_EQ(sizes(Parts::falling(5, 8, std::array{1.0})), (Sizes{1, 1, 1, 1, 1}));
}

TEST(Parts, SizesAreOfWork) {
  // The first quarter of the list is four times as much work as all the rest.
  const Parts parts = Parts::falling(400, 2, std::array{12.0, 1.0, 1.0, 1.0});
  EXPECT_EQ(parts.begin(1), 31u);   // a quarter of all work, 15 / 4, is 5/16 of the first hundred
  EXPECT_EQ(parts.begin(2), 63u);   // half of it
  EXPECT_EQ(parts.begin(3), 78u);   // five eighths
  EXPECT_EQ(parts.begin(4), 94u);   // three quarters
  EXPECT_EQ(parts.begin(5), 119u);  // 13/16: 3/16 of the second hundred
}

TEST(Parts, EveryChunkIsInOnePart) {
  for (const std::size_t chunks : {1u, 2u, 3u, 17u, 256u, 1'000u, 8'191u}) {
    for (const std::size_t threads : {1u, 2u, 3u, 64u}) {
      for (const auto& work : {std::vector{1.0}, std::vector{0.0, 0.0, 1.0}, std::vector{1.0, 0.0, 0.0},
                               std::vector{1e-9, 1.0, 1e9, 0.0, 3.0}}) {
        const Parts parts = Parts::falling(chunks, threads, work);
        EXPECT_EQ(parts.chunks(), chunks);
        EXPECT_EQ(parts.begin(0), 0u);
        EXPECT_EQ(parts.begin(parts.count()), chunks);
        for (std::size_t i = 0; i < parts.count(); ++i) {
          ASSERT_LE(parts.begin(i), parts.begin(i + 1)) << chunks << " chunks, " << threads << " threads, part " << i;
        }
        // As few as that, or threads would fight for them.
        EXPECT_LE(parts.count(), threads * 16);
      }
    }
  }
}

TEST(Parts, TheLastOnesAreNearlySingleChunks) {
  for (const std::size_t chunks : {64u, 100u, 256u, 1'000u, 3'000u}) {
    const auto all = sizes(Parts::falling(chunks, 4, std::array{1.0}));
    EXPECT_LE(*std::max_element(all.end() - 8, all.end()), 2u) << chunks;
    EXPECT_LE(all.front(), chunks / 8 + 1);
  }
}

}  // namespace
}  // namespace edgecase::rasterizer
