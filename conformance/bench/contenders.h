// The contenders of each kind; contender.h has the list of them.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/bench/contender.h"
#include "rasterizer/fast/fast.h"
#include "rasterizer/rasterizer.h"

namespace edgecase::conformance {

/// A scene's triangles as rasterizer/ takes them, in the format F.
template <class F>
tl::expected<std::vector<rasterizer::FixedTriangle<F>>, Error> snap_all(const Scene& scene) {
  std::vector<rasterizer::FixedTriangle<F>> snapped(scene.triangles.size());
  for (std::size_t i = 0; i < snapped.size(); ++i) {
    const auto& [v0, v1, v2] = scene.triangles[i];
    const rasterizer::Triangle triangle{{{v0.x, v0.y}, {v1.x, v1.y}, {v2.x, v2.y}}};
    if (const auto error = rasterizer::snap<F>(triangle, snapped[i], i)) {
      return tl::unexpected(Error{ErrorKind::bad_input, rasterizer::describe(*error)});
    }
  }
  return snapped;
}

inline rasterizer::Target target_of(const Setting& setting) {
  return *rasterizer::Target::make(setting.target.width, setting.target.height);
}

/// Of lists up to so long that are drawn again and again a processor learns which way each branch goes, and is up to a
/// quarter faster than with triangles that it has not seen; longer ones it does not remember.
inline constexpr std::size_t kShortList = 10'000;

/// Another order for a short list.
template <class Triangle>
void shuffle_if_short(std::vector<Triangle>& triangles, std::mt19937_64& random) {
  if (triangles.size() <= kShortList) std::ranges::shuffle(triangles, random);
}

/// The baseline.
std::unique_ptr<Contender> make_plain_contender();

/// The vectorized plain loop by plain_name; `bits` is one of kSubpixelBits.
std::unique_ptr<Contender> make_vectorized_contender(int bits);

/// The fast path on one instruction set, all triangles into one strip mask.
std::unique_ptr<Contender> make_fast_contender(std::string_view name, const rasterizer::FastRasterizer& fast);

/// The same on as many threads as the machine has processors.
std::unique_ptr<Contender> make_threads_contender();

}  // namespace edgecase::conformance
