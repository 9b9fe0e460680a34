// For tests of transform models: random triangles in clip space, and the count of samples that a model mispredicts.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "conformance/models/llvmpipe_wrap.h"
#include "conformance/models/window_scene.h"
#include "conformance/tests/driver_subject_checks.h"

namespace edgecase::conformance {

/// What the w of the vertices is.
enum class Homogeneous { one, positive, either_sign };

struct ClipFamily {
  Homogeneous w = Homogeneous::one;
  /// |x / w| and |y / w| go up to this: 1 stays inside.
  float reach = 1;
  /// z / w goes from -depth_reach to 1 + depth_reach; negative: 1/2 throughout.
  float depth_reach = -1;
  /// If positive, x / w, y / w and z / w are multiples of 1 / lattice, as those on the planes themselves are.
  int lattice = 0;
};

inline ClipTriangle random_clip_triangle(const ClipFamily& family, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto ratio = [&](float low, float high) {
    const float value = low + (high - low) * (0.5F + 0.5F * unit(random));
    if (family.lattice == 0) return value;
    const auto steps = static_cast<float>(family.lattice);
    return std::nearbyint(value * steps) / steps;
  };
  ClipTriangle triangle;
  for (ClipPosition& p : triangle) {
    p.w = 1;
    if (family.w != Homogeneous::one) p.w = std::exp2(2 * unit(random));
    if (family.lattice != 0) p.w = std::exp2(std::nearbyint(std::log2(p.w)));
    p.x = ratio(-family.reach, family.reach) * p.w;
    p.y = ratio(-family.reach, family.reach) * p.w;
    p.z = (family.depth_reach < 0 ? 0.5F : ratio(-family.depth_reach, 1 + family.depth_reach)) * p.w;
    if (family.w == Homogeneous::either_sign && random() % 3 == 0) p.w = -p.w;
  }
  return triangle;
}

inline Scene clip_scene(const Setting& setting, const Viewport& viewport, const ClipFamily& family, std::size_t count,
                        unsigned seed) {
  Scene scene;
  scene.setting = setting;
  scene.clip.emplace();
  scene.clip->viewport = viewport;
  std::mt19937 random(seed);
  while (scene.clip->triangles.size() < count) scene.clip->triangles.push_back(random_clip_triangle(family, random));
  return scene;
}

struct Tally {
  std::size_t triangles = 0;
  std::size_t unpredicted = 0;
  std::size_t covered = 0;  ///< samples, by the driver
  std::size_t wrong = 0;    ///< samples
  std::string first;        ///< the first triangle with a wrong sample

  Tally& operator+=(const Tally& other) {
    triangles += other.triangles;
    unpredicted += other.unpredicted;
    covered += other.covered;
    wrong += other.wrong;
    if (first.empty()) first = other.first;
    return *this;
  }
};

inline std::string described(const Scene& scene, std::size_t i) {
  std::ostringstream text;
  text << std::hexfloat << "triangle " << i;
  if (scene.clip) {
    const Viewport& v = scene.clip->viewport;
    text << " in the viewport " << std::defaultfloat << v.x << ", " << v.y << ", " << v.width << "x" << v.height
         << std::hexfloat;
    for (const ClipPosition& p : scene.clip->triangles[i])
      text << " (" << p.x << ", " << p.y << ", " << p.z << ", " << p.w << ")";
  } else {
    for (const Position& p : scene.triangles[i]) text << " (" << p.x << ", " << p.y << ")";
  }
  return text.str();
}

/// What the model makes of the scene, with our own rasterizer and llvmpipe's wrap, against the masks that a driver
/// drew.
inline Tally compared(const MaskBatch& found, const TransformModel& model, const Scene& scene) {
  static const std::unique_ptr<Subject> exact = subject_or_failure("edgecase");
  Tally tally;
  const WindowScene window = window_scene(model, scene);
  MaskBatch predicted;
  MaskBatch parts = drawn(*exact, window.scene);
  const bool llvmpipe = model.name != swiftshader_model().name;
  // Where the scissor is loose, what wraps is left to the runs, which draw each part within the scissor itself.
  const bool loose = window.region.reach().told() != window.region.reach().all();
  std::vector<bool> wraps(window.size());
  for (std::size_t i = 0; llvmpipe && i < window.size(); ++i) {
    for (std::size_t p = window.first[i]; p < window.first[i + 1]; ++p) {
      const Triangle& part = window.scene.triangles[p];
      if (predict_llvmpipe_wrap(window.scene.setting, part, parts[p])) wraps[i] = true;
    }
  }
  unite(window, parts, predicted);
  tally.triangles = window.size();
  tally.unpredicted = window.unpredicted.size();
  if (found.size() != predicted.size()) {
    ADD_FAILURE() << found.size() << " masks for " << predicted.size() << " triangles";
    return tally;
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::ranges::binary_search(window.unpredicted, i) || (loose && wraps[i])) continue;
    std::size_t wrong = 0;
    for (std::size_t word = 0; word < found[i].size(); ++word) {
      tally.covered += static_cast<std::size_t>(std::popcount(found[i][word]));
      wrong += static_cast<std::size_t>(std::popcount(found[i][word] ^ predicted[i][word]));
    }
    tally.wrong += wrong;
    if (wrong != 0 && tally.first.empty()) tally.first = described(scene, i);
  }
  return tally;
}

inline Tally compared(Subject& driver, const TransformModel& model, const Scene& scene) {
  return compared(drawn(driver, scene), model, scene);
}

}  // namespace edgecase::conformance
