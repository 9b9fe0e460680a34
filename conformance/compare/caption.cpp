#include "conformance/compare/caption.h"

#include <fmt/format.h>

namespace edgecase::conformance {
namespace {

const char* name_of(SnapRounding rounding) {
  switch (rounding) {
    case SnapRounding::nearest_even:
      return "nearest even";
    case SnapRounding::half_up:
      return "half up";
    case SnapRounding::half_away:
      return "half away from zero";
    case SnapRounding::truncate:
      return "truncate";
  }
  return "";
}

std::string snap_of(const Exhibit& exhibit) {
  const std::string rounding = name_of(exhibit.scene.rules.rounding);
  switch (exhibit.rule_set->snap) {
    case SnapFreedom::none:
      return "snap to " + rounding;
    case SnapFreedom::near_tie:
      return "snap within 0.6 units, outlines to " + rounding;
    case SnapFreedom::neighbour:
      return "snap to either neighbour, outlines to " + rounding;
  }
  return "";
}

std::string grouped(const std::string& integer) {
  const bool negative = integer.starts_with('-');
  const std::string digits = integer.substr(negative ? 1 : 0);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i != 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return (negative ? "-" : digits == "0" ? "" : "+") + text;
}

std::string side_of(const EdgeExplanation& edge) { return edge.top ? "top" : edge.left ? "left" : "-"; }

std::string meaning_of(const WrongSample& wrong, const std::string& subject) {
  switch (wrong.kind) {
    case WrongSample::Kind::missing:
      return "the rules cover it, " + subject + " does not";
    case WrongSample::Kind::unexpected:
      return "the rules leave it uncovered, " + subject + " covers it";
    case WrongSample::Kind::doubled:
      return "the rules cover it once, " + subject + " more than once";
  }
  return "";
}

std::string reason_of(const Explanation& why) {
  if (why.degenerate) return "no area after snapping: the triangle covers nothing";
  if (why.culled) return "culled by the way it faces: the triangle covers nothing";
  std::string on_edge;
  for (const EdgeExplanation& edge : why.edges) {
    if (edge.value.starts_with('-')) return fmt::format("outside: beyond the edge v{} -> v{}", edge.from, edge.to);
    if (edge.value != "0") continue;
    if (!edge.top && !edge.left) {
      return fmt::format("outside: on v{} -> v{}, neither top nor left", edge.from, edge.to);
    }
    on_edge = fmt::format("inside: on v{} -> v{}, a {} edge", edge.from, edge.to, edge.top ? "top" : "left");
  }
  if (!why.inside) return "outside: the scissor leaves this pixel out";
  return on_edge.empty() ? "inside: on the inner side of all three edges" : on_edge;
}

void add_vertices(const GridTriangle& triangle, int bits, Caption& caption) {
  for (std::size_t i = 0; i < 3; ++i) {
    caption.vertices[i] =
        fmt::format("v{} ({}, {})", i, exact_decimal(triangle[i].x, bits), exact_decimal(triangle[i].y, bits));
  }
}

}  // namespace

std::string exact_decimal(std::int64_t value, int bits) {
  const bool negative = value < 0;
  const auto magnitude = negative ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
  // frac / 2^bits = frac * 5^bits / 10^bits, and frac * 5^16 stays below 2^54.
  std::uint64_t fraction = magnitude & ((std::uint64_t{1} << bits) - 1);
  for (int i = 0; i < bits; ++i) fraction *= 5;
  std::string text = fmt::format("{}{}", negative ? "-" : "", magnitude >> bits);
  if (fraction == 0) return text;
  text += fmt::format(".{:0{}}", fraction, bits);
  return text.substr(0, text.find_last_not_of('0') + 1);
}

Caption make_caption(const Exhibit& exhibit) {
  const Setting& setting = exhibit.scene.setting;
  const Rules& rules = exhibit.scene.rules;
  Caption caption;
  caption.setting =
      fmt::format("{} x {} px, {} sample{} a pixel, {} subpixel bits, {}", setting.target.width, setting.target.height,
                  setting.samples(), setting.samples() == 1 ? "" : "s", rules.subpixel_bits, snap_of(exhibit));
  if (exhibit.wrong) {
    const WrongSample& wrong = *exhibit.wrong;
    const SampleLocation& at = setting.sample_locations[static_cast<std::size_t>(wrong.sample)];
    caption.verdict =
        fmt::format("{} at pixel ({}, {}), sample {}", name_of(wrong.kind), wrong.x, wrong.y, wrong.sample);
    caption.meaning = exhibit.meaning.empty()
                          ? meaning_of(wrong, exhibit.subject.empty() ? "the subject" : exhibit.subject)
                          : exhibit.meaning;
    caption.location = fmt::format("({}, {})", exact_decimal(wrong.x * 16 + at.x, kSampleGridBits),
                                   exact_decimal(wrong.y * 16 + at.y, kSampleGridBits));
    caption.triangle = fmt::format("triangle {} of {}", wrong.triangle + 1, exhibit.scene.triangles.size());
  }
  if (exhibit.scene.triangles.size() == 1) caption.triangle = "triangle";
  if (exhibit.explanation) {
    const Explanation& why = *exhibit.explanation;
    add_vertices(why.snapped, why.subpixel_bits, caption);
    for (const EdgeExplanation& edge : why.edges) {
      caption.edges.push_back({fmt::format("v{} -> v{}", edge.from, edge.to), grouped(edge.value), side_of(edge)});
    }
    caption.edge_unit = fmt::format("in (1/{} px)^2, positive inside", why.scale);
    caption.reason = reason_of(why);
  } else if (exhibit.snapped.size() == 1 && exhibit.snapped[0] != GridTriangle{}) {
    add_vertices(exhibit.snapped.front(), rules.subpixel_bits, caption);
  }
  return caption;
}

}  // namespace edgecase::conformance
