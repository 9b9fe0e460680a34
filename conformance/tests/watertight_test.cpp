#include "conformance/compare/watertight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

using Kind = WrongSample::Kind;

constexpr int kBits = 4;

GridPoint point(double x, double y) { return {static_cast<std::int64_t>(x * 16), static_cast<std::int64_t>(y * 16)}; }

/// Edge function of a to b at p, all in 1/16 px.
std::int64_t edge(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

GridPoint sample_point(int x, int y, const SampleLocation& location) {
  return {x * 16 + location.x, y * 16 + location.y};
}

/// Top-left coverage by definition, for either winding; vertices in 1/16 px.
bool covers(GridTriangle t, const GridPoint& p) {
  if (orientation(t) == 0) return false;
  if (orientation(t) < 0) std::swap(t[1], t[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const GridPoint& a = t[i];
    const GridPoint& b = t[(i + 1) % 3];
    const std::int64_t value = edge(a, b, p);
    const bool top_left = b.y < a.y || (a.y == b.y && b.x > a.x);
    if (value < 0 || (value == 0 && !top_left)) return false;
  }
  return true;
}

bool on_segment(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
  return edge(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

MaskBatch draw(const Setting& setting, const std::vector<GridTriangle>& mesh) {
  const MaskLayout layout(setting);
  MaskBatch masks;
  masks.reset(layout, mesh.size());
  std::fill(masks.data().begin(), masks.data().end(), 0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (int y = 0; y < setting.target.height; ++y) {
      for (int x = 0; x < setting.target.width; ++x) {
        for (int s = 0; s < setting.samples(); ++s) {
          if (covers(mesh[i], sample_point(x, y, setting.sample_locations[static_cast<std::size_t>(s)]))) {
            cover(masks[i], layout.bit(x, y, s));
          }
        }
      }
    }
  }
  return masks;
}

Watertightness check(const Setting& setting, const std::vector<GridTriangle>& mesh, const MaskBatch& masks,
                     std::size_t first_triangle = 0) {
  Watertightness total;
  WatertightChecker(setting, kBits).check(mesh, masks.data(), first_triangle, total);
  return total;
}

/// A grid of cells over the target whose inner vertices are jittered; each cell is split along one of its diagonals.
std::vector<GridTriangle> jittered_grid(std::mt19937& random, int cells, std::int64_t cell, std::int64_t jitter) {
  std::uniform_int_distribution<std::int64_t> offset(-jitter, jitter);
  std::vector<GridPoint> vertices;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      vertices.push_back({24 + i * cell + offset(random), 8 + j * cell + offset(random)});
    }
  }
  std::vector<GridTriangle> mesh;
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const auto at = [&](int di, int dj) {
        return vertices[static_cast<std::size_t>((j + dj) * (cells + 1) + i + di)];
      };
      mesh.push_back({at(0, 0), at(1, 0), at(0, 1)});
      mesh.push_back({at(1, 0), at(1, 1), at(0, 1)});
    }
  }
  return mesh;
}

const std::vector<GridTriangle> kSquare = {{point(1, 1), point(5, 1), point(1, 5)},
                                           {point(5, 1), point(5, 5), point(1, 5)}};

TEST(Watertight, AcceptsASquareAndCountsItsInside) {
  const Setting setting{{8, 8}, {SampleLocation{}}};
  const Watertightness total = check(setting, kSquare, draw(setting, kSquare));
  EXPECT_TRUE(total.watertight());
  EXPECT_EQ(total.meshes, 1u);
  EXPECT_EQ(total.samples_inside, 16u);
  EXPECT_EQ(total.folded_meshes, 0u);
}

TEST(Watertight, NamesAHoleADoubleAndAStray) {
  const Setting setting{{8, 8}, {SampleLocation{}}};
  const MaskLayout layout(setting);
  MaskBatch masks = draw(setting, kSquare);
  masks[0][2] &= ~std::uint64_t{0b10};  // pixel (1, 2)
  cover(masks[1], layout.bit(2, 1, 0));
  cover(masks[1], layout.bit(7, 7, 0));
  const Watertightness total = check(setting, kSquare, masks, 40);
  EXPECT_EQ(total.missing, 1u);
  EXPECT_EQ(total.doubled, 1u);
  EXPECT_EQ(total.unexpected, 1u);
  EXPECT_EQ(total.wrong_meshes, 1u);
  EXPECT_EQ(total.first_missing, (WrongSample{Kind::missing, 40, 1, 2, 0}));
  EXPECT_EQ(total.first_doubled, (WrongSample{Kind::doubled, 41, 2, 1, 0}));
  EXPECT_EQ(total.first_unexpected, (WrongSample{Kind::unexpected, 41, 7, 7, 0}));
}

TEST(Watertight, OutsideTheScissorNothingIsInside) {
  Setting setting{{8, 8}, {SampleLocation{}}};
  const MaskBatch whole = draw(setting, kSquare);
  setting.scissor = Rect{-3, 2, 6, 100};  // columns up to 2, rows from 2
  MaskBatch masks = draw(setting, kSquare);
  for (std::size_t i = 0; i < masks.size(); ++i) {
    for (std::size_t y = 0; y < 8; ++y) masks[i][y] &= y < 2 ? 0 : 0b111;
  }
  const Watertightness cut = check(setting, kSquare, masks);
  EXPECT_TRUE(cut.watertight());
  EXPECT_EQ(cut.samples_inside, 2u * 3u);  // columns 1 and 2 of rows 2 to 4
  const Watertightness uncut = check(setting, kSquare, whole);
  EXPECT_EQ(uncut.missing, 0u);
  EXPECT_EQ(uncut.unexpected, 16u - 6u);
}

TEST(Watertight, SamplesOnTheOutlineMayGoEitherWayButNotTwice) {
  const Setting setting{{8, 8}, {SampleLocation{}}};
  const MaskLayout layout(setting);
  // The outline runs through the centres of rows and columns 1 and 5; the diagonal does too, but it is inside.
  const std::vector<GridTriangle> mesh = {{point(1.5, 1.5), point(5.5, 1.5), point(1.5, 5.5)},
                                          {point(5.5, 1.5), point(5.5, 5.5), point(1.5, 5.5)}};
  MaskBatch masks = draw(setting, mesh);
  EXPECT_TRUE(check(setting, mesh, masks).watertight());
  EXPECT_EQ(check(setting, mesh, masks).samples_inside, 9u);

  MaskBatch without = masks;
  without[0][1] = 0;  // the top edge's samples
  EXPECT_TRUE(check(setting, mesh, without).watertight());
  MaskBatch with = masks;
  cover(with[1], layout.bit(5, 5, 0));
  cover(with[1], layout.bit(5, 3, 0));
  EXPECT_TRUE(check(setting, mesh, with).watertight());
  cover(with[0], layout.bit(5, 3, 0));
  EXPECT_EQ(check(setting, mesh, with).doubled, 1u);
  cover(masks[0], layout.bit(3, 3, 0));
  EXPECT_EQ(check(setting, mesh, masks).doubled, 1u);
}

TEST(Watertight, DoesNotJudgeAFoldedMesh) {
  const Setting setting{{8, 8}, {SampleLocation{}}};
  std::vector<GridTriangle> turned = kSquare;
  std::swap(turned[1][0], turned[1][1]);
  EXPECT_EQ(check(setting, turned, draw(setting, turned)).folded_meshes, 1u);

  std::vector<GridTriangle> overlapping = kSquare;
  overlapping.push_back({point(2, 2), point(7, 3), point(2, 7)});
  const Watertightness total = check(setting, overlapping, draw(setting, overlapping));
  EXPECT_EQ(total.folded_meshes, 1u);
  EXPECT_TRUE(total.watertight());
}

TEST(Watertight, ForgetsTheLastMesh) {
  const Setting setting{{8, 8}, {SampleLocation{}}};
  WatertightChecker checker(setting, kBits);
  Watertightness total;
  const std::vector<GridTriangle> small = {{point(0, 0), point(2, 0), point(0, 2)}};
  checker.check(kSquare, draw(setting, kSquare).data(), 0, total);
  checker.check(small, draw(setting, small).data(), 2, total);
  checker.check(kSquare, draw(setting, kSquare).data(), 3, total);
  EXPECT_TRUE(total.watertight());
  EXPECT_EQ(total.samples_inside, 16u + 1u + 16u);
}

// Holes, sharp corners, degenerate triangles, either winding, every sample count, parts off the target: the scan
// against the definition. A sample is strictly inside if it is not on the outline and some triangle holds it, edges
// included.
TEST(Watertight, ScanAgreesWithTheDefinition) {
  std::mt19937 random(11);
  std::vector<std::vector<SampleLocation>> patterns = {{{6, 2}, {14, 6}, {2, 10}}};
  for (const int samples : {1, 2, 16}) {
    const auto standard = standard_sample_locations(samples);
    patterns.emplace_back(standard.begin(), standard.end());
  }
  int judged = 0;
  for (int round = 0; round < 400; ++round) {
    const Setting setting{{9 + round % 7, 10}, patterns[static_cast<std::size_t>(round) % patterns.size()]};
    std::vector<GridTriangle> mesh = jittered_grid(random, 3, round % 3 == 0 ? 32 : 45, round % 2 == 0 ? 8 : 14);
    if (round % 5 == 0) mesh.erase(mesh.begin() + 8, mesh.begin() + 10);
    if (round % 2 == 1) {
      for (GridTriangle& triangle : mesh) std::swap(triangle[0], triangle[2]);
    }
    if (!common_orientation(mesh)) continue;
    ++judged;
    OutlineBuilder builder;
    const auto outline = builder.build(mesh);
    const MaskLayout layout(setting);
    MaskBatch masks = draw(setting, mesh);
    EXPECT_TRUE(check(setting, mesh, masks).watertight());
    EXPECT_FALSE(mesh_fault(mesh));

    std::uint64_t inside = 0;
    std::uint64_t outside = 0;
    for (int y = 0; y < setting.target.height; ++y) {
      for (int x = 0; x < setting.target.width; ++x) {
        for (int s = 0; s < setting.samples(); ++s) {
          const GridPoint p = sample_point(x, y, setting.sample_locations[static_cast<std::size_t>(s)]);
          if (std::any_of(outline.begin(), outline.end(),
                          [&](const OutlineEdge& e) { return on_segment(e.from, e.to, p); })) {
            continue;
          }
          const bool held = std::any_of(mesh.begin(), mesh.end(), [&](GridTriangle t) {
            if (orientation(t) == 0) return false;
            if (orientation(t) < 0) std::swap(t[1], t[2]);
            return edge(t[0], t[1], p) >= 0 && edge(t[1], t[2], p) >= 0 && edge(t[2], t[0], p) >= 0;
          });
          ++(held ? inside : outside);
        }
      }
    }
    EXPECT_EQ(check(setting, mesh, masks).samples_inside, inside);
    // Nothing covered: every inside sample is a hole. Everything covered twice: every sample is wrong.
    std::fill(masks.data().begin(), masks.data().end(), 0);
    EXPECT_EQ(check(setting, mesh, masks).missing, inside);
    std::fill(masks.data().begin(), masks.data().end(), ~std::uint64_t{0});
    const Watertightness flooded = check(setting, mesh, masks);
    EXPECT_EQ(flooded.unexpected, outside);
    EXPECT_EQ(flooded.doubled + flooded.unexpected, layout.sample_count());
  }
  EXPECT_GT(judged, 300);
}

// The 128-bit path against the 64-bit one: the same mesh on a grid finer by 2^12.
TEST(Watertight, FineGridsAndFarVerticesStayExact) {
  std::mt19937 random(13);
  const Setting setting{{12, 10}, {{8, 8}, {0, 0}}};
  for (int round = 0; round < 50; ++round) {
    std::vector<GridTriangle> mesh = jittered_grid(random, 3, 45, 10);
    mesh.push_back({mesh[0][0], mesh[0][2], point(-16000, 9)});
    const MaskBatch masks = draw(setting, mesh);
    std::vector<GridTriangle> fine = mesh;
    for (GridTriangle& triangle : fine) {
      for (GridPoint& p : triangle) p = {p.x << 12, p.y << 12};
    }
    Watertightness coarse_total;
    Watertightness fine_total;
    WatertightChecker(setting, 4).check(mesh, masks.data(), 0, coarse_total);
    WatertightChecker(setting, 16).check(fine, masks.data(), 0, fine_total);
    EXPECT_EQ(coarse_total.folded_meshes, fine_total.folded_meshes);
    EXPECT_EQ(coarse_total.samples_inside, fine_total.samples_inside);
    EXPECT_EQ(coarse_total.missing, fine_total.missing);
    EXPECT_EQ(coarse_total.unexpected, fine_total.unexpected);
    EXPECT_TRUE(fine_total.watertight());
  }
}

// Vertices so far away that 64 bits would overflow: an edge through (3.5, 0) px with a slope that carries it over the
// rows of the target by a quarter of a pixel each, moved along its direction until its ends are 2^39 units away.
TEST(Watertight, DistanceTakesTheWidePath) {
  const Setting setting{{8, 8}, {SampleLocation{}}};
  const std::int64_t steps = (std::int64_t{1} << 35) + 600'000;
  const GridPoint upper{56 - 4 * steps, -16 * steps};
  const GridPoint lower{56 + 4 * steps, 16 * steps};
  const std::vector<GridTriangle> mesh = {{upper, {upper.x + 16 * steps, upper.y}, lower}};
  // Its other edge is far to the right of the target, where 64 bits would wrap to a crossing on its left; a row's first
  // inside sample is the one right of the slanted edge.
  std::uint64_t expected = 0;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const int sixteenths_right_of_edge = 16 * x + 8 - (56 + (16 * y + 8) / 4);
      if (sixteenths_right_of_edge > 0) ++expected;
    }
  }
  MaskBatch masks;
  masks.reset(MaskLayout(setting), mesh.size());
  std::fill(masks.data().begin(), masks.data().end(), 0);
  const Watertightness total = check(setting, mesh, masks);
  EXPECT_EQ(total.folded_meshes, 0u);
  EXPECT_EQ(total.samples_inside, expected);
  EXPECT_EQ(total.missing, expected);
}

TEST(Watertight, ATriangleCollapsedToAPointIsNoOutline) {
  const Setting setting{{8, 8}, {SampleLocation{}}};
  std::vector<GridTriangle> mesh = kSquare;
  mesh.push_back({point(2.5, 2.5), point(2.5, 2.5), point(2.5, 2.5)});
  EXPECT_EQ(check(setting, mesh, draw(setting, mesh)).samples_inside, 16u);
}

TEST(MeshFault, AcceptsMeshesAndTheirDegenerateTriangles) {
  EXPECT_FALSE(mesh_fault({}));
  EXPECT_FALSE(mesh_fault(kSquare));
  std::vector<GridTriangle> collapsed = kSquare;
  collapsed.push_back({point(1, 1), point(5, 1), point(3, 1)});
  EXPECT_FALSE(mesh_fault(collapsed));
  // Two parts that touch in a vertex, and a T-junction that lies exactly on its edge: odd, but nothing is covered
  // twice.
  std::vector<GridTriangle> touching = kSquare;
  touching.push_back({point(5, 5), point(7, 5), point(5, 7)});
  EXPECT_FALSE(mesh_fault(touching));
  EXPECT_FALSE(mesh_fault(std::vector<GridTriangle>{{point(1, 1), point(5, 1), point(1, 5)},
                                                    {point(5, 1), point(5, 5), point(3, 3)},
                                                    {point(3, 3), point(5, 5), point(1, 5)}}));
}

TEST(MeshFault, CatchesWhatCoversTwice) {
  std::vector<GridTriangle> turned = kSquare;
  std::swap(turned[1][0], turned[1][1]);
  EXPECT_EQ(mesh_fault(turned), "triangle 1 is wound against those before it");

  std::vector<GridTriangle> twice = kSquare;
  twice.push_back(kSquare[0]);
  EXPECT_TRUE(mesh_fault(twice));

  // An overlap that lies between all samples, without crossing outlines, and one with.
  std::vector<GridTriangle> within = kSquare;
  within.push_back({point(2, 2), point(2.125, 2), point(2, 2.125)});
  EXPECT_EQ(mesh_fault(within), "its outline winds 2 times around points between rows 32 and 34 of the subpixel grid");
  std::vector<GridTriangle> across = kSquare;
  across.push_back({point(4.9375, 2), point(6, 2.5), point(6, 3)});
  EXPECT_TRUE(mesh_fault(across));

  // Two triangles that cross in the lower half of the only slab, where the row half way down sees nothing.
  EXPECT_TRUE(mesh_fault(std::vector<GridTriangle>{{point(0, 0), point(6, 10), point(0, 10)},
                                                   {point(11, 0), point(11, 10), point(5, 10)}}));

  // A fan that goes round twice.
  std::vector<GridTriangle> fan;
  const std::vector<GridPoint> rim = {point(6, 0), point(10, 3), point(8, 8), point(3, 8), point(1, 3)};
  for (std::size_t i = 0; i < 5; ++i) fan.push_back({point(5, 4), rim[2 * i % 5], rim[(2 * i + 2) % 5]});
  EXPECT_TRUE(mesh_fault(fan));
}

}  // namespace
}  // namespace edgecase::conformance
