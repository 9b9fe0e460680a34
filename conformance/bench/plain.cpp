#include "conformance/bench/plain.h"

#include <cstdlib>
#include <limits>

#include "conformance/bench/plain_step.h"
#include "rasterizer/edge.h"

namespace edgecase::conformance {
namespace {

#if defined(__x86_64__)
#define EDGECASE_CLONES __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#else
#define EDGECASE_CLONES
#endif

EDGECASE_CLONES void step32(const PlainEdges<std::int32_t>& edges, const PlainBox& box, std::uint8_t* pixels) {
  step_plain(edges, box, pixels);
}
EDGECASE_CLONES void step64(const PlainEdges<std::int64_t>& edges, const PlainBox& box, std::uint8_t* pixels) {
  step_plain(edges, box, pixels);
}

}  // namespace

template <int Bits>
void cover_plain(PlainLoop loop, const rasterizer::FixedTriangle<rasterizer::Format<16, Bits>>& triangle,
                 const rasterizer::Target& target, std::uint8_t* pixels) {
  using Format = rasterizer::Format<16, Bits>;
  // Two values, each times up to 2^14 columns or rows, and another are added below.
  static_assert(rasterizer::Edge<Format>::Step::kBits + 14 + 2 <= 64 &&
                rasterizer::Edge<Format>::Value::kBits + 2 <= 64);
  const auto box = rasterizer::pixel_box<Format>(triangle, rasterizer::View<>{target});
  const auto turned = rasterizer::turned_clockwise<Format>(triangle);
  if (!box || !turned) return;
  const auto origin =
      rasterizer::sample_position<Format>(box->left, box->top, rasterizer::CentreSample::point<Format>(0));
  const auto edges = rasterizer::make_edges<Format>(*turned, origin);
  const std::ptrdiff_t stride = target.width().value();
  const PlainBox size{box->right.value() - box->left.value(), box->bottom.value() - box->top.value(), stride};
  PlainEdges<std::int64_t> wide;
  std::int64_t largest = 0;
  for (std::size_t e = 0; e < 3; ++e) {
    wide.a[e] = edges[e].a.value(), wide.b[e] = edges[e].b.value(), wide.c[e] = edges[e].c.value();
    // One step beyond the box is added and never looked at; it must fit, too.
    largest =
        std::max(largest, std::abs(wide.c[e]) + std::abs(wide.a[e]) * size.width + std::abs(wide.b[e]) * size.height);
  }
  std::uint8_t* const first = pixels + box->top.value() * stride + box->left.value();
  if (largest > std::numeric_limits<std::int32_t>::max()) {
    return loop == PlainLoop::scalar ? step_scalar(wide, size, first) : step64(wide, size, first);
  }
  PlainEdges<std::int32_t> narrow;
  for (std::size_t e = 0; e < 3; ++e) {
    narrow.a[e] = static_cast<std::int32_t>(wide.a[e]);
    narrow.b[e] = static_cast<std::int32_t>(wide.b[e]);
    narrow.c[e] = static_cast<std::int32_t>(wide.c[e]);
  }
  if (loop == PlainLoop::scalar) {
    step_scalar(narrow, size, first);
  } else {
    step32(narrow, size, first);
  }
}

#define EDGECASE_PLAIN(bits)                                                                                 \
  template void cover_plain<bits>(PlainLoop, const rasterizer::FixedTriangle<rasterizer::Format<16, bits>>&, \
                                  const rasterizer::Target&, std::uint8_t*)
EDGECASE_PLAIN(0);
EDGECASE_PLAIN(2);
EDGECASE_PLAIN(4);
EDGECASE_PLAIN(6);
EDGECASE_PLAIN(8);
EDGECASE_PLAIN(10);
EDGECASE_PLAIN(12);
EDGECASE_PLAIN(16);
#undef EDGECASE_PLAIN

std::string plain_isa(PlainLoop loop) {
  if (loop == PlainLoop::scalar) return "scalar";
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) return "avx512";
  if (__builtin_cpu_supports("avx2")) return "avx2";
  return "sse2";
#else
  return "portable";
#endif
}

}  // namespace edgecase::conformance
