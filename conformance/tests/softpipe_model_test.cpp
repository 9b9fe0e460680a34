// The model of softpipe against softpipe: no wrong sample in any family of triangles, and what the model says of it.
#include "conformance/models/softpipe_model.h"

#include <bit>
#include <cmath>
#include <numbers>

#include "conformance/tests/driver_subject_checks.h"

namespace edgecase::conformance {
namespace {

std::vector<std::uint64_t> predicted(const Setting& setting, const Triangle& triangle) {
  // Filled, to see that every word is written.
  std::vector<std::uint64_t> mask(MaskLayout(setting).words(), ~std::uint64_t{0});
  predict_softpipe(setting, triangle, mask);
  return mask;
}

void expect_predicted(Subject& softpipe, const Scene& scene) {
  const MaskBatch masks = drawn(softpipe, scene);
  ASSERT_EQ(masks.size(), scene.triangles.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    ASSERT_EQ(rows_of(scene.setting, masks[i]), rows_of(scene.setting, predicted(scene.setting, t)))
        << std::hexfloat << "triangle " << i << ": (" << t[0].x << ", " << t[0].y << ") (" << t[1].x << ", " << t[1].y
        << ") (" << t[2].x << ", " << t[2].y << ")";
  }
}

float on_grid(double value, int step) { return static_cast<float>(std::nearbyint(value * 256 / step) * step) / 256.0F; }

// Closed fans with 3 to 16 spokes around a centre; `step` / 256 px is the lattice.
Scene fans(int side, std::size_t count, int step, unsigned seed) {
  Scene scene;
  scene.setting = square_setting(side);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  while (scene.triangles.size() < count) {
    const int spokes = 3 + static_cast<int>(random() % 14);
    const double radius = side * (0.2 + 0.3 * unit(random));
    const double turn = unit(random);
    const Position centre{on_grid(side / 2.0 + 4 * unit(random) - 2, step),
                          on_grid(side / 2.0 + 4 * unit(random) - 2, step)};
    std::vector<Position> rim;
    for (int i = 0; i < spokes; ++i) {
      const double angle = 2 * std::numbers::pi * (i + turn) / spokes;
      rim.push_back(
          {on_grid(side / 2.0 + radius * std::cos(angle), step), on_grid(side / 2.0 + radius * std::sin(angle), step)});
    }
    scene.meshes.push_back({scene.triangles.size(), rim.size()});
    for (std::size_t i = 0; i < rim.size(); ++i) scene.triangles.push_back({centre, rim[i], rim[(i + 1) % rim.size()]});
  }
  return scene;
}

// Two vertices far apart, the third within 1/256 to 1/2 px of the line between them.
Scene slivers(int side, std::size_t count, unsigned seed) {
  Scene scene = random_scene(square_setting(side), count, -side, 2 * side, 1, seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (Triangle& t : scene.triangles) {
    const double along = unit(random);
    const double off = std::exp2(-8 * unit(random));
    t[2] = {on_grid(t[0].x + along * (t[1].x - t[0].x) + off, 1),
            on_grid(t[0].y + along * (t[1].y - t[0].y) - off * unit(random), 1)};
  }
  return scene;
}

// Slivers up to 16,000 px long whose line passes through the target: the products of their area no longer fit a float,
// so that it comes out as 0, or with the wrong sign.
Scene needles(int side, std::size_t count, unsigned seed) {
  Scene scene;
  scene.setting = square_setting(side);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  while (scene.triangles.size() < count) {
    const double x = side * unit(random);
    const double y = side * unit(random);
    const double angle = 2 * std::numbers::pi * unit(random);
    const auto at = [&](double along, double off) {
      return Position{on_grid(x + along * std::cos(angle) - off * std::sin(angle), 1),
                      on_grid(y + along * std::sin(angle) + off * std::cos(angle), 1)};
    };
    const double length = 8000 * unit(random);
    const double off = random() % 2 == 0 ? 0 : std::exp2(-8 * unit(random));
    scene.triangles.push_back({at(-length, 0), at(length, 0), at(length * (2 * unit(random) - 1), off)});
  }
  return scene;
}

// All 24 bits of each coordinate in use.
Scene off_grid(int side, std::size_t count, unsigned seed) {
  Scene scene;
  scene.setting = square_setting(side);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> anywhere(static_cast<float>(-side), static_cast<float>(2 * side));
  while (scene.triangles.size() < count) {
    Triangle t;
    for (Position& p : t) p = {anywhere(random), anywhere(random)};
    scene.triangles.push_back(t);
  }
  return scene;
}

void expect_every_family_predicted(std::size_t count, unsigned seed) {
  const auto softpipe = subject_or_failure("osmesa-softpipe");
  ASSERT_NE(softpipe, nullptr);
  for (const int side : {1, 7, 32, 65}) {
    const Setting setting = square_setting(side);
    for (const int step : {1, 32, 128, 256}) {  // 128: the half-pixel lattice, 256: whole pixels
      expect_predicted(*softpipe, random_scene(setting, count, -side / 4, side + side / 4 + 1, step, seed));
      expect_predicted(*softpipe, fans(side, count / 2, step, seed));
    }
    expect_predicted(*softpipe, random_scene(setting, count, side / 2, side / 2 + 1, 1, seed));
    expect_predicted(*softpipe, random_scene(setting, count / 4, -8192, 8192, 1, seed));
    expect_predicted(*softpipe, slivers(side, count, seed));
    expect_predicted(*softpipe, needles(side, count, seed));
    expect_predicted(*softpipe, off_grid(side, count, seed));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(SoftpipeModel, PredictsEveryFamily) { expect_every_family_predicted(1500, 1); }
TEST(LongSoftpipeModel, PredictsEveryFamily) {
  for (unsigned seed = 2; seed < 12; ++seed) expect_every_family_predicted(10'000, seed);
}

TEST(SoftpipeModel, BreaksTiesInXToTheRight) {
  const Setting setting = square_setting(4);
  // The first two triangles of expect_hand_checked_masks: the top-left rule covers column 1 of the first, and does not
  // cover column 2 of the second.
  EXPECT_EQ(rows_of(setting, predicted(setting, {{{1.5F, 0}, {1.5F, 3}, {4, 3}}})),
            (std::vector<std::string>{"....", "..#.", "..##", "...."}));
  EXPECT_EQ(rows_of(setting, predicted(setting, {{{2.5F, 0}, {2.5F, 3}, {0, 3}}})),
            (std::vector<std::string>{"..#.", ".##.", "###.", "...."}));
}

// Two triangles on whole pixels share an edge that passes through a pixel's centre. One follows the edge as a whole,
// the other restarts it at its middle vertex: -3/5 columns a row, added once or twice, is rounded differently.
TEST(SoftpipeModel, SharedEdgeThroughACentreLeavesAHoleOrADouble) {
  const auto softpipe = subject_or_failure("osmesa-softpipe");
  ASSERT_NE(softpipe, nullptr);
  Scene scene;
  scene.setting = square_setting(6);
  scene.triangles = {Triangle{{{4, 1}, {1, 6}, {6, 2}}}, Triangle{{{1, 6}, {4, 1}, {2, 1}}},
                     Triangle{{{5, 0}, {2, 5}, {5, 4}}}, Triangle{{{2, 5}, {5, 0}, {1, 1}}}};
  expect_predicted(*softpipe, scene);
  const MaskLayout layout(scene.setting);
  const auto times_covered = [&](std::size_t first, int x, int y) {
    int count = 0;
    for (std::size_t i = first; i < first + 2; ++i) {
      count += covered(predicted(scene.setting, scene.triangles[i]), layout.bit(x, y, 0)) ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(times_covered(0, 2, 3), 0) << "a hole: (2.5, 3.5) lies on the edge from (4, 1) to (1, 6)";
  EXPECT_EQ(times_covered(2, 3, 2), 2) << "a double: (3.5, 2.5) lies on the edge from (5, 0) to (2, 5)";
}

}  // namespace
}  // namespace edgecase::conformance
