#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "conformance/generators/families.h"

namespace edgecase::conformance::families {
namespace {

constexpr std::size_t kMaxSpokes = 64;

// A third of the fans lies on sample points, a third on pixel corners, a third anywhere on the lattice: the first two
// put vertices and edges exactly where the fill rule decides.
enum class Site { centres, corners, anywhere };

LatticePoint place(const Lattice& lattice, Site site, const LatticePoint& p) {
  switch (site) {
    case Site::centres:
      return lattice.to_centre(p);
    case Site::corners:
      return lattice.to_corner(p);
    case Site::anywhere:
      break;
  }
  return p;
}

struct Direction {
  double x = 0;
  double y = 0;
};

constexpr std::int64_t kTurn = 4096;

/// The directions of all multiples of 1/4096 of a turn. std::cos and std::sin may differ in the last place between
/// libraries; angles and lattice units so much coarser than that keep the spokes the same everywhere.
const std::array<Direction, kTurn>& directions() {
  static const auto all = [] {
    std::array<Direction, kTurn> result;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double angle = static_cast<double>(i) * (2 * std::numbers::pi / kTurn);
      result[i] = {std::cos(angle), std::sin(angle)};
    }
    return result;
  }();
  return all;
}

}  // namespace

// Spokes in order of angle, each strictly clockwise of the one before as seen from the centre, the last back to the
// first: then every triangle has positive area and together they go round exactly once, so the fan is watertight.
void fan(const Lattice& lattice, Random& random, Scene& scene) {
  const auto centre_site = static_cast<Site>(random.between(0, 2));
  const auto spoke_site = static_cast<Site>(random.between(0, 2));
  const LatticePoint centre = place(lattice, centre_site, lattice.anywhere(random, 0));
  const std::int64_t largest = std::min(lattice.width(), lattice.height());
  const std::int64_t reach = random.between(2 * lattice.pixel(), largest);

  std::array<LatticePoint, kMaxSpokes> spokes;
  std::size_t count = 0;
  const auto wanted = static_cast<std::size_t>(random.between(3, kMaxSpokes));
  const std::int64_t start = random.between(0, kTurn - 1);
  const std::int64_t slot = kTurn / static_cast<std::int64_t>(wanted);
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::int64_t turn = start + static_cast<std::int64_t>(i) * slot + random.between(0, slot - 1);
    const Direction& direction = directions()[static_cast<std::size_t>(turn % kTurn)];
    const auto radius = static_cast<double>(random.between(reach / 2, reach));
    const auto dx = static_cast<std::int64_t>(std::floor(radius * direction.x + 0.25));
    const auto dy = static_cast<std::int64_t>(std::floor(radius * direction.y + 0.25));
    const LatticePoint spoke = place(lattice, spoke_site, {centre.x + dx, centre.y + dy});
    if (count == 0 || orientation(centre, spokes[count - 1], spoke) > 0) spokes[count++] = spoke;
  }
  // The sites may have moved a spoke past the first one: take the last ones back until the round closes.
  while (count >= 3 && orientation(centre, spokes[count - 1], spokes[0]) <= 0) --count;
  if (count < 3) {  // a gap of half a turn or more: close it with the four axis directions instead
    const std::int64_t arm = lattice.pixel() * 2;
    spokes[0] = {centre.x + arm, centre.y};
    spokes[1] = {centre.x, centre.y + arm};
    spokes[2] = {centre.x - arm, centre.y};
    spokes[3] = {centre.x, centre.y - arm};
    count = 4;
  }

  scene.meshes.push_back({scene.triangles.size(), count});
  for (std::size_t i = 0; i < count; ++i) {
    scene.triangles.push_back(lattice.triangle(centre, spokes[i], spokes[(i + 1) % count]));
  }
}

}  // namespace edgecase::conformance::families
