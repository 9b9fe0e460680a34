// Small triangles, a triangle to a lane: setup of any triangle up to 64 px, and rows of those up to 31 x 16 px.
//
// Rows. With the vertices sorted by y, every row of samples that meets the triangle, ceil(y0 - 1/2) <= row < ceil(y2 -
// 1/2), crosses the long edge, v0 to v2, and one short edge: v0 to v1 in the rows before ceil(y1 - 1/2), v1 to v2 from
// there on. Horizontal edges are crossed by no row. Where the crossings are x1 and x2, the samples covered are those
// with min <= x < max: the top-left rule, because the sample moved by (e, e^2) is right of a crossing at X if and only
// if x >= X. So each crossing is turned into the number of samples left of it,
//
//   count(row) = #{i : 2^8 i + 2^7 < X} = ceil((X - 2^7) / 2^8),   X in subpixels from the strip's left side,
//
// and a row's mask is the bits from one count on, exclusive or the bits from the other on: whichever is the lesser, and
// nothing if they are equal, which makes winding, zero area and empty rows no cases at all.
//
// Exactness. On the edge from (xa, ya) to (xb, yb), dx = xb - xa, dy = yb - ya > 0, at the row with Y = 2^8 row + 2^7,
//
//   count = ceil(n / (2^8 dy)),  n = dy (xa - 2^7) + dx (Y - ya),
//         = ceil(c / dy),        c = ceil(n / 2^8), as ceil(ceil(n / p) / q) = ceil(n / (p q)),
//
// where one row adds dx to c. An integer c over dy is either an integer or at least 1/dy from one, hence (c - 1/2) / dy
// is at least 1/(2 dy) from every integer, and
//
//   count = round((c - 1/2) / dy + 1/2) = round(k / (2 dy)),  k = 2 c - 1 + dy,
//
// exactly, whatever arithmetic has an error below 1/(2 dy). In binary32: k is an integer below 2^24 and thus exact, its
// steps, 2 dx, too; the reciprocal of 2 dy and the product each have a relative error of at most 2^-24.
#include "rasterizer/fast/bits-inl.h"

#if defined(EDGECASE_FAST_SMALL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_SMALL_INL_H_
#undef EDGECASE_FAST_SMALL_INL_H_
#else
#define EDGECASE_FAST_SMALL_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// The crossings of an edge with the rows from its first one on.
struct LaneEdge {
  F32 k;      ///< of its first row
  F32 step;   ///< from row to row
  F32 scale;  ///< 1 / (2 dy)
};

/// Triangles of at most kMediumExtent px, one to a lane, in pixels and rows; those larger have no valid edges.
struct LaneSetup {
  I32 strip_left;  ///< the first column of the strip in which the leftmost sample lies
  I32 left;        ///< columns left <= x < right and rows top <= y < bottom hold all samples
  I32 right;
  I32 top;
  I32 middle;  ///< where the second short edge takes over
  I32 bottom;
  LaneEdge longer;
  LaneEdge upper;
  LaneEdge lower;
};

struct LaneVertices {
  I32 x[3];
  I32 y[3];
};

// The largest numbers of a setup of a triangle of E columns of samples, H rows of samples: its x extent is below E + 1
// px, its y extent below H + 1 px, and up to 31 px separate it from the strip's left side.
constexpr double largest_sum(int columns, int rows) {
  const double dx = (columns + 1) * 256.0, dy = (rows + 1) * 256.0;
  return dy * (dx + 32 * 256.0) + dx * 256.0;  // |n| in the first row of an edge
}
constexpr double largest_k(int columns, int rows) {
  const double dx = (columns + 1) * 256.0, dy = (rows + 1) * 256.0;
  return 2 * (largest_sum(columns, rows) / 256 + 1) + 1 + dy + 2 * dx * (rows + 1);  // and H rows beyond either end
}
constexpr bool float_decides(int columns, int rows) {
  const double dy = (rows + 1) * 256.0;
  const double largest_count = columns + 1 + 32;
  return largest_sum(columns, rows) < 0x1p31 && largest_k(columns, rows) < 0x1p24 &&
         (largest_count + 1) * 0x1p-24 * 2.001 < 1 / (2 * dy);
}
static_assert(float_decides(kMediumExtent, kMediumExtent));
static_assert(kSmallColumns <= kMediumExtent && kSmallRows <= kMediumExtent);

HWY_INLINE void sort_by_y(I32& xa, I32& ya, I32& xb, I32& yb) {
  const auto swap = hn::Lt(yb, ya);
  const I32 x = hn::IfThenElse(swap, xb, xa);
  xb = hn::IfThenElse(swap, xa, xb);
  xa = x;
  const I32 y = hn::Min(ya, yb);
  yb = hn::Max(ya, yb);
  ya = y;
}

/// ceil((v - 1/2 px) / 1 px): the first sample at or beyond v.
HWY_INLINE I32 first_sample(I32 v) { return hn::ShiftRight<8>(hn::Add(v, hn::Set(DI32(), 127))); }

/// From a to b, as much of it as does not depend on where the samples are.
struct LaneSlope {
  I32 dx;
  I32 dy;
  F32 step;
  F32 scale;
};

/// Triangles with their vertices sorted by y.
struct LaneTriangle {
  I32 x[3];
  I32 y[3];
  I32 leftmost;
  I32 rightmost;
  LaneSlope longer;
  LaneSlope upper;
  LaneSlope lower;
};

HWY_INLINE LaneSlope make_lane_slope(I32 xa, I32 ya, I32 xb, I32 yb) {
  const auto d = DI32();
  // An edge that no row crosses may be horizontal, and then only must not divide by zero.
  const I32 dy = hn::Max(hn::Sub(yb, ya), hn::Set(d, 1));
  const I32 dx = hn::Sub(xb, xa);
  const F32 doubled = hn::ConvertTo(DF32(), hn::Add(dy, dy));
  return {dx, dy, hn::ConvertTo(DF32(), hn::Add(dx, dx)), hn::Div(hn::Set(DF32(), 1.0f), doubled)};
}

HWY_INLINE void sort_by_y(LaneVertices& v) {
  sort_by_y(v.x[0], v.y[0], v.x[1], v.y[1]);
  sort_by_y(v.x[1], v.y[1], v.x[2], v.y[2]);
  sort_by_y(v.x[0], v.y[0], v.x[1], v.y[1]);
}

HWY_INLINE LaneTriangle make_lane_triangle(LaneVertices v) {
  sort_by_y(v);
  LaneTriangle t;
  for (std::size_t i = 0; i < 3; ++i) t.x[i] = v.x[i], t.y[i] = v.y[i];
  t.leftmost = hn::Min(hn::Min(v.x[0], v.x[1]), v.x[2]);
  t.rightmost = hn::Max(hn::Max(v.x[0], v.x[1]), v.x[2]);
  t.longer = make_lane_slope(v.x[0], v.y[0], v.x[2], v.y[2]);
  t.upper = make_lane_slope(v.x[0], v.y[0], v.x[1], v.y[1]);
  t.lower = make_lane_slope(v.x[1], v.y[1], v.x[2], v.y[2]);
  return t;
}

/// The edge that begins at (xa, ya), from row `row` on.
HWY_INLINE LaneEdge make_lane_edge(const LaneSlope& slope, I32 xa, I32 ya, I32 strip_left, I32 row) {
  const auto d = DI32();
  const I32 half = hn::Set(d, 128);
  const I32 x = hn::Sub(xa, hn::Add(hn::ShiftLeft<8>(strip_left), half));
  const I32 y = hn::Sub(hn::Add(hn::ShiftLeft<8>(row), half), ya);
  const I32 n = hn::Add(hn::Mul(slope.dy, x), hn::Mul(slope.dx, y));
  const I32 c = hn::ShiftRight<8>(hn::Add(n, hn::Set(d, 255)));
  const I32 k = hn::Add(hn::Add(c, c), hn::Sub(slope.dy, hn::Set(d, 1)));
  return {hn::ConvertTo(DF32(), k), slope.step, slope.scale};
}

/// The setup of the triangles moved by `shift`. Moving changes neither extents nor slopes, so float_decides() holds.
template <class Shift>
HWY_INLINE LaneSetup make_lane_setup(const LaneTriangle& t, const Shift& shift) {
  const I32 x0 = shift.x(t.x[0]), x1 = shift.x(t.x[1]);
  const I32 y0 = shift.y(t.y[0]), y1 = shift.y(t.y[1]);
  LaneSetup s;
  s.left = first_sample(shift.x(t.leftmost));
  s.right = first_sample(shift.x(t.rightmost));
  s.strip_left = hn::And(s.left, hn::Set(DI32(), -kStripWidth));
  s.top = first_sample(y0);
  s.middle = first_sample(y1);
  s.bottom = first_sample(shift.y(t.y[2]));
  s.longer = make_lane_edge(t.longer, x0, y0, s.strip_left, s.top);
  s.upper = make_lane_edge(t.upper, x0, y0, s.strip_left, s.top);
  s.lower = make_lane_edge(t.lower, x1, y1, s.strip_left, s.middle);
  return s;
}

/// Added to a float, it rounds that to an integer: in a float of [2^23, 2^24) the last bit of the significand is 1.
inline constexpr float kToInteger = 0x1.8p23f;
inline constexpr std::int32_t kToIntegerBits = 0x4b400000;

/// round(k * scale), for counts from 0 to 2^21.
HWY_INLINE I32 round_count(F32 k, F32 scale) {
  const F32 rounded = hn::MulAdd(k, scale, hn::Set(DF32(), kToInteger));
  return hn::Sub(hn::BitCast(DI32(), rounded), hn::Set(DI32(), kToIntegerBits));
}

/// The same of a count not rounded yet.
HWY_INLINE I32 rounded(F32 count) {
  return hn::Sub(hn::BitCast(DI32(), hn::Add(count, hn::Set(DF32(), kToInteger))), hn::Set(DI32(), kToIntegerBits));
}

/// Where the lanes of a group of small triangles are drawn to.
struct SmallGroup {
  HWY_ALIGN std::uint32_t first_strip[kSmallRows * kMaxLanes];  ///< masks by row and lane
  HWY_ALIGN std::uint32_t second_strip[kSmallRows * kMaxLanes];
  HWY_ALIGN std::int32_t offset[kMaxLanes];  ///< of the top row in the first strip
};

template <int Rows>
HWY_INLINE void add_rows(const std::uint32_t* HWY_RESTRICT from, std::uint32_t* HWY_RESTRICT to) {
  for (int row = 0; row < Rows; ++row) to[row] |= from[static_cast<std::size_t>(row) * kLanes];
}

/// Adds `Rows` rows, even if the triangle has fewer of them: the others are empty, and a strip goes on below its rows.
template <int Rows>
HWY_INLINE void add_group(const SmallGroup& group, std::uint64_t straddling, const Strips& strips) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    add_rows<Rows>(group.first_strip + lane, strips.words + group.offset[lane]);
  }
  for (; straddling != 0; straddling &= straddling - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(straddling));
    add_rows<Rows>(group.second_strip + lane, strips.words + group.offset[lane] + strips.stride);
  }
}

/// Calls row(i, count0, count1, live) for each of `row_count` rows, from the top on, of triangles inside the target;
/// `live`: the lanes that have that row. `rows`: their numbers of rows, of which `row_count` is the largest.
template <class Row>
HWY_INLINE void walk_rows(const LaneSetup& s, I32 rows, int row_count, const Row& row) {
  const auto di = DI32();
  const I32 middle = hn::Sub(s.middle, s.top);
  const M32 no_upper = hn::Lt(middle, hn::Set(di, 1));
  F32 longer = s.longer.k;
  F32 shorter = hn::IfThenElse(cast(no_upper), s.lower.k, s.upper.k);
  F32 step = hn::IfThenElse(cast(no_upper), s.lower.step, s.upper.step);
  F32 scale = hn::IfThenElse(cast(no_upper), s.lower.scale, s.upper.scale);
  I32 number = hn::Zero(di);
  for (int i = 0; i < row_count; ++i) {
    const auto at_middle = cast(hn::Eq(number, middle));
    shorter = hn::IfThenElse(at_middle, s.lower.k, shorter);
    step = hn::IfThenElse(at_middle, s.lower.step, step);
    scale = hn::IfThenElse(at_middle, s.lower.scale, scale);
    row(i, round_count(longer, s.longer.scale), round_count(shorter, scale), hn::Lt(number, rows));
    longer = hn::Add(longer, s.longer.step);
    shorter = hn::Add(shorter, step);
    number = hn::Add(number, hn::Set(di, 1));
  }
}

/// Rows of the lanes in `small` that have any column.
HWY_INLINE I32 filled_rows(const LaneSetup& s, M32 small) {
  return hn::IfThenElseZero(hn::And(small, hn::Gt(s.right, s.left)), hn::Sub(s.bottom, s.top));
}

/// Draws the lanes in `small`, each inside the target. `base`: of each lane, where its strips begin.
HWY_INLINE void draw_small(const LaneSetup& s, M32 small, I32 base, const Strips& strips) {
  const auto di = DI32();
  SmallGroup group;
  const I32 zero = hn::Zero(di);
  const I32 rows = filled_rows(s, small);
  const int row_count = hn::GetLane(hn::MaxOfLanes(di, rows));
  if (row_count <= 0) return;
  const I32 strip = hn::ShiftRight<5>(s.left);
  const I32 offset =
      hn::Add(base, hn::Add(hn::Mul(strip, hn::Set(di, static_cast<std::int32_t>(strips.stride))), s.top));
  hn::Store(hn::IfThenElseZero(hn::Gt(rows, zero), offset), di, group.offset);
  const M32 straddles = hn::And(hn::Gt(rows, zero), hn::Gt(hn::Sub(s.right, s.strip_left), hn::Set(di, kStripWidth)));
  const std::uint64_t straddling = bits_of(straddles);
  walk_rows(s, rows, row_count, [&](int i, I32 count0, I32 count1, M32 live) HWY_ATTR {
    const std::size_t at = static_cast<std::size_t>(i) * kLanes;
    const NarrowCounts narrow0 = narrow(count0), narrow1 = narrow(count1);
    hn::Store(keep(live, bits_between(narrow0, narrow1)), DU32(), group.first_strip + at);
    if (straddling != 0) {
      hn::Store(keep(live, bits_between(narrow0, narrow1, kStripWidth)), DU32(), group.second_strip + at);
    }
  });
  // Rows up to the next even number are added.
  if (row_count % 2 != 0) {
    const std::size_t at = static_cast<std::size_t>(row_count) * kLanes;
    hn::Store(hn::Zero(DU32()), DU32(), group.first_strip + at);
    hn::Store(hn::Zero(DU32()), DU32(), group.second_strip + at);
  }
  static_assert(kSmallRows == 16);
  switch ((row_count + 1) / 2) {
    case 1:
      return add_group<2>(group, straddling, strips);
    case 2:
      return add_group<4>(group, straddling, strips);
    case 3:
      return add_group<6>(group, straddling, strips);
    case 4:
      return add_group<8>(group, straddling, strips);
    case 5:
      return add_group<10>(group, straddling, strips);
    case 6:
      return add_group<12>(group, straddling, strips);
    case 7:
      return add_group<14>(group, straddling, strips);
    default:
      return add_group<16>(group, straddling, strips);
  }
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
