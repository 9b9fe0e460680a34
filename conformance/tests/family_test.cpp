// Every member of the family against cover_scalar, bit for bit, and against what it promises its sink.
#include "rasterizer/family/family.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "rasterizer/family/coarse_fine.h"
#include "rasterizer/family/lanes4.h"
#include "rasterizer/family/larrabee.h"
#include "rasterizer/family/orient2d.h"
#include "rasterizer/family/quads.h"
#include "rasterizer/family/stamp.h"
#include "rasterizer/family/trapezoid.h"
#include "rasterizer/scalar.h"

namespace edgecase::rasterizer {

/// How GoogleTest names a parameter.
static void PrintTo(const FamilyMember& member, std::ostream* out) { *out << member.name; }

namespace {

using F = Format16_8;
using Fixed = FixedTriangle<F>;
using Subpixels = std::array<std::array<std::int64_t, 2>, 3>;

constexpr std::int64_t kLow = F::Coordinate::kMin, kHigh = F::Coordinate::kMax;
constexpr std::pair<int, int> kTargets[] = {{1, 1},   {2, 3},     {7, 5},     {16, 16},   {33, 17},  {64, 64},
                                            {65, 63}, {100, 130}, {200, 150}, {16384, 2}, {2, 16384}};

Fixed fixed(const Subpixels& v) {
  const auto vertex = [](const std::array<std::int64_t, 2>& p) {
    return FixedVertex<F>{F::Coordinate::checked(p[0]).value(), F::Coordinate::checked(p[1]).value()};
  };
  return {vertex(v[0]), vertex(v[1]), vertex(v[2])};
}

std::string describe(const Fixed& triangle) {
  std::string text;
  for (const auto& v : triangle) text += " (" + std::to_string(v.x.value()) + ", " + std::to_string(v.y.value()) + ")";
  return text + " subpixels";
}

class Family : public testing::TestWithParam<FamilyMember> {
 protected:
  /// Draws `triangle` with the member under test and with cover_scalar.
  void expect_the_same(const Target& target, const Fixed& triangle) {
    expected_.assign(target.mask_words(), 0);
    observed_.assign(target.mask_words(), 0);
    const Mask mask = *Mask::over(target, expected_);
    cover_scalar<F>(triangle, View<>{target}, [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
    GetParam().cover(triangle, *Mask::over(target, observed_));
    ASSERT_EQ(expected_, observed_) << describe(triangle) << " on " << target.width().value() << "x"
                                    << target.height().value();
  }

  /// `triangles` of them on every target; on the largest, a tenth.
  template <class Make>
  void expect_the_same_on_every_target(int triangles, Make make) {
    std::mt19937_64 random(20);
    for (const auto& [width, height] : kTargets) {
      const Target target = *Target::make(width, height);
      const int count = std::max(width, height) > 1'000 ? triangles / 10 : triangles;
      for (int i = 0; i < count; ++i) {
        const Fixed triangle = fixed(make(random, width, height));
        ASSERT_NO_FATAL_FAILURE(expect_the_same(target, triangle));
      }
    }
  }

 private:
  std::vector<std::uint64_t> expected_, observed_;
};

/// From low to high, both included.
std::int64_t between(std::mt19937_64& random, std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
}

TEST_P(Family, TrianglesOfEverySize) {
  expect_the_same_on_every_target(3'000, [](std::mt19937_64& random, int width, int height) {
    // Around a point near the target; within 2^0 to 2^15 px, so also far smaller and far larger than a block.
    const std::int64_t reach = 128LL << random() % 16;
    const std::int64_t x = between(random, -512, 256LL * width + 512), y = between(random, -512, 256LL * height + 512);
    Subpixels v;
    for (auto& p : v) {
      p = {std::clamp(x + between(random, -reach, reach), kLow, kHigh),
           std::clamp(y + between(random, -reach, reach), kLow, kHigh)};
    }
    return v;
  });
}

TEST_P(Family, TiesOnTheHalfPixelLattice) {
  expect_the_same_on_every_target(2'000, [](std::mt19937_64& random, int width, int height) {
    const std::int64_t reach = random() % 2 ? 8 : 80;
    const std::int64_t x = between(random, -2, 2 * width + 2), y = between(random, -2, 2 * height + 2);
    Subpixels v;
    for (auto& p : v) {
      p = {128 * (x + between(random, -reach, reach)), 128 * (y + between(random, -reach, reach))};
    }
    if (random() % 4 == 0) v[1][1] = v[0][1];
    if (random() % 4 == 0) v[2][0] = v[1][0];
    if (random() % 4 == 0) v[2][0] = v[0][0] + (v[2][1] - v[0][1]);
    return v;
  });
}

TEST_P(Family, Slivers) {
  expect_the_same_on_every_target(1'500, [](std::mt19937_64& random, int width, int height) {
    const auto point = [&] {
      return std::array{between(random, -256, 256LL * width + 256), between(random, -256, 256LL * height + 256)};
    };
    Subpixels v{point(), point(), {}};
    const std::int64_t along = between(random, 0, 16);
    for (std::size_t k = 0; k < 2; ++k) v[2][k] = v[0][k] + (v[1][k] - v[0][k]) * along / 16 + between(random, -3, 3);
    return v;
  });
}

TEST_P(Family, TheExtremesOfTheRange) {
  expect_the_same_on_every_target(1'500, [](std::mt19937_64& random, int width, int height) {
    const std::int64_t values[] = {kLow, kLow + 1, -1, 0, 128, kHigh - 1, kHigh};
    Subpixels v;
    for (auto& p : v) {
      p = {values[random() % std::size(values)], values[random() % std::size(values)]};
      // Half of them with a vertex in the target.
      if (random() % 6 == 0) p = {between(random, 0, 256LL * width), between(random, 0, 256LL * height)};
    }
    return v;
  });
}

// Blocks that are covered as a whole wherever they begin and end, words and the target's border included.
TEST_P(Family, LargeTrianglesWithAnAxisParallelEdge) {
  std::mt19937_64 random(23);
  for (int i = 0; i < 20'000; ++i) {
    const int width = static_cast<int>(between(random, 1, 150)), height = static_cast<int>(between(random, 1, 40));
    const std::int64_t x = 64 * between(random, -8, 4LL * width + 8), y = 64 * between(random, -8, 4LL * height + 8);
    const std::int64_t away = random() % 2 ? 1'000'000 : -1'000'000;
    const Subpixels v = random() % 2 ? Subpixels{{{x, -2'000'000}, {x, 2'000'000}, {x + away, y}}}
                                     : Subpixels{{{-2'000'000, y}, {2'000'000, y}, {x, y + away}}};
    ASSERT_NO_FATAL_FAILURE(expect_the_same(*Target::make(width, height), fixed(v)));
  }
}

TEST_P(Family, EveryTriangleOnTheHalfPixelLatticeOverTwoPixels) {
  const Target target = *Target::make(2, 2);
  constexpr int kSide = 6;  // -1/2 to 2 px
  const auto vertex = [](int i) { return std::array<std::int64_t, 2>{128 * (i % kSide - 1), 128 * (i / kSide - 1)}; };
  for (int i = 0; i < kSide * kSide; ++i) {
    for (int j = 0; j < kSide * kSide; ++j) {
      for (int k = 0; k < kSide * kSide; ++k) {
        ASSERT_NO_FATAL_FAILURE(expect_the_same(target, fixed({vertex(i), vertex(j), vertex(k)})));
      }
    }
  }
}

TEST_P(Family, AListIsTheUnionAndStaysInTheMask) {
  std::mt19937_64 random(21);
  const Target target = *Target::make(150, 90);
  std::vector<Fixed> triangles;
  for (int i = 0; i < 30; ++i) {
    Subpixels v;
    for (auto& p : v) p = {between(random, -9'000, 50'000), between(random, -9'000, 30'000)};
    triangles.push_back(fixed(v));
  }
  std::vector<std::uint64_t> expected(target.mask_words(), 1), observed(target.mask_words(), 1);
  const Mask mask = *Mask::over(target, expected);
  for (const Fixed& triangle : triangles) {
    cover_scalar<F>(triangle, View<>{target}, [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
  }
  GetParam().cover_list(triangles, *Mask::over(target, observed));
  EXPECT_EQ(expected, observed);
}

INSTANTIATE_TEST_SUITE_P(All, Family, testing::ValuesIn(family_members().begin(), family_members().end()),
                         [](const auto& member) { return std::string(member.param.name); });

/// Checks what setup.h promises sinks.
class CheckingSink {
 public:
  explicit CheckingSink(const Target& target)
      : target_(target), words_(target.mask_words()), mask_(*Mask::over(target, words_)) {}

  void operator()(int y, int word, std::uint64_t bits) {
    ASSERT_NE(bits, 0u);
    ASSERT_TRUE(y >= 0 && y < target_.height().value()) << y;
    ASSERT_TRUE(word >= 0 && word < static_cast<int>(target_.row_words())) << word;
    const int columns = target_.width().value() - 64 * word;
    ASSERT_EQ(bits & ~family::low_bits(std::min(columns, 64)), 0u) << "right of the target";
    const auto at = static_cast<std::size_t>(y) * target_.row_words() + static_cast<std::size_t>(word);
    ASSERT_EQ(words_[at] & bits, 0u) << "twice";
    mask_.add(y, word, bits);
  }

 private:
  Target target_;
  std::vector<std::uint64_t> words_;
  Mask mask_;
};

TEST(FamilySink, TakesEveryPixelOnceAndNoneOutsideTheTarget) {
  using Cover = void (*)(const Fixed&, const Target&, CheckingSink&);
  const std::pair<const char*, Cover> covers[] = {
      {"orient2d", family::cover_orient2d<F, CheckingSink&>},
      {"lanes4", family::cover_lanes4<F, CheckingSink&>},
      {"quads", family::cover_quads<F, CheckingSink&>},
      {"coarse_fine", family::cover_coarse_fine<F, CheckingSink&>},
      {"larrabee", family::cover_larrabee<F, CheckingSink&>},
      {"stamp", family::cover_stamp<F, CheckingSink&>},
      {"trapezoid", family::cover_trapezoid<F, CheckingSink&>},
  };
  for (const auto& [name, cover] : covers) {
    SCOPED_TRACE(name);
    std::mt19937_64 random(22);
    for (int i = 0; i < 2'000; ++i) {
      const Target target =
          *Target::make(static_cast<int>(between(random, 1, 140)), static_cast<int>(between(random, 1, 90)));
      const std::int64_t reach = 256LL << random() % 12;
      Subpixels v;
      for (auto& p : v) p = {between(random, -reach, reach) + 12'000, between(random, -reach, reach) + 8'000};
      CheckingSink sink(target);
      cover(fixed(v), target, sink);
      ASSERT_FALSE(HasFatalFailure()) << describe(fixed(v));
    }
  }
}

TEST(FamilyMembers, AreCompleteAndSayWhatTheyAre) {
  std::vector<std::string_view> names;
  for (const FamilyMember& member : family_members()) {
    names.push_back(member.name);
    EXPECT_FALSE(member.about.empty());
    EXPECT_FALSE(member.source.empty());
    EXPECT_EQ(find_family_member(member.name), &member);
  }
  EXPECT_THAT(names, testing::ElementsAre("orient2d", "scalar", "lanes4", "quads", "coarse_fine", "larrabee", "stamp",
                                          "trapezoid"));
  EXPECT_EQ(find_family_member("quad"), nullptr);
}

}  // namespace
}  // namespace edgecase::rasterizer
