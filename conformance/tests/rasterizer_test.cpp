#include "rasterizer/rasterizer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace edgecase::rasterizer {
namespace {

using testing::ElementsAre;
using Rows = std::vector<std::string>;

/// The mask of one triangle: '#' for a covered pixel. Checks that the sink's promises are kept.
template <class F = Format16_8>
Rows draw(int width, int height, const Triangle& triangle) {
  const Target target = *Target::make(width, height);
  Rows rows(static_cast<std::size_t>(height), std::string(static_cast<std::size_t>(width), '.'));
  int last_y = -1, last_word = -1;
  const auto error = cover<F>(triangle, target, [&](int y, int word, std::uint64_t bits) {
    EXPECT_NE(bits, 0u);
    EXPECT_TRUE(y > last_y || (y == last_y && word > last_word));
    last_y = y, last_word = word;
    for (int bit = 0; bit < 64; ++bit) {
      if (bits >> bit & 1) rows.at(static_cast<std::size_t>(y)).at(static_cast<std::size_t>(word * 64 + bit)) = '#';
    }
  });
  EXPECT_FALSE(error);
  return rows;
}

TEST(Rasterizer, SamplesOnALeftAndATopEdgeAreInside) {
  EXPECT_THAT(draw(4, 4, {{{1.5, 0.5}, {1.5, 3.5}, {3.5, 0.5}}}), ElementsAre(".##.", ".##.", ".#..", "...."));
}

TEST(Rasterizer, SamplesOnARightAndABottomEdgeAreNot) {
  EXPECT_THAT(draw(4, 4, {{{3.5, 0.5}, {3.5, 3.5}, {0.5, 3.5}}}), ElementsAre("....", "..#.", ".##.", "...."));
}

TEST(Rasterizer, SlantedLeftEdgesAreInsideInBothDirections) {
  // A diamond's left half: its left edges run through the samples (2,0), (1,1), (0,2), (1,3), its right edge through x
  // = 2.5.
  EXPECT_THAT(draw(4, 5, {{{2.5, 0.5}, {0.5, 2.5}, {2.5, 4.5}}}), ElementsAre("....", ".#..", "##..", ".#..", "...."));
  // The right half: the left edge through x = 0.5 is inside, the slanted ones are right edges.
  EXPECT_THAT(draw(4, 5, {{{0.5, 0.5}, {2.5, 2.5}, {0.5, 4.5}}}), ElementsAre("....", "#...", "##..", "#...", "...."));
}

TEST(Rasterizer, OneSixteenthOfASubpixelDecides) {
  // The left edge 1/256 px right of the samples of column 1, then exactly on them.
  EXPECT_THAT(draw(3, 2, {{{1.50390625, 0}, {1.50390625, 2}, {3, 0}}}), ElementsAre("..#", "..."));
  EXPECT_THAT(draw(3, 2, {{{1.5, 0}, {1.5, 2}, {3, 0}}}), ElementsAre(".##", ".#."));
}

TEST(Rasterizer, EitherWindingCoversTheSame) {
  const Triangle clockwise{{{0.25, 0.25}, {6.75, 1.5}, {2.5, 5.75}}};
  const auto& [a, b, c] = clockwise;
  const Rows rows = draw(8, 6, clockwise);
  for (const Triangle& other : {Triangle{a, c, b}, Triangle{b, a, c}, Triangle{c, b, a}, Triangle{b, c, a}}) {
    EXPECT_EQ(draw(8, 6, other), rows);
  }
  EXPECT_THAT(rows, ElementsAre("##......", ".######.", ".#####..", "..###...", "..##....", "..#....."));
}

TEST(Rasterizer, ZeroAreaCoversNothing) {
  const Rows none(4, "....");
  EXPECT_EQ(draw(4, 4, {{{0.5, 0.5}, {3.5, 3.5}, {2.5, 2.5}}}), none);
  EXPECT_EQ(draw(4, 4, {{{0.5, 1.5}, {3.5, 1.5}, {1.5, 1.5}}}), none);
  EXPECT_EQ(draw(4, 4, {{{1.5, 1.5}, {1.5, 1.5}, {1.5, 1.5}}}), none);
  // Of area only before snapping.
  EXPECT_EQ(draw(4, 4, {{{0, 1.5}, {4, 1.5}, {2, 1.5009765625}}}), none);
}

TEST(Rasterizer, ATriangleWithoutSamplesCoversNothing) {
  EXPECT_EQ(draw(2, 2, {{{0.6f, 0.6f}, {1.4f, 0.6f}, {0.6f, 1.4f}}}), Rows(2, ".."));
  EXPECT_EQ(draw(2, 2, {{{-3, -3}, {-1, -3}, {-3, -1}}}), Rows(2, ".."));
  EXPECT_EQ(draw(2, 2, {{{9, 9}, {12, 9}, {9, 12}}}), Rows(2, ".."));
  // The bounding box holds the target, the triangle does not.
  EXPECT_EQ(draw(2, 2, {{{-10, 14}, {14, 14}, {14, -10}}}), Rows({"..", ".."}));
}

TEST(Rasterizer, FourTrianglesMeetingInASampleCoverItOnce) {
  std::vector<int> count(25);
  const Vertex centre{2.5, 2.5};
  const Vertex corners[] = {{0.5, 0.5}, {4.5, 0.5}, {4.5, 4.5}, {0.5, 4.5}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Rows rows = draw(5, 5, {centre, corners[i], corners[(i + 1) % 4]});
    for (std::size_t pixel = 0; pixel < 25; ++pixel) count[pixel] += rows[pixel / 5][pixel % 5] == '#';
  }
  for (std::size_t pixel = 0; pixel < 25; ++pixel) EXPECT_EQ(count[pixel], pixel / 5 < 4 && pixel % 5 < 4) << pixel;
}

TEST(Rasterizer, RowsCrossWordBoundaries) {
  const Rows rows = draw(200, 1, {{{62.5, -1000}, {62.5, 1000}, {100000.f / 256, 0.5}}});
  EXPECT_EQ(rows[0], std::string(62, '.') + std::string(138, '#'));
  const Rows inside = draw(200, 2, {{{63.5, 0.5}, {129.5, 0.5}, {63.5, 1000}}});
  EXPECT_EQ(inside[0], std::string(63, '.') + std::string(66, '#') + std::string(71, '.'));
}

TEST(Rasterizer, CoarseFormatsSampleBetweenTheirGridPoints) {
  // 16.0: vertices on whole pixels only, samples half way between them.
  EXPECT_THAT((draw<Format<16, 0>>(3, 3, {{{0, 0}, {3, 0}, {0, 3}}})), ElementsAre("##.", "#..", "..."));
  // The diagonal runs through the samples: right edge in the triangle above, left edge in its mirror.
  EXPECT_THAT((draw<Format<16, 0>>(3, 3, {{{3, 0}, {3, 3}, {0, 3}}})), ElementsAre("..#", ".##", "###"));
  EXPECT_THAT((draw<Format<12, 4>>(3, 2, {{{1.53f, 0}, {1.53f, 2}, {3, 0}}})), ElementsAre(".##", ".#."));
}

TEST(Rasterizer, TheFormatDecidesWhereAVertexLies) {
  // 1.53 px rounds to 1.5 with 4 subpixel bits, and to 1.53125 with 8, right of the sample.
  const Triangle triangle{{{1.53f, 0}, {1.53f, 2}, {3, 0}}};
  EXPECT_NE((draw<Format<12, 4>>(3, 2, triangle)), draw(3, 2, triangle));
}

TEST(Rasterizer, CompilesToAConstant) {
  constexpr int covered = [] {
    int count = 0;
    static_cast<void>(cover(Triangle{{{0, 0}, {4, 0}, {0, 4}}}, *Target::make(4, 4),
                            [&](int, int, std::uint64_t bits) { count += static_cast<int>(std::popcount(bits)); }));
    return count;
  }();
  static_assert(covered == 6);
}

TEST(RasterizerBox, HoldsExactlyTheSamplesInTheBoundingBox) {
  const auto box_of = [](const Triangle& triangle) {
    FixedTriangle<Format16_8> snapped;
    EXPECT_FALSE(snap<Format16_8>(triangle, snapped));
    const auto box = pixel_box<Format16_8>(snapped, View<>{*Target::make(10, 6)});
    return box ? std::vector{box->left.value(), box->top.value(), box->right.value(), box->bottom.value()}
               : std::vector<int>{};
  };
  constexpr float kSubpixel = 1.0f / 256;
  EXPECT_THAT(box_of({{{1.5, 2.5}, {4.5, 3}, {3, 3.5}}}), ElementsAre(1, 2, 5, 4));
  EXPECT_THAT(box_of({{{1.5f + kSubpixel, 2.5f + kSubpixel}, {4.5f - kSubpixel, 3}, {3, 3.5f - kSubpixel}}}),
              testing::IsEmpty());
  EXPECT_THAT(box_of({{{1.5f + kSubpixel, 2.5f - kSubpixel}, {4.5f - kSubpixel, 3}, {3, 3.5f + kSubpixel}}}),
              ElementsAre(2, 2, 4, 4));
  EXPECT_THAT(box_of({{{-300, -300}, {3000, 1}, {2, 3000}}}), ElementsAre(0, 0, 10, 6));
  EXPECT_THAT(box_of({{{-9, 1}, {-1, 1}, {-9, 5}}}), testing::IsEmpty());
  EXPECT_THAT(box_of({{{1, 6}, {9, 6}, {1, 9}}}), testing::IsEmpty());
}

TEST(RasterizerList, TheSinkIsToldWhichTriangle) {
  const std::vector<Triangle> triangles{
      {{{0, 0}, {1, 0}, {0, 1.5}}}, {{{5, 5}, {5, 5}, {5, 5}}}, {{{1, 1}, {3, 1}, {1, 3}}}};
  std::vector<std::size_t> seen;
  EXPECT_FALSE(
      cover_list(triangles, *Target::make(4, 4), [&](std::size_t i, int, int, std::uint64_t) { seen.push_back(i); }));
  EXPECT_THAT(seen, ElementsAre(0u, 2u));
}

TEST(RasterizerList, AMaskGathersTheUnion) {
  const Target target = *Target::make(70, 2);
  std::vector<std::uint64_t> words(target.mask_words());
  ASSERT_EQ(words.size(), 4u);
  words[1] = 1;  // what was there stays
  const std::vector<Triangle> triangles{{{{65, 0}, {67, 0}, {65, 2}}}, {{{66, 1}, {69, 1}, {66, 4}}}};
  EXPECT_FALSE(cover_list(triangles, *Mask::over(target, words)));
  EXPECT_THAT(words, ElementsAre(0u, 0b10u | 1u, 0u, 0b1100u));
}

TEST(RasterizerList, OneBadVertexAndNothingIsDrawn) {
  const Target target = *Target::make(8, 8);
  std::vector<std::uint64_t> words(target.mask_words());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Triangle> triangles{{{{0, 0}, {8, 0}, {0, 8}}}, {{{0, 0}, {1, nan}, {2, 2}}}};
  const auto error = cover_list(triangles, *Mask::over(target, words));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind, InputError::Kind::nan);
  EXPECT_EQ(error->triangle, 1u);
  EXPECT_EQ(error->vertex, 1);
  EXPECT_EQ(error->axis, Axis::y);
  EXPECT_THAT(words, testing::Each(0u));
  EXPECT_TRUE(cover(triangles[1], *Mask::over(target, words)));
}

TEST(RasterizerTarget, ExtentsAndMasksAreChecked) {
  EXPECT_FALSE(Target::make(0, 1));
  EXPECT_FALSE(Target::make(1, 0));
  EXPECT_FALSE(Target::make(-1, 1));
  EXPECT_FALSE(Target::make(16385, 1));
  EXPECT_FALSE(Target::make(1, 16385));
  ASSERT_TRUE(Target::make(16384, 16384));
  EXPECT_EQ(Target::make(65, 3)->row_words(), 2u);
  std::vector<std::uint64_t> words(7);
  EXPECT_FALSE(Mask::over(*Target::make(65, 3), words));
  words.pop_back();
  EXPECT_TRUE(Mask::over(*Target::make(65, 3), words));
}

}  // namespace
}  // namespace edgecase::rasterizer
