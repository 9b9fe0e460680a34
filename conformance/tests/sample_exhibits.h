// Exhibits for tests of pictures and reports, their masks filled in by the definition of the top-left rule.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "conformance/compare/exhibit.h"

namespace edgecase::conformance {

/// Twice the area of a, b, p, on a grid of 2^-8 px.
inline std::int64_t edge_function(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

inline Explanation explain(const GridTriangle& triangle, const Setting& setting, int x, int y, int sample) {
  const SampleLocation& at = setting.sample_locations[static_cast<std::size_t>(sample)];
  const GridPoint p{x * 256 + at.x * 16, y * 256 + at.y * 16};
  Explanation why;
  why.snapped = triangle;
  const int turn = orientation(triangle);
  why.degenerate = turn == 0;
  why.inside = turn != 0;
  for (int i = 0; i < 3; ++i) {
    EdgeExplanation& edge = why.edges[static_cast<std::size_t>(i)];
    edge.from = i;
    edge.to = (i + 1) % 3;
    const GridPoint& a = triangle[static_cast<std::size_t>(edge.from)];
    const GridPoint& b = triangle[static_cast<std::size_t>(edge.to)];
    const std::int64_t value = edge_function(a, b, p) * turn;
    edge.value = std::to_string(value);
    edge.top = a.y == b.y && (b.x - a.x) * turn > 0;
    edge.left = (b.y - a.y) * turn < 0;
    if (value < 0 || (value == 0 && !edge.top && !edge.left)) why.inside = false;
  }
  return why;
}

/// Triangles in pixels, which must be multiples of 1/256; the subject agrees with the rules until a test changes it.
inline Exhibit make_exhibit(const Setting& setting, const std::vector<Triangle>& triangles) {
  Exhibit exhibit;
  exhibit.title = "fans #17 (seed 1): the reference disagrees with itself";
  exhibit.subject = "softpipe";
  exhibit.command = "./edgecase run --subject osmesa-softpipe findings/0001-softpipe-fans.json";
  exhibit.scene.setting = setting;
  exhibit.scene.triangles = triangles;
  exhibit.scene.meshes = {{0, triangles.size()}};
  const MaskLayout layout(setting);
  exhibit.must.reset(layout, triangles.size());
  std::fill(exhibit.must.data().begin(), exhibit.must.data().end(), 0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    GridTriangle snapped;
    for (std::size_t v = 0; v < 3; ++v) {
      snapped[v] = {static_cast<std::int64_t>(triangles[i][v].x * 256),
                    static_cast<std::int64_t>(triangles[i][v].y * 256)};
    }
    exhibit.snapped.push_back(snapped);
    for (int y = 0; y < setting.target.height; ++y) {
      for (int x = 0; x < setting.target.width; ++x) {
        for (int s = 0; s < setting.samples(); ++s) {
          if (explain(snapped, setting, x, y, s).inside) cover(exhibit.must[i], layout.bit(x, y, s));
        }
      }
    }
  }
  exhibit.observed = exhibit.must;
  return exhibit;
}

/// Turns one sample of the observed mask over and makes it the wrong one that the exhibit is about.
inline void spoil(Exhibit& exhibit, std::size_t triangle, int x, int y, int sample) {
  const MaskLayout layout(exhibit.scene.setting);
  const std::size_t bit = layout.bit(x, y, sample);
  exhibit.observed[triangle][bit / 64] ^= std::uint64_t{1} << (bit % 64);
  const auto kind =
      covered(exhibit.observed[triangle], bit) ? WrongSample::Kind::unexpected : WrongSample::Kind::missing;
  if (exhibit.wrong) return;
  exhibit.wrong = WrongSample{kind, triangle, x, y, sample};
  exhibit.explanation = explain(exhibit.snapped[triangle], exhibit.scene.setting, x, y, sample);
}

inline Exhibit square_fan() {
  return make_exhibit({{16, 16}, {SampleLocation{}}}, {{Position{8.5f, 8.5f}, {3, 3}, {14, 3}},
                                                       {Position{8.5f, 8.5f}, {14, 3}, {14, 13}},
                                                       {Position{8.5f, 8.5f}, {14, 13}, {3, 13}},
                                                       {Position{8.5f, 8.5f}, {3, 13}, {3, 3}}});
}

inline std::size_t owner(const Exhibit& exhibit, int x, int y) {
  const std::size_t bit = MaskLayout(exhibit.scene.setting).bit(x, y, 0);
  for (std::size_t i = 0; i < exhibit.must.size(); ++i) {
    if (covered(exhibit.must[i], bit)) return i;
  }
  return 0;
}

inline Exhibit one_of_each() {
  Exhibit exhibit = square_fan();
  spoil(exhibit, owner(exhibit, 5, 8), 5, 8, 0);
  spoil(exhibit, 0, 1, 14, 0);
  spoil(exhibit, (owner(exhibit, 10, 5) + 1) % 4, 10, 5, 0);
  return exhibit;
}

}  // namespace edgecase::conformance
