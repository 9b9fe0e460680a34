#include "conformance/oracle/lattice_oracle.h"

#include <cassert>
#include <cmath>

namespace edgecase::conformance::oracle {

std::size_t LatticeOracle::points_of(const Extent& target, int bits) {
  const auto points = [&](int extent) { return (static_cast<std::size_t>(extent) << bits) + 1; };
  return points(target.width) * points(target.height);
}

LatticeOracle::LatticeOracle(const Extent& target, int bits) : target_(target), bits_(bits) {
  const std::size_t count = points_of(target, bits);
  assert(target.width * target.height <= kMostPixels && count <= kMostPoints && bits >= 0 && bits <= 8);
  const auto rows = std::int64_t{target.height} << bits;
  const auto columns = std::int64_t{target.width} << bits;
  for (std::int64_t y = 0; y <= rows; ++y) {
    for (std::int64_t x = 0; x <= columns; ++x) {
      grid_.push_back({2 * x, 2 * y});
      positions_.push_back({std::ldexp(static_cast<float>(x), -bits), std::ldexp(static_cast<float>(y), -bits)});
    }
  }
  accepted_.resize(count * count);
  backwards_.resize(count * count);
  for (std::size_t from = 0; from < count; ++from) {
    for (std::size_t to = 0; to < count; ++to) {
      accepted_[from * count + to] = backwards_[to * count + from] = accepted(grid_[from], grid_[to]);
    }
  }
}

// The samples on the right-hand side of from -> to as seen on the screen (y down), and those on the edge if it is a top
// or a left edge: with the inside on its right, a top edge runs to the right, a left edge upwards.
std::uint64_t LatticeOracle::accepted(const Point& from, const Point& to) const {
  const std::int64_t dx = to.x - from.x;
  const std::int64_t dy = to.y - from.y;
  const bool top_or_left = (dy == 0 && dx > 0) || dy < 0;
  std::uint64_t mask = 0;
  for (int y = 0; y < target_.height; ++y) {
    for (int x = 0; x < target_.width; ++x) {
      const Point centre{(2 * std::int64_t{x} + 1) << bits_, (2 * std::int64_t{y} + 1) << bits_};
      const std::int64_t value = dx * (centre.y - from.y) - dy * (centre.x - from.x);
      if (value > 0 || (value == 0 && top_or_left)) mask |= std::uint64_t{1} << (y * target_.width + x);
    }
  }
  return mask;
}

void LatticeOracle::cover(std::size_t a, std::size_t b, std::size_t c, std::span<std::uint64_t> masks) const {
  const std::size_t count = points();
  const Point start = grid_[a];
  const std::int64_t dx = grid_[b].x - start.x;
  const std::int64_t dy = grid_[b].y - start.y;
  const std::uint64_t ab = accepted_[a * count + b];
  const std::uint64_t ba = accepted_[b * count + a];
  const std::uint64_t* const bc = &accepted_[b * count + c];
  const std::uint64_t* const cb = &backwards_[b * count + c];
  const std::uint64_t* const ca = &backwards_[a * count + c];
  const std::uint64_t* const ac = &accepted_[a * count + c];
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const std::int64_t area = dx * (grid_[c + i].y - start.y) - dy * (grid_[c + i].x - start.x);
    const std::uint64_t clockwise = ab & bc[i] & ca[i];
    const std::uint64_t counter_clockwise = ba & cb[i] & ac[i];
    masks[i] = area > 0 ? clockwise : area < 0 ? counter_clockwise : 0;
  }
}

}  // namespace edgecase::conformance::oracle
