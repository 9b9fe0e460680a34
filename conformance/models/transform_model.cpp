#include "conformance/models/transform_model.h"

#include <cmath>
#include <cstdint>

#include "conformance/scene/nearest_even.h"

namespace edgecase::conformance {
namespace {

float rounded(SnapRounding rounding, float value) {
  switch (rounding) {
    case SnapRounding::nearest_even:
      return nearest_even(value);
    case SnapRounding::half_up:  // in double, where the sum is exact
      return static_cast<float>(std::floor(static_cast<double>(value) + 0.5));
    case SnapRounding::half_away:
      return std::round(value);
    case SnapRounding::truncate:
      return std::trunc(value);
  }
  return value;
}

float multiply_add(MultiplyAdd how, float a, float b, float c) {
  if (how == MultiplyAdd::fused) return std::fma(a, b, c);
  const float product = a * b;
  return product + c;
}

float grid_scale(const TransformModel& model) {
  return static_cast<float>(std::int64_t{1} << model.rules.subpixel_bits);
}

HalfPixelShift shift_of(const TransformModel& model, bool multisampled) {
  return multisampled ? model.multisample_shift : model.shift;
}

// Of any number; see on_grid().
[[gnu::noinline]] std::optional<float> checked_on_grid(const TransformModel& model, double from_corner, float scaled) {
  const auto scale = static_cast<double>(grid_scale(model));
  const double grid = static_cast<double>(rounded(model.rules.rounding, scaled)) + from_corner;
  const auto result = static_cast<float>(grid / scale);
  if (!std::isfinite(result) || static_cast<double>(result) * scale != grid) return std::nullopt;
  return result;
}

// `scaled`: in subpixels, from a pixel's corner or, after a shift, from its centre. Within 2^22 of the origin a point
// of the grid, or one half a subpixel beside it as there may be without any subpixel bits, has no more than 24 bits.
inline std::optional<float> on_grid(const TransformModel& model, HalfPixelShift shift, float scaled) {
  const float scale = grid_scale(model);
  const float from_corner = shift == HalfPixelShift::none ? 0 : scale / 2;
  if (model.rules.rounding != SnapRounding::nearest_even || !(std::abs(scaled) + scale < 0x1p22F)) {
    return checked_on_grid(model, static_cast<double>(from_corner), scaled);
  }
  return (nearest_even(scaled) + from_corner) / scale;
}

std::optional<float> window_on_grid(const TransformModel& model, HalfPixelShift shift, float window) {
  const float scale = grid_scale(model);
  switch (shift) {
    case HalfPixelShift::none:
      return on_grid(model, shift, window * scale);
    case HalfPixelShift::before_scaling:
      return on_grid(model, shift, (window - 0.5F) * scale);
    case HalfPixelShift::within_viewport:
      return on_grid(model, shift, window * scale - scale / 2);
  }
  return std::nullopt;
}

using enum ClipPlane;

constexpr TransformModel kLavapipe{
    .name = "lavapipe",
    .rules = {8, SnapRounding::nearest_even},
    .multiply_add = MultiplyAdd::fused,
    .shift = HalfPixelShift::before_scaling,
    .multisample_shift = HalfPixelShift::none,
    .depth = DepthRange::zero_to_w,
    .shrink = 1,
    .multisample_shrink = 1,
    .planes = {right, left, top, bottom, near, far},
    .interpolation = Interpolation::from_nearer_end,
    .winding = Winding::exact,
    .fill = Fill::each,
    .also_culls = 1365,  // what its draw module has at once: 4,095 vertices
    .fan_ends_with_first = false,
    .viewport_scissor = true,
    .loose_multisample_scissor = true,
};

constexpr TransformModel osmesa() {
  TransformModel model = kLavapipe;
  model.name = "osmesa-llvmpipe";
  model.depth = DepthRange::minus_w_to_w;
  model.fan_ends_with_first = true;
  model.viewport_scissor = false;
  return model;
}
constexpr TransformModel kOsmesaLlvmpipe = osmesa();

constexpr TransformModel bgra8() {
  TransformModel model = kLavapipe;
  model.name = "lavapipe:bgra8";
  model.shrink = 0.5F;
  return model;
}
constexpr TransformModel kLavapipeBgra8 = bgra8();

constexpr TransformModel kSwiftshader{
    .name = "swiftshader",
    .rules = {4, SnapRounding::nearest_even},
    .multiply_add = MultiplyAdd::separate,
    .shift = HalfPixelShift::within_viewport,
    .multisample_shift = HalfPixelShift::within_viewport,
    .depth = DepthRange::zero_to_w,
    .shrink = 1,
    .multisample_shrink = 1,
    .planes = {near, far, left, right, top, bottom},
    .interpolation = Interpolation::crosswise,
    .winding = Winding::binary32_before_clipping,
    .fill = Fill::outline,
    .also_culls = 0,
    .fan_ends_with_first = false,
    .viewport_scissor = false,
    .loose_multisample_scissor = false,
};

}  // namespace

TransformModel exact_model(const Rules& rules) { return {.name = "exact", .rules = rules, .planes = kLavapipe.planes}; }

const TransformModel& lavapipe_model() { return kLavapipe; }
const TransformModel& osmesa_llvmpipe_model() { return kOsmesaLlvmpipe; }
const TransformModel& swiftshader_model() { return kSwiftshader; }

const TransformModel& lavapipe_bgra8_model() { return kLavapipeBgra8; }

const TransformModel* find_transform_model(std::string_view subject, std::string_view device) {
  for (const TransformModel* model : {&kLavapipe, &kLavapipeBgra8, &kOsmesaLlvmpipe, &kSwiftshader}) {
    if (model->name == subject) return model;
  }
  if (!subject.starts_with("vulkan:")) return nullptr;
  if (device.find("llvmpipe") != std::string_view::npos) return &kLavapipe;
  if (device.find("SwiftShader") != std::string_view::npos) return &kSwiftshader;
  return nullptr;
}

std::optional<Transformed> transformed(const TransformModel& model, const AxisTransform& axis, MultiplyAdd how,
                                       bool multisampled, float clip, float inverse_w) {
  const HalfPixelShift shift = shift_of(model, multisampled);
  const float ndc = clip * inverse_w;
  const float window = multiply_add(how, ndc, axis.half, axis.centre);
  std::optional<float> snapped;
  if (shift == HalfPixelShift::within_viewport) {
    const float scale = grid_scale(model);
    const float half = axis.half * scale;
    const float centre = axis.centre * scale - scale / 2;
    snapped = on_grid(model, shift, multiply_add(how, ndc, half, centre));
  } else {
    snapped = window_on_grid(model, shift, window);
  }
  if (!snapped) return std::nullopt;
  return Transformed{*snapped, window};
}

std::optional<Position> snapped(const TransformModel& model, const Setting& setting, const Position& position) {
  const HalfPixelShift shift = shift_of(model, setting.samples() > 1);
  const auto x = window_on_grid(model, shift, position.x);
  const auto y = window_on_grid(model, shift, position.y);
  if (!x || !y) return std::nullopt;
  return Position{*x, *y};
}

}  // namespace edgecase::conformance
