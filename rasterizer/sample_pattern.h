// Where coverage is asked for: which samples a pixel has, and which part of a target is drawn into.
//
// Both are template parameters of the rasterizer. A pixel with one sample in its centre and a target without a scissor
// are types without a state, whose constants the compiler folds: a scene that asks for no more pays for no more.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "rasterizer/format.h"
#include "rasterizer/target.h"

namespace edgecase::rasterizer {

/// Samples of a pixel, at most.
inline constexpr int kMaxSamples = 16;

/// Where a sample lies in its pixel, in sixteenths of a pixel from the pixel's top-left corner; each from 0 to 15.
struct SampleLocation {
  int x = 8;
  int y = 8;
};

/// A sample location on the grid of 2^-P px, P = F::kSampleBits: 0 to (15/16) * 2^P.
template <class F>
using SampleOffset = Int<F::kSampleBits + 1>;

template <class F>
struct SamplePoint {
  SampleOffset<F> x;
  SampleOffset<F> y;
};

/// One sample, in the pixel's centre.
struct CentreSample {
  static constexpr int count() { return 1; }
  template <class F>
  static constexpr SamplePoint<F> point(int) {
    constexpr auto kHalf = constant<(std::int64_t{1} << F::kSampleBits) / 2>;
    return {kHalf, kHalf};
  }
  template <class F>
  static constexpr SamplePoint<F> least() {
    return point<F>(0);
  }
  template <class F>
  static constexpr SamplePoint<F> greatest() {
    return point<F>(0);
  }
};

/// 1 to kMaxSamples samples anywhere on the sixteenths; several may coincide. Sample s of a mask is the s-th of them.
class SamplePattern {
 public:
  /// Nothing unless there are 1 to kMaxSamples locations, all of them on the grid.
  static constexpr std::optional<SamplePattern> make(std::span<const SampleLocation> locations) {
    if (locations.empty() || locations.size() > kMaxSamples) return std::nullopt;
    SamplePattern pattern;
    for (const SampleLocation& location : locations) {
      const auto x = Sixteenths::checked(location.x);
      const auto y = Sixteenths::checked(location.y);
      if (!x || !y || *x < constant<0> || *y < constant<0>) return std::nullopt;
      pattern.points_[pattern.count_++] = {*x, *y};
    }
    const auto points = std::span(pattern.points_).first(pattern.count_);
    const auto by_x = [](const Point& p, const Point& q) { return p.x < q.x; };
    const auto by_y = [](const Point& p, const Point& q) { return p.y < q.y; };
    pattern.least_ = {std::ranges::min(points, by_x).x, std::ranges::min(points, by_y).y};
    pattern.greatest_ = {std::ranges::max(points, by_x).x, std::ranges::max(points, by_y).y};
    return pattern;
  }

  constexpr int count() const { return static_cast<int>(count_); }
  template <class F>
  constexpr SamplePoint<F> point(int sample) const {
    return on_grid<F>(points_[static_cast<std::size_t>(sample)]);
  }
  /// The corners of the samples' bounding box; a bounding box of pixels must regard both.
  template <class F>
  constexpr SamplePoint<F> least() const {
    return on_grid<F>(least_);
  }
  template <class F>
  constexpr SamplePoint<F> greatest() const {
    return on_grid<F>(greatest_);
  }

 private:
  using Sixteenths = Int<5>;
  struct Point {
    Sixteenths x;
    Sixteenths y;
  };
  template <class F>
  static constexpr SamplePoint<F> on_grid(const Point& p) {
    constexpr int kShift = F::kSampleBits - 4;
    return {p.x.template shifted_left<kShift>(), p.y.template shifted_left<kShift>()};
  }

  std::array<Point, kMaxSamples> points_{};
  std::size_t count_ = 0;
  Point least_;
  Point greatest_;
};

/// Pixels left <= x < right, top <= y < bottom, where left <= right and top <= bottom.
struct PixelBox {
  PixelIndex left;
  PixelIndex top;
  PixelIndex right;
  PixelIndex bottom;
};

/// All of a target is drawn into.
struct WholeTarget {
  static constexpr PixelBox within(const Target& target) {
    constexpr auto kZero = *PixelIndex::checked(0);
    return {kZero, kZero, target.width(), target.height()};
  }
};

/// A rectangle of pixels x .. x + width - 1, y .. y + height - 1: nothing outside it is covered. Any integers: it may
/// lie partly or wholly outside the target, and with a width or height of zero or less it holds no pixel.
struct Scissor {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  constexpr PixelBox within(const Target& target) const {
    constexpr auto kZero = *PixelIndex::checked(0);
    const auto clamped = [](std::int64_t value, PixelIndex low, PixelIndex high) {
      return clamp(*Int<34>::checked(value), low, high);  // an int, or the sum of two
    };
    const PixelIndex left = clamped(x, kZero, target.width());
    const PixelIndex top = clamped(y, kZero, target.height());
    return {left, top, clamped(std::int64_t{x} + width, left, target.width()),
            clamped(std::int64_t{y} + height, top, target.height())};
  }
};

/// A target, the samples of its pixels and the part of it that is drawn into.
template <class Samples = CentreSample, class Clip = WholeTarget>
struct View {
  Target target;
  Samples samples{};
  Clip clip{};

  constexpr PixelBox bounds() const { return clip.within(target); }
};

}  // namespace edgecase::rasterizer
