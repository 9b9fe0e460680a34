// How many samples each triangle covers, from the counts of its rows alone: no mask is drawn.
#include "rasterizer/fast/union-inl.h"

#if defined(EDGECASE_FAST_COUNTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGECASE_FAST_COUNTS_INL_H_
#undef EDGECASE_FAST_COUNTS_INL_H_
#else
#define EDGECASE_FAST_COUNTS_INL_H_
#endif

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

/// Of the lanes in `chosen`, each inside the target and of at most kMediumExtent px; 0 for the others.
HWY_INLINE I32 count_in_lanes(const LaneSetup& s, M32 chosen) {
  const auto d = DI32();
  const I32 rows = filled_rows(s, chosen);
  I32 sum = hn::Zero(d);
  walk_rows(s, rows, hn::GetLane(hn::MaxOfLanes(d, rows)), [&](int, I32 count0, I32 count1, M32 live) HWY_ATTR {
    sum = hn::Add(sum, hn::IfThenElseZero(live, hn::Abs(hn::Sub(count0, count1))));
  });
  return sum;
}

/// Of a stored triangle on a target of that size.
HWY_INLINE std::uint64_t count_medium(const StoredSetup& s, std::size_t lane, int width, int height) {
  const auto d = DI32();
  const int begin = std::max(-s.top[lane], 0);
  const int end = std::min(s.rows[lane], height - s.top[lane]);
  const I32 left = hn::Set(d, s.strip_left[lane]);
  const auto in_target = [&](I32 count) HWY_ATTR {
    return hn::Min(hn::Max(hn::Add(count, left), hn::Zero(d)), hn::Set(d, width));
  };
  const RowCounts rows(s, lane);
  I32 sum = hn::Zero(d);
  for (int first = begin; first < end; first += static_cast<int>(kLanes)) {
    I32 count0, count1;
    rows.at(first, hn::Set(d, end), count0, count1);
    sum = hn::Add(sum, hn::Abs(hn::Sub(in_target(count0), in_target(count1))));
  }
  return static_cast<std::uint64_t>(hn::GetLane(hn::SumOfLanes(d, sum)));
}

/// Of any triangle.
inline std::uint64_t count_halves(const Halves& halves, int width) {
  const auto in_target = [&](std::int64_t t) { return std::clamp<std::int64_t>(t >> kFractionBits, 0, width); };
  std::int64_t sum = 0;
  for (const Halves::Half* half : {&halves.upper, &halves.lower}) {
    if (half->begin >= half->end) continue;
    Crossings left = half->left, right = half->right;
    for (int row = half->begin; row < half->end; ++row, left.skip(1), right.skip(1)) {
      sum += in_target(right.t) - in_target(left.t);
    }
  }
  return static_cast<std::uint64_t>(sum);
}

/// Adds to the lanes in `ways.small` those of up to 64 x 64 px inside the target. All lanes walk as many rows as the
/// highest triangle has, which is worth it for more than one.
HWY_INLINE void add_medium(const LaneSetup& s, int width, int height, Ways& ways) {
  const I32 fits =
      hn::Or(room_in(hn::Sub(s.right, s.left), kMediumExtent), room_in(hn::Sub(s.bottom, s.top), kMediumExtent));
  const M32 chosen = not_negative(hn::Or(inside(s, width, height), fits));
  const std::uint64_t medium = ways.others & bits_of(chosen);
  if (kLanes > 1 && (medium & (medium - 1)) == 0) return;
  ways.small = chosen;
  ways.others &= ~medium;
}

/// Adds those of kLanes triangles at one plane's samples to `counts`.
template <class Planes>
HWY_INLINE void count_plane(const SnappedTriangle* triangles, const LaneSetup& setup, const Planes& planes, int plane,
                            int width, int height, std::uint64_t* counts) {
  Ways ways = ways_of(setup, width, height);
  if (ways.others != 0) add_medium(setup, width, height, ways);
  HWY_ALIGN std::int32_t small[kMaxLanes];
  hn::Store(count_in_lanes(setup, ways.small), DI32(), small);
  for (std::size_t lane = 0; lane < kLanes; ++lane) counts[lane] += static_cast<std::uint64_t>(small[lane]);
  if (ways.others == 0) return;
  StoredSetup stored;
  if ((ways.others & ways.medium) != 0) store(setup, stored);
  for (std::uint64_t lanes = ways.others & ways.medium; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    counts[lane] += count_medium(stored, lane, width, height);
  }
  std::uint64_t large = ways.others & ~ways.medium;
  if (large == 0) return;
  const LaneHalves halves = halves_of(triangles, planes, plane, width, height);
  for (; large != 0; large &= large - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(large));
    counts[lane] += count_halves(halves.of(lane), width);
  }
}

template <class Planes>
HWY_NOINLINE void count_groups(const SnappedTriangle* triangles, std::size_t groups, const Planes& planes, int width,
                               int height, std::uint64_t* counts) {
  for (; groups != 0; --groups, triangles += kLanes, counts += kLanes) {
    std::fill_n(counts, kLanes, std::uint64_t{0});
    const LaneTriangle lanes = make_lane_triangle(load_vertices(triangles));
    for (int plane = 0; plane < planes.count(); ++plane) {
      count_plane(triangles, make_lane_setup(lanes, planes.shift(plane)), planes, plane, width, height, counts);
    }
  }
}

template <class Planes>
HWY_INLINE void count_list(std::span<const SnappedTriangle> triangles, const Planes& planes, int width, int height,
                           std::uint64_t* counts) {
  in_groups(triangles, [&](const SnappedTriangle* group, std::size_t first, std::size_t groups) HWY_ATTR {
    if (first + groups * kLanes <= triangles.size()) {
      return count_groups(group, groups, planes, width, height, counts + first);
    }
    std::uint64_t last[kMaxLanes];
    count_groups(group, groups, planes, width, height, last);
    std::copy_n(last, triangles.size() - first, counts + first);
  });
}

inline void count_each(std::span<const SnappedTriangle> triangles, int width, int height, std::uint64_t* counts) {
  count_list(triangles, CentrePlane(), width, height, counts);
}

inline void count_each_in(std::span<const SnappedTriangle> triangles, const Region& region, std::uint64_t* counts) {
  count_list(triangles, RegionPlanes{region, 0}, region.right, region.height, counts);
}

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
