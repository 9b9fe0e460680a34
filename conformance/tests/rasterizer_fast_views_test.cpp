// The fast rasterizer on views (samples, scissors) in all its forms against the scalar one, for every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "conformance/scene/standard_samples.h"
#include "conformance/tests/snapped_triangles.h"
#include "rasterizer/fast/fast.h"
#include "rasterizer/rasterizer.h"

namespace edgecase::rasterizer {
namespace {

using namespace snapped;
using Words = std::vector<std::uint64_t>;

SamplePattern standard_pattern(int samples) {
  std::vector<SampleLocation> locations;
  for (const auto& at : conformance::standard_sample_locations(samples)) locations.push_back({at.x, at.y});
  return *SamplePattern::make(locations);
}

template <class V>
Words scalar(const Fixed& triangle, const V& view) {
  Words words(view.target.mask_words(view.samples.count()));
  const Mask mask = *Mask::over(view.target, words, view.samples.count());
  cover<Format16_8>(triangle, view, [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
  return words;
}

Words rows_of(const StripMask& mask) {
  Words words(mask.target().mask_words(mask.samples()));
  mask.to_rows(words);
  return words;
}

class FastViews : public testing::TestWithParam<Isa> {
 protected:
  template <class V>
  void expect_exact(std::span<const Fixed> triangles, const V& view) {
    std::vector<Words> expected;
    for (const Fixed& triangle : triangles) expected.push_back(scalar(triangle, view));
    expect_each(triangles, view, expected);
    expect_union(triangles, view, expected);
    expect_first(triangles, view, expected);
  }

  const FastRasterizer fast_ = *FastRasterizer::make(GetParam());
  std::mt19937_64 random_{7};

  int between(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  /// 1 to 16 samples anywhere, or one of the standard patterns.
  SamplePattern pattern() {
    if (random_() % 2 == 0) return standard_pattern(1 << between(0, 4));
    std::vector<SampleLocation> locations(static_cast<std::size_t>(between(1, 16)));
    for (auto& at : locations) at = {between(0, 15), between(0, 15)};
    return *SamplePattern::make(locations);
  }
  /// Inside, across, outside, empty; on borders of strips and beside them.
  Scissor scissor(const Target& target) {
    const auto [left, right] = ends(target.width().value());
    const auto [top, bottom] = ends(target.height().value());
    return {left, top, right - left, bottom - top};
  }

 private:
  std::array<int, 2> ends(int extent) {
    const auto end = [&] {
      return random_() % 3 == 0 ? between(-1, extent / 32 + 1) * 32 + between(-1, 1) : between(-9, extent + 9);
    };
    const int a = end(), b = end();
    return {std::min(a, b), random_() % 16 == 0 ? std::min(a, b) : std::max(a, b)};
  }

  template <class V>
  void expect_each(std::span<const Fixed> triangles, const V& view, const std::vector<Words>& expected) const {
    const std::size_t words = view.target.mask_words(view.samples.count());
    Words masks(triangles.size() * words, ~std::uint64_t{0});
    std::vector<std::uint64_t> counts(triangles.size(), 1234567);
    fast_.cover_each(triangles, view, masks);
    fast_.count_each(triangles, view, counts);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      ASSERT_TRUE(std::ranges::equal(std::span(masks).subspan(i * words, words), expected[i]))
          << "triangle " << i << ": " << text(triangles[i]);
      std::uint64_t count = 0;
      for (const std::uint64_t word : expected[i]) count += static_cast<std::uint64_t>(std::popcount(word));
      ASSERT_EQ(counts[i], count) << "triangle " << i << ": " << text(triangles[i]);
    }
  }

  /// On top of what another list has left all over the target.
  template <class V>
  void expect_union(std::span<const Fixed> triangles, const V& view, const std::vector<Words>& expected) const {
    StripMask mask(view.target, view.samples.count());
    const View<decltype(view.samples)> whole{view.target, view.samples};
    fast_.cover_union(triangles.first(1), whole, mask);
    Words united = scalar(triangles[0], whole);
    fast_.cover_union(triangles.subspan(1), view, mask);
    for (std::size_t i = 1; i < triangles.size(); ++i) {
      for (std::size_t word = 0; word < united.size(); ++word) united[word] |= expected[i][word];
    }
    ASSERT_EQ(rows_of(mask), united);
  }

  /// In two lists, the numbers of the second following those of the first; then, cleared, another list.
  template <class V>
  void expect_first(std::span<const Fixed> triangles, const V& view, const std::vector<Words>& expected) const {
    const int samples = view.samples.count();
    VisibilityBuffer buffer(view.target, samples);
    fast_.cover_first(triangles, view, buffer);
    buffer.clear();
    const std::size_t half = triangles.size() / 2;
    constexpr std::uint32_t kFirst = 70'000;
    fast_.cover_first(triangles.first(half), view, buffer, kFirst);
    fast_.cover_first(triangles.subspan(half), view, buffer, kFirst + static_cast<std::uint32_t>(half));
    Words covered(view.target.mask_words(samples));
    for (int y = 0; y < view.target.height().value(); ++y) {
      for (int x = 0; x < view.target.width().value(); ++x) {
        for (int s = 0; s < samples; ++s) {
          const auto bit = static_cast<std::size_t>(x * samples + s);
          const std::size_t word = static_cast<std::size_t>(y) * view.target.row_words(samples) + bit / 64;
          std::uint32_t number = VisibilityBuffer::kNone;
          for (std::size_t i = 0; i < triangles.size() && number == VisibilityBuffer::kNone; ++i) {
            if (expected[i][word] >> (bit % 64) & 1) number = kFirst + static_cast<std::uint32_t>(i);
          }
          ASSERT_EQ(buffer.at(x, y, s), number) << x << ", " << y << ", sample " << s;
          if (number != VisibilityBuffer::kNone) covered[word] |= std::uint64_t{1} << (bit % 64);
        }
      }
    }
    ASSERT_EQ(rows_of(buffer.covered()), covered);
  }
};

std::vector<Fixed> some(Triangles& stream, std::size_t count) {
  std::vector<Fixed> triangles(count);
  for (Fixed& triangle : triangles) triangle = stream.next();
  return triangles;
}

TEST_P(FastViews, ACentreSampleWithoutScissor) {
  for (int width = 1; width <= 140; width += 9) {
    const Target target = *Target::make(width, 1 + width * 7 % 40);
    Triangles stream(static_cast<unsigned>(width), target);
    for (int i = 0; i < 4; ++i) ASSERT_NO_FATAL_FAILURE(expect_exact(some(stream, 41), View<>{target})) << width;
  }
}

TEST_P(FastViews, AnySamplesOnAnyTarget) {
  for (int i = 0; i < 60; ++i) {
    const Target target = *Target::make(between(1, 140), between(1, 60));
    Triangles stream(static_cast<unsigned>(i), target);
    const View<SamplePattern> view{target, pattern()};
    ASSERT_NO_FATAL_FAILURE(expect_exact(some(stream, 23), view)) << i << ": " << view.samples.count() << " samples";
  }
}

TEST_P(FastViews, AnyScissorOnAnyTarget) {
  for (int i = 0; i < 200; ++i) {
    const Target target = *Target::make(between(1, 140), between(1, 60));
    Triangles stream(static_cast<unsigned>(i), target);
    const View<CentreSample, Scissor> view{target, {}, scissor(target)};
    const auto& [x, y, width, height] = view.clip;
    ASSERT_NO_FATAL_FAILURE(expect_exact(some(stream, 37), view))
        << i << ": " << width << "x" << height << " at " << x << ", " << y;
  }
}

TEST_P(FastViews, AnySamplesInAnyScissor) {
  for (int i = 0; i < 80; ++i) {
    const Target target = *Target::make(between(1, 140), between(1, 60));
    Triangles stream(static_cast<unsigned>(i), target);
    const View<SamplePattern, Scissor> view{target, pattern(), scissor(target)};
    ASSERT_NO_FATAL_FAILURE(expect_exact(some(stream, 23), view)) << i << ": " << view.samples.count() << " samples";
  }
}

// The samples farthest from the centre move vertices at the ends of the format beyond it, the more so a scissor at the
// target's far end; edges pass through samples there as anywhere.
TEST_P(FastViews, EndsOfTheRangeAtTheSamplesFarthestFromTheCentre) {
  const std::array<SampleLocation, 5> corners{{{0, 0}, {15, 0}, {0, 15}, {15, 15}, {8, 8}}};
  const SamplePattern samples = *SamplePattern::make(corners);
  for (const auto& [width, height] : {std::array{16384, 3}, std::array{3, 16384}, std::array{90, 90}}) {
    const Target target = *Target::make(width, height);
    std::vector<Fixed> triangles{{vertex(kLow, kLow), vertex(kHigh, kLow), vertex(kLow, kHigh)},
                                 {vertex(kHigh, kHigh), vertex(kLow, kHigh), vertex(kHigh, kLow)},
                                 {vertex(kLow, kLow), vertex(kHigh, kHigh - 1), vertex(kHigh, kHigh)},
                                 {vertex(kLow, kHigh), vertex(kHigh - 1, kLow), vertex(kHigh, kLow)}};
    const std::array<std::int64_t, 8> values{kLow, kLow + 1, -1, 0, 112, width * 128, kHigh - 1, kHigh};
    while (triangles.size() < 36) {
      const auto coordinate = [&] {
        return random_() % 2 == 0 ? values[random_() % 8] : static_cast<std::int64_t>(random_() >> 40) + kLow;
      };
      triangles.push_back(
          {vertex(coordinate(), coordinate()), vertex(coordinate(), coordinate()), vertex(coordinate(), coordinate())});
    }
    const View<SamplePattern> whole{target, samples};
    ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, whole)) << width << "x" << height;
    const View<SamplePattern, Scissor> end{target, samples, {width - 2, height - 2, 5, 5}};
    ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, end)) << width << "x" << height;
  }
}

// Edges through sample locations: what tells where a sample is from where it nearly is.
TEST_P(FastViews, EdgesThroughSamples) {
  for (int i = 0; i < 30; ++i) {
    const SamplePattern samples = standard_pattern(1 << between(0, 4));
    const Target target = *Target::make(between(20, 120), between(20, 90));
    std::vector<Fixed> triangles(32);
    for (Fixed& triangle : triangles) {
      const auto at = samples.point<Format16_8>(between(0, samples.count() - 1));
      const std::int64_t x = between(0, 80) * 256 + at.x.value(), y = between(0, 60) * 256 + at.y.value();
      const int dx = between(-8000, 8000), dy = between(-8000, 8000), beyond = between(1, 3);
      triangle = {vertex(x - dx, y - dy), vertex(x + dx * beyond, y + dy * beyond),
                  vertex(between(0, 100) * 128, between(0, 100) * 128)};
    }
    ASSERT_NO_FATAL_FAILURE(expect_exact(triangles, View<SamplePattern>{target, samples})) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Isas, FastViews, testing::ValuesIn(available_isas().begin(), available_isas().end()),
                         [](const auto& isa) { return std::string(name_of(isa.param)); });

}  // namespace
}  // namespace edgecase::rasterizer
