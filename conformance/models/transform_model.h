// TransformModel: what a rasterizer computes between a clip-space position and a point of the subpixel grid.
//
// A specification leaves all of it open but the result's accuracy: D3D11.3 allows 0.6 ULP in the snap, Vulkan and
// OpenGL say nothing of it. A model says it to the last bit, so that a wrong sample is a fault of the rasterizer's
// coverage, or of the model, and never "rounding". All arithmetic is binary32, to nearest even, each operation rounded
// on its own unless a model says fused; the build forbids contraction.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// ndc * half + centre, half and centre being half the viewport's size and its middle.
enum class MultiplyAdd {
  separate,  ///< the product is rounded, then the sum
  fused,     ///< one rounding, as std::fma
};

/// Rasterizers that have pixel centres at whole coordinates move everything by half a pixel, and round once more there.
enum class HalfPixelShift {
  none,             ///< round(x * 2^bits)
  before_scaling,   ///< round((x - 1/2) * 2^bits) + 2^bits / 2
  within_viewport,  ///< the viewport is scaled: round(ndc * (half * 2^bits) + (centre * 2^bits - 2^bits / 2)) + 2^bits
                    ///< / 2
};

/// A side of the view volume; `top` is y <= w, whatever the viewport makes of it.
enum class ClipPlane { left, right, bottom, top, near, far };

/// Which depth the near plane lies at.
enum class DepthRange {
  zero_to_w,     ///< Vulkan, Direct3D
  minus_w_to_w,  ///< OpenGL
};

/// How the point is found in which an edge crosses a plane; d is the signed distance, d >= 0 inside.
enum class Interpolation {
  /// t = dn / (dn - df), point = n + t * (f - n), n being the end with the smaller |d|, the inside end if they are
  /// equal.
  from_nearer_end,
  /// point = (df * n - dn * f) * (1 / (df - dn)), n being the inside end.
  crosswise,
};

/// What decides which way a triangle is wound.
enum class Winding {
  exact,  ///< its snapped vertices
  /// The area in binary32 of the vertices as they were before clipping, projected and snapped, turned by each negative
  /// w.
  binary32_before_clipping,
};

/// How the triangles that a clipped polygon is cut into make its coverage.
enum class Fill {
  each,  ///< each triangle on its own: a sample is covered if it is in any
  /// The outline as a whole: a sample is covered if it is in more triangles that are wound as Winding says, clockwise
  /// if it says nothing, than in triangles that rounding turned over.
  outline,
};

/// TransformModel::also_culls for all triangles of a scene together.
inline constexpr std::size_t kWholeDraw = std::numeric_limits<std::size_t>::max();

struct TransformModel {
  /// Of whom it is known.
  std::string_view name;
  /// The snap's grid and rounding.
  Rules rules;
  /// Of vertices that no plane cut off; those that clipping makes are always `separate`.
  MultiplyAdd multiply_add = MultiplyAdd::separate;
  HalfPixelShift shift = HalfPixelShift::none;
  HalfPixelShift multisample_shift = HalfPixelShift::none;
  DepthRange depth = DepthRange::zero_to_w;
  /// The planes of x and y lie at |x| = w / shrink, the distance to them being w -+ shrink * x, likewise y. 1 clips at
  /// the viewport's border; with less there is a guard band, and only the scissor confines what lies in it.
  float shrink = 1;
  float multisample_shrink = 1;
  /// The order in which a polygon is cut.
  std::array<ClipPlane, 6> planes{};
  Interpolation interpolation = Interpolation::from_nearer_end;
  Winding winding = Winding::exact;
  Fill fill = Fill::each;
  /// Where culling is asked for, triangles are culled a second time, by their binary32 area before the snap, if one of
  /// them is outside a plane: so many together, counted from the first of the draw. 1: each by itself; 0: none are.
  std::size_t also_culls = 0;
  /// Of what clipping left, that area is computed of each triangle's vertices with the fan's first one last, as where
  /// the last vertex is the provoking one: rounding may turn a sliver over.
  bool fan_ends_with_first = false;
  /// Pixels are drawn only from (int)(low + 0.499) to (int)(high - 0.501), low and high being the viewport's ends.
  bool viewport_scissor = false;
  /// The longest extent of a triangle in x or y, in pixels, for which the coverage is known to be exact.
  float max_extent = 16384;
  /// With several samples per pixel a scissor does not reject the right half of the column of pixels left of it, nor
  /// the lower half of the row above it, for triangles that reach into the scissor, if both lie in one 64x64 tile.
  bool loose_multisample_scissor = false;
};

/// Of any rasterizer, on its grid, as long as it follows exact_window_triangles (scene/window_position.h): where
/// nothing is cut or rounded, all models agree.
TransformModel exact_model(const Rules& rules);

/// Mesa's llvmpipe, 22.3.6 and 25.0.7, through Vulkan, on a processor with fused multiply-add.
const TransformModel& lavapipe_model();
/// The same with a B8G8R8A8 target, for which it takes a guard band unless it is multisampled.
const TransformModel& lavapipe_bgra8_model();
/// The same through OpenGL.
const TransformModel& osmesa_llvmpipe_model();
/// SwiftShader, built for 4 subpixel bits as Debian's chromium package is.
const TransformModel& swiftshader_model();

/// The model known for a subject, by its name or, for `vulkan:...`, by the device that it reports; null if there is
/// none.
const TransformModel* find_transform_model(std::string_view subject, std::string_view device);

/// The scale and offset of one axis, as a driver derives them from the viewport's origin and size.
struct AxisTransform {
  float half = 0;
  float centre = 0;

  static AxisTransform of(float origin, float extent) {
    const float half = 0.5F * extent;
    return {half, origin + half};
  }
};

struct Transformed {
  float snapped = 0;  ///< a multiple of 2^-bits px
  float window = 0;   ///< px, before any snap
};

/// Where the vertex is taken to when its homogeneous coordinate is `clip` and `inverse_w` is 1 / w rounded.
/// `multiply_add` is given apart because vertices from clipping differ in it. Nothing if the result is not finite or
/// the grid has no such point in binary32.
std::optional<Transformed> transformed(const TransformModel& model, const AxisTransform& axis, MultiplyAdd multiply_add,
                                       bool multisampled, float clip, float inverse_w);

/// `position` on the grid, as the model snaps a window coordinate that passes the viewport transform unchanged
/// (enclosing_viewport.h). Nothing if it is not finite or the grid has no such point in binary32.
std::optional<Position> snapped(const TransformModel& model, const Setting& setting, const Position& position);

}  // namespace edgecase::conformance
