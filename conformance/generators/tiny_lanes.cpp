// The generator `tiny` for many scenes at once: tiny() of triangles.cpp, a scene to a lane.
#include <algorithm>
#include <array>

#include "conformance/generators/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "conformance/generators/tiny_lanes.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
//
#include "conformance/generators/random_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace edgecase::conformance::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
void tiny_each(const Lattice& lattice, const Random& family, std::uint64_t first, std::size_t count, Scene& scene) {
  for (std::size_t i = 0; i < count; ++i) {
    Random random = family.item(first + i);
    families::tiny(lattice, random, scene);
  }
}
#else
struct Points {
  U64 x;
  U64 y;
};

HWY_INLINE Points choose(hn::Mask<D64> first, const Points& a, const Points& b) {
  return {hn::IfThenElse(first, a.x, b.x), hn::IfThenElse(first, a.y, b.y)};
}

/// In pixels, y in the upper half of a lane. Lattice coordinates fit 32 bits.
HWY_INLINE U64 positions(const Points& p, float unit) {
  const hn::RebindToSigned<D32> d32;
  const hn::RebindToFloat<D32> df;
  const U64 whole = hn::Or(hn::And(p.x, all(std::uint64_t{0xffffffff})), hn::ShiftLeft<32>(p.y));
  return hn::BitCast(D64(), hn::Mul(hn::ConvertTo(df, hn::BitCast(d32, whole)), hn::Set(df, unit)));
}

void tiny_each(const Lattice& lattice, const Random& family, std::uint64_t first, std::size_t count, Scene& scene) {
  constexpr std::size_t kAtOnce = 64;
  constexpr std::size_t kLanes = hn::MaxLanes(D64());
  static_assert(kAtOnce % kLanes == 0 && sizeof(Triangle) == 3 * sizeof(std::uint64_t));
  const std::int64_t half = lattice.half_pixel();
  const Points one_more{all(lattice.width() + 1), all(lattice.height() + 1)};
  const U64 whole_pixels = all(-lattice.pixel());
  const RandomLanes::Family streams(family);
  std::array<Triangle, kAtOnce> triangles;
  auto* const words = reinterpret_cast<std::uint64_t*>(triangles.data());  // written as vectors only
  for (std::size_t done = 0; done < count; done += kAtOnce) {
    for (std::size_t i = 0; i < kAtOnce; i += hn::Lanes(D64())) {
      RandomLanes random(streams, first + done + i);
      const auto off_centre = random.one_in(4);
      Points place;
      place.x = random.from(all(std::uint64_t{0}), one_more.x);
      place.y = random.from(all(std::uint64_t{0}), one_more.y);
      const Points centre{hn::Add(hn::And(place.x, whole_pixels), all(half)),
                          hn::Add(hn::And(place.y, whole_pixels), all(half))};
      const Points middle = choose(off_centre, place, centre);
      const auto within = random.one_in(2);
      const U64 reach = hn::IfThenElse(within, all(std::uint64_t{2}), all(half));
      const Points low{hn::Sub(middle.x, reach), hn::Sub(middle.y, reach)};
      const U64 places = hn::Add(hn::Add(reach, reach), all(std::uint64_t{1}));
      Points corners[3];
      for (Points& corner : corners) {
        corner.x = random.from(low.x, places);
        corner.y = random.from(low.y, places);
      }
      const auto exchanged = random.one_in(2);
      hn::StoreInterleaved3(positions(corners[0], lattice.unit()),
                            positions(choose(exchanged, corners[2], corners[1]), lattice.unit()),
                            positions(choose(exchanged, corners[1], corners[2]), lattice.unit()), D64(), words + 3 * i);
    }
    scene.triangles.insert(scene.triangles.end(), triangles.begin(),
                           triangles.begin() + static_cast<std::ptrdiff_t>(std::min(kAtOnce, count - done)));
  }
}
#endif

}  // namespace edgecase::conformance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgecase::conformance {

HWY_EXPORT(tiny_each);

void families::tiny_each(const Lattice& lattice, const Random& family, std::uint64_t first, std::size_t count,
                         Scene& scene) {
  HWY_DYNAMIC_DISPATCH(tiny_each)(lattice, family, first, count, scene);
}

}  // namespace edgecase::conformance
#endif
