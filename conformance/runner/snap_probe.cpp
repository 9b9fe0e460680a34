#include "conformance/runner/snap_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

// One pixel centre is enough if the edge that decides it passes through the centre for one way of snapping, and a grid
// unit beside it for another.
constexpr Extent kTarget{8, 8};

bool follows(const Rules& rules, const Scene& probe, const MaskBatch& masks) {
  std::vector<std::uint64_t> expected(MaskLayout(probe.setting).words());
  for (std::size_t i = 0; i < probe.triangles.size(); ++i) {
    oracle::cover_by_definition(probe.setting, rules, probe.triangles[i], expected);
    if (!std::ranges::equal(expected, masks[i])) return false;
  }
  return true;
}

}  // namespace

std::vector<Rules> snap_candidates(int subpixel_bits) {
  std::vector<Rules> all;
  for (const bool half_pixel_first : {false, true}) {
    for (const SnapRounding rounding :
         {SnapRounding::nearest_even, SnapRounding::half_up, SnapRounding::half_away, SnapRounding::truncate}) {
      all.push_back({subpixel_bits, rounding, half_pixel_first});
    }
  }
  return all;
}

// A coordinate p near a tie is snapped to t or t + 1 grid units. Its mirror image q in a pixel centre c would be
// snapped to 2c - t or 2c - t - 1; with q on the grid, the edge from p to q passes the centre on the one side or the
// other.
Scene snap_probe(int subpixel_bits) {
  Scene probe;
  probe.setting.target = kTarget;
  probe.rules.subpixel_bits = subpixel_bits;
  const float unit = std::ldexp(1.0f, -subpixel_bits);
  const float centre = 4.5f;
  // Near ties of both parities; far out and close to zero, where a coordinate has many bits below the grid; both signs.
  for (const float base : {-40.0f, -3.0f, -1.0f, 0.0f, 1.0f, 3.0f, 40.0f}) {
    for (int step = -3; step <= 3; ++step) {
      const float grid = base + static_cast<float>(step) * unit;
      const float tie = grid + unit / 2;
      for (const float p :
           {tie, std::nextafter(tie, -1e9f), std::nextafter(tie, 1e9f), tie - unit / 4, tie + unit / 4}) {
        for (const float t : {grid, grid + unit}) {
          const float q = 2 * centre - t;
          const float far = 12;
          probe.triangles.push_back({{{p, 0}, {q, 9}, {far, 0}}});
          probe.triangles.push_back({{{0, p}, {9, q}, {0, far}}});
          probe.triangles.push_back({{{p, 0}, {q, 9}, {-far, 9}}});
          probe.triangles.push_back({{{0, p}, {9, q}, {9, -far}}});
        }
      }
    }
  }
  return probe;
}

tl::expected<Rules, Error> find_snap(Subject& subject) {
  const int bits = subject.info().rules.subpixel_bits;
  Scene probe = snap_probe(bits);
  probe.rules = subject.info().rules;
  MaskBatch masks;
  if (const auto refusal = subject.refusal(probe)) {
    return tl::unexpected(Error{ErrorKind::subject,
                                fmt::format("{}: cannot draw the snapping probe: {}", subject.info().name, *refusal)});
  }
  if (auto drawn = subject.draw(probe, masks); !drawn) return tl::unexpected(drawn.error());
  for (const Rules& rules : snap_candidates(bits)) {
    if (follows(rules, probe, masks)) return rules;
  }
  return tl::unexpected(
      Error{ErrorKind::subject, fmt::format("{}: no known way of snapping to {} subpixel bits explains "
                                            "what it covers near ties",
                                            subject.info().name, bits)});
}

std::string describe_snap(const Rules& rules) {
  const char* rounding = "";
  switch (rules.rounding) {
    case SnapRounding::nearest_even:
      rounding = "to nearest even";
      break;
    case SnapRounding::half_up:
      rounding = "to nearest, half up";
      break;
    case SnapRounding::half_away:
      rounding = "to nearest, half away from zero";
      break;
    case SnapRounding::truncate:
      rounding = "towards zero";
      break;
  }
  return fmt::format("{} subpixel bits, {}{}", rules.subpixel_bits, rounding,
                     rules.half_pixel_first ? ", half a pixel subtracted first" : "");
}

}  // namespace edgecase::conformance
