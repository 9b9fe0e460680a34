// Triangles of any size set up for drawing, a triangle to a lane: their edges' crossings with the rows above and below
// the middle vertex.
#include "rasterizer/fast/bands-inl.h"

#if defined(EDGECASE_FAST_HALVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_HALVES_INL_H_
#undef EDGECASE_FAST_HALVES_INL_H_
#else
#define EDGECASE_FAST_HALVES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// A triangle above and below its middle vertex: rows that one left and one right edge cross, none or more of each.
struct Halves {
  struct Half {
    Crossings left, right;  ///< from row `begin` on, if that is before `end`
    int begin, end;
  };
  Half upper, lower;
  bool in_bands;  ///< how they are to be drawn
};

#if HWY_TARGET == HWY_SCALAR
using DF64 = hn::CappedTag<double, 1>;
inline constexpr std::size_t kWideVectors = 1;
#else
using DF64 = hn::Repartition<double, DI32>;
inline constexpr std::size_t kWideVectors = 2;
#endif
using F64 = hn::Vec<DF64>;
inline constexpr std::size_t kWideLanes = kLanes / kWideVectors;

/// kWideLanes of the lanes.
HWY_INLINE F64 widened(I32 v, [[maybe_unused]] std::size_t half) {
#if HWY_TARGET == HWY_SCALAR
  return hn::PromoteTo(DF64(), v);
#else
  const hn::Half<DI32> d;
  return hn::PromoteTo(DF64(), half == 0 ? hn::LowerHalf(d, v) : hn::UpperHalf(d, v));
#endif
}

using Difference = decltype(ShiftedFormat::Coordinate() - ShiftedFormat::Coordinate());
static_assert(Difference::kBits <= 32);
static_assert(decltype(Difference() * Difference() + Difference() * Difference())::kBits <= 54);

/// The Halves of kLanes triangles, a triangle to a lane. In binary64: all numbers but the scale, t and the slope of an
/// edge are integers of at most 53 bits and a sign, or such by 2^8, and exact.
class LaneHalves {
 public:
  /// Of vertices sorted by y.
  HWY_INLINE LaneHalves(const LaneVertices& v, int width, int height) {
    const auto d = DI32();
    const auto first_row = [&](I32 y)
                               HWY_ATTR { return hn::Min(hn::Max(first_sample(y), hn::Zero(d)), hn::Set(d, height)); };
    const I32 top = first_row(v.y[0]), middle = first_row(v.y[1]), bottom = first_row(v.y[2]);
    hn::Store(top, d, top_);
    hn::Store(middle, d, middle_);
    hn::Store(bottom, d, bottom_);
    const I32 leftmost = hn::Min(hn::Min(v.x[0], v.x[1]), v.x[2]);
    const I32 rightmost = hn::Max(hn::Max(v.x[0], v.x[1]), v.x[2]);
    const auto room = [&](I32 value, std::int64_t most)
                          HWY_ATTR { return hn::Sub(hn::Set(d, static_cast<std::int32_t>(most)), value); };
    const I32 rooms = hn::Or(hn::Or(leftmost, room(rightmost, std::int64_t{width} * 256)),
                             hn::Or(room(hn::Sub(rightmost, leftmost), kMostBandExtent * 256),
                                    room(hn::Sub(v.y[2], v.y[0]), kMostBandHeight)));
    in_bands_ = bits_of(hn::Gt(rooms, hn::Set(d, -1)));
    for (std::size_t half = 0; half < kWideVectors; ++half) {
      F64 x[3], y[3];
      for (std::size_t i = 0; i < 3; ++i) x[i] = widened(v.x[i], half), y[i] = widened(v.y[i], half);
      const F64 rows[] = {widened(top, half), widened(middle, half), widened(bottom, half)};
      const auto longer_is_left =
          hn::Lt(hn::Mul(hn::Sub(x[2], x[0]), hn::Sub(y[1], y[0])), hn::Mul(hn::Sub(x[1], x[0]), hn::Sub(y[2], y[0])));
      std::uint64_t bits = 0;
      hn::StoreMaskBits(DF64(), longer_is_left, reinterpret_cast<std::uint8_t*>(&bits));
      longer_is_left_ |= bits << (half * kWideLanes);
      store(x[0], y[0], x[2], y[2], rows[0], rows[2], half, longer_);
      store(x[0], y[0], x[1], y[1], rows[0], rows[1], half, upper_);
      store(x[1], y[1], x[2], y[2], rows[1], rows[2], half, lower_);
    }
  }

  HWY_INLINE Halves of(std::size_t lane) const {
    const int top = top_[lane], middle = middle_[lane], bottom = bottom_[lane];
    const bool longer_is_left = (longer_is_left_ >> lane & 1) != 0;
    Halves halves;
    halves.in_bands = (in_bands_ >> lane & 1) != 0;
    halves.upper.begin = top;
    halves.upper.end = halves.lower.begin = middle;
    halves.lower.end = bottom;
    if (top >= bottom) return halves;
    const auto set = [&](Halves::Half& half, const Crossings& longer, const Crossings& shorter) {
      half.left = longer_is_left ? longer : shorter;
      half.right = longer_is_left ? shorter : longer;
    };
    Crossings longer = longer_.of(lane);
    if (top < middle) set(halves.upper, longer, upper_.of(lane));
    longer.skip(middle - top);
    if (middle < bottom) set(halves.lower, longer, lower_.of(lane));
    return halves;
  }

 private:
  struct Edges {
    HWY_ALIGN double t[kMaxLanes], slope[kMaxLanes];
    /// Of an edge that has rows.
    HWY_INLINE Crossings of(std::size_t lane) const {
      return {static_cast<std::int64_t>(t[lane]), static_cast<std::int64_t>(slope[lane])};
    }
  };

  /// From a to b, from row `first` on. Of an edge of one row no slope is used, which could be too large; those without
  /// any are anything.
  static HWY_INLINE void store(F64 xa, F64 ya, F64 xb, F64 yb, F64 first, F64 end, std::size_t half, Edges& edges) {
    const DF64 d;
    const F64 dx = hn::Sub(xb, xa), dy = hn::Sub(yb, ya), one = hn::Set(d, 1.0);
    const F64 row = hn::MulAdd(first, hn::Set(d, 256.0), hn::Sub(hn::Set(d, 128.0), ya));
    const F64 n = hn::MulAdd(dy, hn::Sub(xa, hn::Set(d, 128.0)), hn::Mul(dx, row));
    const F64 c = hn::Floor(hn::Mul(hn::Add(n, hn::Set(d, 255.0)), hn::Set(d, 0x1p-8)));
    const F64 scale = hn::Div(hn::Set(d, 0x1p43), dy);
    const F64 doubled = hn::Add(c, hn::Add(c, hn::Sub(hn::Add(dy, dy), one)));
    const auto slopes = hn::Gt(hn::Sub(end, first), one);
    hn::Store(hn::Mul(doubled, scale), d, edges.t + half * kWideLanes);
    hn::Store(hn::IfThenElseZero(slopes, hn::Mul(hn::Add(dx, dx), scale)), d, edges.slope + half * kWideLanes);
  }

  HWY_ALIGN std::int32_t top_[kMaxLanes], middle_[kMaxLanes], bottom_[kMaxLanes];
  Edges longer_, upper_, lower_;
  std::uint64_t longer_is_left_ = 0;
  std::uint64_t in_bands_;
};

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
