// Everything of a scene but its geometry: where coverage is asked for, and which rules decide it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace edgecase::conformance {

/// Size of a render target in pixels, each from 1 to 16,384.
struct Extent {
  int width = 0;
  int height = 0;
  friend bool operator==(const Extent&, const Extent&) = default;
};

inline constexpr int kMaxTargetExtent = 16384;

/// A rectangle of pixels x .. x + width - 1, y .. y + height - 1. It may lie partly or wholly outside the target; with
/// a width or height of zero or less it holds no pixel.
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  friend bool operator==(const Rect&, const Rect&) = default;
};

/// Where a sample lies in its pixel, in sixteenths of a pixel from the pixel's top-left corner; each from 0 to 15.
struct SampleLocation {
  int x = 8;
  int y = 8;
  friend bool operator==(const SampleLocation&, const SampleLocation&) = default;
};

inline constexpr int kSampleGridBits = 4;

/// How a window coordinate that lies between two points of the subpixel grid is moved to one of them.
/// Ties are coordinates exactly half way. `nearest_even` is what the D3D11.3 functional specification, 3.2.4.1, asks
/// for.
enum class SnapRounding { nearest_even, half_up, half_away, truncate };

/// Which triangles are dropped by the way they face. A triangle of zero area after snapping covers nothing in any case.
enum class CullMode { none, front, back };

/// Which winding on the screen (y down) is the front of a triangle; decided by the snapped vertices.
enum class FrontFace { clockwise, counter_clockwise };

/// What the specifications leave open and a rasterizer has to choose.
struct Rules {
  /// Fraction bits of a window coordinate, 0 to 16. D3D11 demands 8; Vulkan and OpenGL at least 4.
  int subpixel_bits = 8;
  SnapRounding rounding = SnapRounding::nearest_even;
  /// Whether half a pixel is subtracted from the coordinate in binary32 before it is scaled and rounded, and added back
  /// afterwards, as rasterizers do that put pixel centres on whole numbers. The subtraction itself may round: a
  /// coordinate just past a tie then becomes the tie. D3D11's tolerance of 0.6 units allows that; it shows within 2^-24
  /// px of a tie.
  bool half_pixel_first = false;
  friend bool operator==(const Rules&, const Rules&) = default;
};

/// The target and its samples. The same locations hold in every pixel; their number is the sample count.
struct Setting {
  Extent target{32, 32};
  std::vector<SampleLocation> sample_locations = std::vector<SampleLocation>(1);  ///< one sample in the centre
  /// Samples of pixels outside it are never covered. It does not change the target or the layout of its masks.
  std::optional<Rect> scissor{};
  CullMode cull = CullMode::none;
  FrontFace front_face = FrontFace::clockwise;

  int samples() const { return static_cast<int>(sample_locations.size()); }
  friend bool operator==(const Setting&, const Setting&) = default;
};

}  // namespace edgecase::conformance
