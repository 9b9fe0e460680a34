// Vertices that need no snapping, because they lie on the subpixel grid, from binary32 pixels to integers.
#include "rasterizer/fast/lanes-inl.h"

#if defined(EDGECASE_FAST_GRID_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_GRID_INL_H_
#undef EDGECASE_FAST_GRID_INL_H_
#else
#define EDGECASE_FAST_GRID_INL_H_
#endif

#include <cmath>
#include <cstring>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// FastRasterizer::snap_on_grid(). Coordinates are scaled exactly. A cast there and back leaves whole numbers within
/// reach as they are, and nothing else that is within reach. No NaN is, and only what is may be cast.
inline bool snap_on_grid(std::span<const Triangle> triangles, FixedTriangle<Format16_8>* snapped) {
  static_assert(sizeof(Triangle) == 6 * sizeof(float) && sizeof(*snapped) == 6 * sizeof(std::int32_t));
  constexpr float kScale = 1 << Format16_8::kSubpixelBits;
  constexpr float kReach = FastRasterizer::kGridReach * kScale;
  static_assert(kReach <= static_cast<float>(Format16_8::Coordinate::kMax) && kReach <= 0x1p24F);
  const auto d = DF32();
  const auto* pixels = reinterpret_cast<const float*>(triangles.data());
  auto* to = reinterpret_cast<std::int32_t*>(snapped);
  const std::size_t count = 6 * triangles.size();
  const auto each_on_grid = [&](F32 pixel, I32& whole) HWY_ATTR {
    const F32 scaled = hn::Mul(pixel, hn::Set(d, kScale));
    const auto in_reach = hn::Lt(hn::Abs(scaled), hn::Set(d, kReach));
    whole = hn::ConvertTo(DI32(), hn::IfThenElseZero(in_reach, scaled));
    return hn::And(hn::Eq(hn::ConvertTo(d, whole), scaled), in_reach);
  };
  auto on_grid = hn::Eq(hn::Zero(d), hn::Zero(d));
  I32 whole;
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    on_grid = hn::And(on_grid, each_on_grid(hn::LoadU(d, pixels + i), whole));
    hn::StoreU(whole, DI32(), to + i);
  }
  HWY_ALIGN float rest[kLanes] = {};
  HWY_ALIGN std::int32_t rest_whole[kLanes];
  std::memcpy(rest, pixels + i, (count - i) * sizeof(float));
  on_grid = hn::And(on_grid, each_on_grid(hn::Load(d, rest), whole));
  hn::Store(whole, DI32(), rest_whole);
  std::memcpy(to + i, rest_whole, (count - i) * sizeof(std::int32_t));
  return hn::AllTrue(d, on_grid);
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
