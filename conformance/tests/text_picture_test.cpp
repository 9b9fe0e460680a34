#include "conformance/compare/text_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/compare/caption.h"
#include "conformance/tests/sample_exhibits.h"

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

TEST(SampleState, TellsTheMarksApart) {
  const Exhibit exhibit = one_of_each();
  EXPECT_EQ(sample_state(exhibit, 0, 0, 0).mark, Mark::empty);
  EXPECT_EQ(sample_state(exhibit, 6, 8, 0).mark, Mark::covered);
  EXPECT_EQ(sample_state(exhibit, 5, 8, 0).mark, Mark::missing);
  EXPECT_EQ(sample_state(exhibit, 1, 14, 0).mark, Mark::unexpected);
  EXPECT_EQ(sample_state(exhibit, 10, 5, 0).mark, Mark::doubled);
  EXPECT_EQ(sample_state(exhibit, 10, 5, 0).observed, 2);
}

TEST(SampleState, OpenSamplesMayBeCoveredOnce) {
  Exhibit exhibit = square_fan();
  const MaskLayout layout(exhibit.scene.setting);
  exhibit.may = exhibit.must;
  std::fill(exhibit.may.data().begin(), exhibit.may.data().end(), 0);
  for (const std::size_t triangle : {std::size_t{0}, std::size_t{1}}) {
    for (const int x : {0, 1, 2}) cover(exhibit.may[triangle], layout.bit(x, 0, 0));
  }
  cover(exhibit.observed[0], layout.bit(1, 0, 0));
  cover(exhibit.observed[0], layout.bit(2, 0, 0));
  cover(exhibit.observed[1], layout.bit(2, 0, 0));
  EXPECT_EQ(sample_state(exhibit, 0, 0, 0).mark, Mark::open_empty);
  EXPECT_EQ(sample_state(exhibit, 1, 0, 0).mark, Mark::open_covered);
  EXPECT_EQ(sample_state(exhibit, 2, 0, 0).mark, Mark::doubled);
}

TEST(Window, ShowsWhatMatters) {
  const Exhibit small = make_exhibit({{200, 100}, {SampleLocation{}}}, {{Position{60, 40}, {70, 40}, {60, 46}}});
  const Window around = choose_window(small);
  EXPECT_TRUE(around.contains(59, 39) && around.contains(70, 46));
  EXPECT_LE(around.width * around.height, 16 * 12);

  Exhibit large = make_exhibit({{2000, 400}, {SampleLocation{}}}, {{Position{-50, 0}, {1990, 200}, {5, 399}}});
  spoil(large, 0, 1999, 1, 0);
  const Window cut = choose_window(large);
  EXPECT_LE(cut.width, 48);
  EXPECT_LE(cut.height, 32);
  EXPECT_TRUE(cut.contains(1999, 1));
  EXPECT_EQ(cut.x + cut.width, 2000);
  EXPECT_EQ(cut.y, 0);

  const Exhibit pixel = make_exhibit({{1, 1}, {SampleLocation{}}}, {{Position{-9, -9}, {9, -9}, {-9, 9}}});
  EXPECT_EQ(choose_window(pixel).width * choose_window(pixel).height, 1);
}

TEST(Window, ReachesAStraySampleFarFromTheTriangle) {
  Exhibit exhibit = make_exhibit({{40, 30}, {SampleLocation{}}}, {{Position{1, 1}, {9, 1}, {1, 9}}});
  spoil(exhibit, 0, 3, 2, 0);
  spoil(exhibit, 0, 3, 27, 0);
  EXPECT_TRUE(choose_window(exhibit).contains(3, 27));
}

TEST(Caption, DecimalsAreExact) {
  EXPECT_EQ(exact_decimal(0, 8), "0");
  EXPECT_EQ(exact_decimal(384, 8), "1.5");
  EXPECT_EQ(exact_decimal(-1, 8), "-0.00390625");
  EXPECT_EQ(exact_decimal(257, 8), "1.00390625");
  EXPECT_EQ(exact_decimal(-512, 8), "-2");
  EXPECT_EQ(exact_decimal(65535, 16), "0.9999847412109375");
  EXPECT_EQ(exact_decimal(7, 0), "7");
}

TEST(Caption, SaysWhyASampleIsInsideOrOutside) {
  Exhibit exhibit = make_exhibit({{8, 8}, {SampleLocation{}}}, {{Position{1.5f, 1.5f}, {6.5f, 1.5f}, {1.5f, 6.5f}}});
  const auto reason = [&](int x, int y) {
    exhibit.explanation = explain(exhibit.snapped[0], exhibit.scene.setting, x, y, 0);
    return make_caption(exhibit).reason;
  };
  EXPECT_EQ(reason(2, 2), "inside: on the inner side of all three edges");
  EXPECT_EQ(reason(3, 1), "inside: on v0 -> v1, a top edge");
  EXPECT_EQ(reason(1, 3), "inside: on v2 -> v0, a left edge");
  EXPECT_EQ(reason(4, 3), "outside: on v1 -> v2, neither top nor left");
  EXPECT_EQ(reason(7, 7), "outside: beyond the edge v1 -> v2");

  exhibit.explanation = explain(exhibit.snapped[0], exhibit.scene.setting, 2, 2, 0);
  exhibit.explanation->inside = false;
  EXPECT_EQ(make_caption(exhibit).reason, "outside: the scissor leaves this pixel out");
  exhibit.explanation->culled = true;
  EXPECT_EQ(make_caption(exhibit).reason, "culled by the way it faces: the triangle covers nothing");
}

TEST(TextPicture, ShowsRowsWithCoordinates) {
  Exhibit exhibit = make_exhibit({{8, 6}, {SampleLocation{}}}, {{Position{1.5f, 1.5f}, {6.5f, 1.5f}, {1.5f, 5.5f}}});
  exhibit.title = "two samples";
  spoil(exhibit, 0, 2, 1, 0);
  spoil(exhibit, 0, 6, 1, 0);
  EXPECT_EQ(text_picture(exhibit),
            "two samples\n"
            "8 x 6 px, 1 sample a pixel, 8 subpixel bits, snap to nearest even\n"
            "    0    5\n"
            "      v\n"
            "  0 ........\n"
            "> 1 .#o###x.\n"
            "  2 .####...\n"
            "  3 .###....\n"
            "  4 .##.....\n"
            "  5 ........\n"
            ". not covered 33   # covered 13   o missing 1   x unexpected 1\n"
            "missing at pixel (2, 1), sample 0, at (2.5, 1.5): the rules cover it, softpipe does not\n"
            "triangle: v0 (1.5, 1.5)  v1 (6.5, 1.5)  v2 (1.5, 5.5)\n"
            "edge functions there, in (1/256 px)^2, positive inside:\n"
            "  v0 -> v1           0  top\n"
            "  v1 -> v2  +1,048,576  -\n"
            "  v2 -> v0    +262,144  left\n"
            "inside: on v0 -> v1, a top edge\n"
            "$ ./edgecase run --subject osmesa-softpipe findings/0001-softpipe-fans.json\n");
}

TEST(TextPicture, NamesTheSnapThatASetLeavesOpen) {
  Exhibit exhibit = square_fan();
  for (const auto& [set, words] : {std::pair{"d3d11", "snap within 0.6 units, outlines to nearest even\n"},
                                   std::pair{"vulkan", "snap to either neighbour, outlines to nearest even\n"}}) {
    exhibit.rule_set = find_rule_set(set);
    EXPECT_THAT(text_picture(exhibit), HasSubstr(words));
  }
}

TEST(TextPicture, DoubledSamplesShowHowOften) {
  EXPECT_EQ(character_of({Mark::doubled, 2}), '2');
  EXPECT_EQ(character_of({Mark::doubled, 64}), '9');
  EXPECT_THAT(text_picture(one_of_each()), HasSubstr("2-9 doubled 1"));
}

TEST(TextPicture, GroupsTheSamplesOfAPixel) {
  Exhibit exhibit = make_exhibit({{4, 3}, {{4, 4}, {12, 12}}}, {{Position{0.5f, 0.5f}, {3.5f, 0.5f}, {0.5f, 2.5f}}});
  spoil(exhibit, 0, 1, 1, 1);
  EXPECT_THAT(text_picture(exhibit), HasSubstr("\n> 1 .# #x #. ..\n"));
  EXPECT_THAT(text_picture(exhibit), HasSubstr("\n        v\n"));
}

}  // namespace
}  // namespace edgecase::conformance
