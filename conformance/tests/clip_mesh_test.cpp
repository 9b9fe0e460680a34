#include "conformance/compare/clip_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "conformance/generators/generator.h"
#include "conformance/models/transform_model.h"
#include "conformance/oracle/oracle.h"
#include "conformance/runner/judge.h"
#include "conformance/runner/run.h"
#include "conformance/scene/grid.h"

namespace edgecase::conformance {
namespace {

using Rational = boost::multiprecision::cpp_rational;

constexpr std::array kGenerators{"clip_fans", "clip_grids", "clip_grids_fractional", "clip_grids_samples4"};

Scene scenes(std::string_view name, std::uint64_t count) {
  Scene scene;
  scene.setting = find_generator(name)->setting;
  for (std::uint64_t i = 0; i < count; ++i) append_scene(*find_generator(name), 3, i, scene);
  return scene;
}

std::span<const ClipTriangle> triangles_of(const Scene& scene, const Mesh& mesh) {
  return std::span(scene.clip->triangles).subspan(mesh.first, mesh.count);
}

using Vector = std::array<Rational, 3>;

Rational determinant(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Whether some triangle of the mesh can be seen at the window position (x, y): (X, Y, 1) is a sum of its (x, y, w) with
// weights of 0 or more, and the same sum of its z, which is z / w there, is from `least_depth` to 1.
bool seen_at(const Viewport& v, std::span<const ClipTriangle> mesh, const Rational& x, const Rational& y,
             int least_depth) {
  const Vector p{(x - Rational(v.x)) * 2 / Rational(v.width) - 1, (y - Rational(v.y)) * 2 / Rational(v.height) - 1, 1};
  if (abs(p[0]) > 1 || abs(p[1]) > 1) return false;
  return std::ranges::any_of(mesh, [&](const ClipTriangle& t) {
    const auto row = [&](std::size_t i) { return Vector{Rational(t[i].x), Rational(t[i].y), Rational(t[i].w)}; };
    const Rational whole = determinant(row(0), row(1), row(2));
    if (whole == 0) return false;
    const std::array<Rational, 3> weights{determinant(p, row(1), row(2)) / whole,
                                          determinant(row(0), p, row(2)) / whole,
                                          determinant(row(0), row(1), p) / whole};
    if (std::ranges::any_of(weights, [](const Rational& weight) { return weight < 0; })) return false;
    const Rational depth =
        weights[0] * Rational(t[0].z) + weights[1] * Rational(t[1].z) + weights[2] * Rational(t[2].z);
    return depth >= least_depth && depth <= 1;
  });
}

TEST(ClipMesh, WhatIsCertainlyInsideIsSeenToAllSidesInRationals) {
  for (const char* name : kGenerators) {
    for (const NearPlane near : {NearPlane::zero, NearPlane::minus_w}) {
      const Scene scene = scenes(name, 4);
      const Setting& setting = scene.setting;
      const Viewport& viewport = scene.clip->viewport;
      const MaskLayout layout(setting);
      std::vector<std::uint64_t> inside(layout.words());
      int claimed = 0;
      for (const Mesh& mesh : scene.meshes) {
        const auto triangles = triangles_of(scene, mesh);
        if (!certainly_inside(setting, 8, viewport, near, triangles, inside)) continue;
        const Rational error(*border_error(8, viewport, near, triangles));
        for (int i = 0; i < 1024; i += 23) {
          const int s = i % setting.samples();
          if (!covered(inside, layout.bit(i % 32, i / 32, s))) continue;
          ++claimed;
          const SampleLocation& at = setting.sample_locations[static_cast<std::size_t>(s)];
          for (const int dx : {-1, 1}) {
            for (const int dy : {-1, 1}) {
              const Rational x = Rational(i % 32) + Rational(at.x, 16) + dx * error;
              const Rational y = Rational(i / 32) + Rational(at.y, 16) + dy * error;
              ASSERT_TRUE(seen_at(viewport, triangles, x, y, near == NearPlane::zero ? 0 : -1))
                  << name << " mesh from " << mesh.first << ", pixel " << i % 32 << ", " << i / 32;
            }
          }
        }
      }
      EXPECT_GT(claimed, 10) << name;
    }
  }
}

TEST(ClipMesh, TheBorderErrorIsHalfAUnitAndALittle) {
  const Scene scene = scenes("clip_grids", 1);
  const auto mesh = triangles_of(scene, scene.meshes[0]);
  for (const int bits : {4, 8}) {
    const auto error = border_error(bits, scene.clip->viewport, NearPlane::zero, mesh);
    ASSERT_TRUE(error);
    EXPECT_GT(*error, std::ldexp(0.5, -bits));
    EXPECT_LT(*error, std::ldexp(0.5, -bits) + 0.004);
  }
  ClipTriangle near_the_eye{{{-1, -1, 0, 1}, {1, -1, 0, 1}, {0, 0, 0, 0x1p-40f}}};
  EXPECT_FALSE(border_error(8, scene.clip->viewport, NearPlane::zero, {&near_the_eye, 1}));
  ClipTriangle beyond{{{-3, -1, 0, 1}, {-2, -1, 0, 1}, {-2, 0, 0, 1}}};
  EXPECT_FALSE(border_error(8, scene.clip->viewport, NearPlane::zero, {&beyond, 1}));
}

// A quad over the whole target in two, whose diagonal leaves through two corners.
TEST(ClipMesh, CountsHolesAndDoubles) {
  Setting setting;
  setting.target = {8, 8};
  const std::array<ClipTriangle, 2> quad{
      {{{{-2, -2, 0, 1}, {2, -2, 0, 1}, {2, 2, 0, 1}}}, {{{-2, -2, 0, 1}, {2, 2, 0, 1}, {-2, 2, 0, 1}}}}};
  const MaskLayout layout(setting);
  std::vector<std::uint64_t> inside(layout.words());
  ASSERT_TRUE(certainly_inside(setting, 8, {0, 0, 8, 8}, NearPlane::zero, quad, inside));
  for (const std::uint64_t row : inside) EXPECT_EQ(row, 0xFFu);
  std::vector<std::uint64_t> masks(2 * layout.words());
  for (std::size_t y = 0; y < 8; ++y) {
    masks[y] = 0xFF & (0xFF << y);
    masks[8 + y] = 0xFF & ~masks[y];
  }
  Cracks cracks;
  count_cracks(setting, inside, masks, 5, cracks);
  EXPECT_EQ(cracks.samples_inside, 64u);
  EXPECT_FALSE(cracks.first);
  masks[8 + 3] &= ~std::uint64_t{0b010};
  masks[8 + 4] |= 0b10000;
  count_cracks(setting, inside, masks, 7, cracks);
  EXPECT_EQ(cracks.meshes, 2u);
  EXPECT_EQ(cracks.torn_meshes, 1u);
  EXPECT_EQ(cracks.holes, 1u);
  EXPECT_EQ(cracks.doubled, 1u);
  EXPECT_EQ(cracks.first, (WrongSample{WrongSample::Kind::missing, 7, 1, 3, 0}));
  setting.scissor = Rect{2, 2, 3, 1};
  ASSERT_TRUE(certainly_inside(setting, 8, {0, 0, 8, 8}, NearPlane::zero, quad, inside));
  for (std::size_t y = 0; y < 8; ++y) EXPECT_EQ(inside[y], y == 2 ? 0b11100u : 0u);
}

// A clipper that cuts at |x| = w and |y| = w, and goes to the new vertex from one end of the edge in steps of 1/256:
// from the end that comes first in the triangle, or from the one that is inside.
enum class From { first, inside };

std::vector<Triangle> clipped(const Viewport& viewport, const ClipTriangle& triangle, From from) {
  std::vector<ClipPosition> polygon(triangle.begin(), triangle.end());
  for (int plane = 0; plane < 4; ++plane) {
    const auto distance = [&](const ClipPosition& p) {
      const float v = plane < 2 ? p.x : p.y;
      return plane % 2 == 0 ? p.w - v : p.w + v;
    };
    std::vector<ClipPosition> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      ClipPosition a = polygon[i];
      ClipPosition b = polygon[(i + 1) % polygon.size()];
      if (distance(a) >= 0) kept.push_back(a);
      if ((distance(a) >= 0) == (distance(b) >= 0)) continue;
      if (from == From::inside && distance(a) < 0) std::swap(a, b);
      const float t = distance(a) / (distance(a) - distance(b));
      const auto step = [&](float low, float high) { return std::floor(t * (high - low) * 256) / 256; };
      kept.push_back({a.x + step(a.x, b.x), a.y + step(a.y, b.y), 0.5F, a.w + step(a.w, b.w)});
    }
    polygon = kept;
  }
  std::vector<Position> window;
  for (const ClipPosition& p : polygon) {
    window.push_back(
        {viewport.x + (p.x / p.w + 1) * viewport.width / 2, viewport.y + (p.y / p.w + 1) * viewport.height / 2});
  }
  std::vector<Triangle> fan;
  for (std::size_t i = 2; i < window.size(); ++i) fan.push_back({window[0], window[i - 1], window[i]});
  return fan;
}

Cracks cracks_of(const Scene& scene, From from) {
  const MaskLayout layout(scene.setting);
  std::vector<std::uint64_t> inside(layout.words());
  Cracks total;
  for (const Mesh& mesh : scene.meshes) {
    const auto triangles = triangles_of(scene, mesh);
    // Those that only x and y cut.
    const bool flat = std::ranges::all_of(triangles, [](const ClipTriangle& t) { return t[0].z == t[0].w / 2; });
    if (!flat || !certainly_inside(scene.setting, 8, scene.clip->viewport, NearPlane::zero, triangles, inside))
      continue;
    std::vector<std::uint64_t> masks;
    for (const ClipTriangle& t : triangles) {
      std::vector<std::uint64_t> whole(layout.words());
      std::vector<std::uint64_t> part(layout.words());
      for (const Triangle& window : clipped(scene.clip->viewport, t, from)) {
        oracle::cover_by_definition(scene.setting, scene.rules, window, part);
        for (std::size_t i = 0; i < whole.size(); ++i) whole[i] |= part[i];
      }
      masks.insert(masks.end(), whole.begin(), whole.end());
    }
    count_cracks(scene.setting, inside, masks, mesh.first, total);
  }
  return total;
}

TEST(ClipMesh, AClipperThatCutsFromEitherEndTearsMeshes) {
  const Scene scene = scenes("clip_grids", 200);
  const Cracks torn = cracks_of(scene, From::first);
  EXPECT_GT(torn.samples_inside, 10'000u);
  EXPECT_GT(torn.holes, 10u);
  EXPECT_GT(torn.doubled, 10u);
  EXPECT_GT(torn.torn_meshes, 5u);
  const Cracks whole = cracks_of(scene, From::inside);
  EXPECT_EQ(whole.samples_inside, torn.samples_inside);
  // Not none: the border is off by more than binary32 would have it.
  EXPECT_LT(whole.holes + whole.doubled, (torn.holes + torn.doubled) / 10);
}

// Draws as the model of lavapipe says, which the judge is given as well.
class Modelled : public Subject {
 public:
  explicit Modelled(std::string name) {
    info_.name = std::move(name);
    info_.clip = true;
    info_.max_viewport = 4096;
    info_.viewport_bound = 4096;
    info_.scissor = true;
  }
  const SubjectInfo& info() const override { return info_; }
  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    return Reference(nullptr, lavapipe_model()).expect(scene, 1, masks);
  }

 private:
  SubjectInfo info_;
};

// "Cracks" in what is no mesh: a triangle is drawn twice. It is drawn as the model predicts, so that it is no failure.
TEST(ClipMesh, PredictedCracksAreShownAndNoFailure) {
  Modelled subject("lavapipe");
  Reference reference(nullptr, lavapipe_model());
  Judge judge(subject, reference, nullptr);
  Batch batch;
  batch.scene.setting.target = {8, 8};
  batch.scene.clip = ClipGeometry{{0, 0, 8, 8},
                                  {{{{-1, -1, 0, 1}, {3, -1, 0, 1}, {-1, 3, 0, 1}}},
                                   {{{-0.5f, -0.5f, 0, 1}, {0.5f, -0.5f, 0, 1}, {-0.5f, 0.5f, 0, 1}}}}};
  batch.scene.meshes = {{0, 2}};
  batch.parts = {{0, 0}};
  Outcome outcome;
  ASSERT_TRUE(judge.judge(batch, 0, outcome));
  EXPECT_EQ(outcome.unexplained, 0u);
  EXPECT_GT(outcome.cracks.doubled, 0u);
  EXPECT_EQ(outcome.cracks.holes, 0u);
  ASSERT_EQ(outcome.findings.size(), 1u);
  const Finding& finding = outcome.findings[0];
  EXPECT_TRUE(finding.crack);
  EXPECT_TRUE(finding.known);
  const MaskLayout layout(batch.scene.setting);
  const std::size_t bit = layout.bit(finding.wrong.x, finding.wrong.y, finding.wrong.sample);
  int expected = 0;
  int observed = 0;
  for (std::size_t i = 0; i < finding.expected.size(); ++i) {
    expected += covered(finding.expected[i], bit) ? 1 : 0;
    observed += covered(finding.observed[i], bit) ? 1 : 0;
  }
  EXPECT_EQ(expected, 1);
  EXPECT_EQ(observed, 2);
}

}  // namespace
}  // namespace edgecase::conformance
