// The coverage path with everything else compiled out: one plane, one sample in the centre, no shift, and none of the
// files of the other features. no_extra_cost_test holds its instructions against those of the library.
#include <cstdint>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_COMPILE_ALL_ATTAINABLE
#define HWY_DISABLED_TARGETS HWY_SSSE3
#define HWY_TARGET_INCLUDE "conformance/tests/coverage_only.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "rasterizer/fast/union-inl.h"

HWY_BEFORE_NAMESPACE();
namespace edgecase::rasterizer::HWY_NAMESPACE {

struct NothingAsked {
  struct Shift {
    static HWY_INLINE I32 x(I32 v) { return v; }
    static HWY_INLINE I32 y(I32 v) { return v; }
  };
  static constexpr int count() { return 1; }
  static constexpr std::size_t words_before(int) { return 0; }
  static constexpr Shift shift(int) { return {}; }
  static FixedTriangle<ShiftedFormat> shifted(const SnappedTriangle& triangle, int) { return widened(triangle); }
};

inline void coverage_only(std::span<const SnappedTriangle> triangles, int width, const Strips& strips) {
  draw_list(triangles, NothingAsked(), width, 0, strips);
}

/// So that it is compiled.
extern void (*const kCoverageOnly)(std::span<const SnappedTriangle>, int, const Strips&);
void (*const kCoverageOnly)(std::span<const SnappedTriangle>, int, const Strips&) = &coverage_only;

}  // namespace edgecase::rasterizer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
