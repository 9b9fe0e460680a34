// Exact triangle coverage: which samples of a target lie inside a triangle, by the D3D10+ top-left rule.
//
//   using namespace edgecase::rasterizer;
//   const auto target = Target::make(1920, 1080);
//   std::vector<std::uint64_t> words(target->mask_words());
//   const auto mask = Mask::over(*target, words);
//   if (const auto error = cover({{{10, 10}, {500, 40}, {200, 700}}}, *mask)) puts(describe(*error).c_str());
//
// Window coordinates are pixels, y down, as binary32. They are snapped to a fixed-point format, 16.8 unless another is
// named as template argument, by rounding to nearest even; from there on everything is exact integer arithmetic over
// the whole range of the format, whatever part of the triangle lies outside the target. For 16.8 the range is -32768 ..
// 32767 + 255/256 px. A triangle of either winding is drawn; one of zero area after snapping covers nothing. Triangles
// that share an edge with equal end points cover no sample of it twice and leave none out.
//
// A Target by itself means one sample in the centre of every pixel. Where more is asked for, a View takes its place:
//
//   const auto samples = SamplePattern::make(locations);  // 1 to 16, anywhere on the sixteenths of a pixel
//   cover(triangle, View<SamplePattern, Scissor>{*target, *samples, {0, 0, 640, 480}}, sink);
//
// A coordinate that is NaN, infinite or out of range is an InputError, and then nothing at all is drawn. Nothing else
// can go wrong: targets and masks are checked when they are made. No function allocates, throws, or keeps state.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "rasterizer/input_error.h"
#include "rasterizer/scalar.h"
#include "rasterizer/snap.h"
#include "rasterizer/target.h"

namespace edgecase::rasterizer {

/// Takes coverage: up to 64 samples of row y, beginning with bit 64 * word of the row, the least significant bit first;
/// with one sample a pixel a bit is a column, see Mask for more. `bits` is not zero. Within a triangle rows come top to
/// bottom, the words of a row left to right, each word at most once.
template <class S>
concept Sink = std::invocable<S&, int /*y*/, int /*word*/, std::uint64_t /*bits*/>;

/// A Sink that is also told which triangle of a list it is.
template <class S>
concept IndexedSink = std::invocable<S&, std::size_t /*triangle*/, int /*y*/, int /*word*/, std::uint64_t /*bits*/>;

/// Coverage of a triangle that has been snapped already, see snap().
template <class F, class Samples, class Clip, Sink S>
constexpr void cover(const FixedTriangle<F>& triangle, const View<Samples, Clip>& view, S&& sink) {
  cover_scalar<F>(triangle, view, sink);
}

template <class F, Sink S>
constexpr void cover(const FixedTriangle<F>& triangle, const Target& target, S&& sink) {
  cover<F>(triangle, View<>{target}, sink);
}

/// Coverage of one triangle.
template <class F = Format16_8, class Samples, class Clip, Sink S>
[[nodiscard]] constexpr std::optional<InputError> cover(const Triangle& triangle, const View<Samples, Clip>& view,
                                                        S&& sink) {
  FixedTriangle<F> snapped;
  if (const auto error = snap<F>(triangle, snapped)) return error;
  cover<F>(snapped, view, sink);
  return std::nullopt;
}

template <class F = Format16_8, Sink S>
[[nodiscard]] constexpr std::optional<InputError> cover(const Triangle& triangle, const Target& target, S&& sink) {
  return cover<F>(triangle, View<>{target}, sink);
}

/// Coverage of one triangle, one sample a pixel, added to what `mask`, a mask of one sample a pixel, holds.
template <class F = Format16_8>
[[nodiscard]] constexpr std::optional<InputError> cover(const Triangle& triangle, const Mask& mask) {
  assert(mask.samples() == 1);
  return cover<F>(triangle, mask.target(), [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
}

/// Coverage of each triangle of a list on its own, in the order of the list.
template <class F = Format16_8, class Samples, class Clip, IndexedSink S>
[[nodiscard]] constexpr std::optional<InputError> cover_list(std::span<const Triangle> triangles,
                                                             const View<Samples, Clip>& view, S&& sink) {
  FixedTriangle<F> snapped;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (const auto error = snap<F>(triangles[i], snapped, i)) return error;
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    // Cannot fail: the same call succeeded above, before anything was drawn.
    static_cast<void>(snap<F>(triangles[i], snapped, i));
    cover<F>(snapped, view, [&](int y, int word, std::uint64_t bits) { sink(i, y, word, bits); });
  }
  return std::nullopt;
}

template <class F = Format16_8, IndexedSink S>
[[nodiscard]] constexpr std::optional<InputError> cover_list(std::span<const Triangle> triangles, const Target& target,
                                                             S&& sink) {
  return cover_list<F>(triangles, View<>{target}, sink);
}

/// Coverage of a list, one sample a pixel, added to what `mask`, a mask of one sample a pixel, holds: the union of its
/// triangles.
template <class F = Format16_8>
[[nodiscard]] constexpr std::optional<InputError> cover_list(std::span<const Triangle> triangles, const Mask& mask) {
  assert(mask.samples() == 1);
  return cover_list<F>(triangles, mask.target(),
                       [&](std::size_t, int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
}

}  // namespace edgecase::rasterizer
