// The sample locations that Vulkan (standardSampleLocations) and Direct3D give to each sample count.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "conformance/scene/setting.h"

namespace edgecase::conformance {

/// The standard locations for `samples` samples, or an empty span for a count other than 1, 2, 4, 8 and 16.
/// Source: Vulkan specification, "Multisampling", table of standard sample locations, in sixteenths of a pixel.
inline std::span<const SampleLocation> standard_sample_locations(int samples) {
  using L = SampleLocation;
  static constexpr std::array<L, 1> kOne{L{8, 8}};
  static constexpr std::array<L, 2> kTwo{L{12, 12}, L{4, 4}};
  static constexpr std::array<L, 4> kFour{L{6, 2}, L{14, 6}, L{2, 10}, L{10, 14}};
  static constexpr std::array<L, 8> kEight{L{9, 5},  L{7, 11}, L{13, 9},  L{5, 3},
                                           L{3, 13}, L{1, 7},  L{11, 15}, L{15, 1}};
  static constexpr std::array<L, 16> kSixteen{L{9, 9},   L{7, 5},  L{5, 10},  L{12, 7}, L{3, 6}, L{10, 13},
                                              L{13, 11}, L{11, 3}, L{6, 14},  L{8, 1},  L{4, 2}, L{2, 12},
                                              L{0, 8},   L{15, 4}, L{14, 15}, L{1, 0}};
  switch (samples) {
    case 1:
      return kOne;
    case 2:
      return kTwo;
    case 4:
      return kFour;
    case 8:
      return kEight;
    case 16:
      return kSixteen;
    default:
      return {};
  }
}

/// Whether `setting` samples every pixel at the standard locations of its sample count.
inline bool has_standard_samples(const Setting& setting) {
  return !setting.sample_locations.empty() &&
         std::ranges::equal(setting.sample_locations, standard_sample_locations(setting.samples()));
}

}  // namespace edgecase::conformance
