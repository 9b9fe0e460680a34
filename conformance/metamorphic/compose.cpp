#include <algorithm>
#include <cassert>

#include "conformance/metamorphic/metamorphosis.h"

namespace edgecase::conformance {
namespace {

// The bits of a row of pixels, moved right by dx columns; those that leave the word are gone.
std::uint64_t moved(std::uint64_t row, int dx) {
  if (dx <= -64 || dx >= 64) return 0;
  return dx >= 0 ? row << dx : row >> -dx;
}

std::uint64_t full_row(int width) { return ~std::uint64_t{0} >> (64 - width); }

}  // namespace

void compose(const Experiment& experiment, std::span<const Piece> pieces, std::span<const MaskBatch> masks,
             Composition& composition) {
  const Extent base = experiment.base.setting.target;
  const auto rows = static_cast<std::size_t>(base.height);
  const std::uint64_t all = full_row(base.width);
  composition.covered.assign(rows, 0);
  composition.doubled.assign(rows, 0);
  composition.hidden.assign(rows, all);
  for (const Piece& piece : pieces) {
    const Extent target = experiment.variants[piece.variant].setting.target;
    assert(base.width <= 64 && target.width <= 64);
    const MaskView mask = masks[piece.variant][piece.triangle];
    const int first = std::max(0, piece.dy);
    const int end = std::min(base.height, target.height + piece.dy);
    for (int y = first; y < end; ++y) {
      const auto row = static_cast<std::size_t>(y);
      const std::uint64_t bits = moved(mask[static_cast<std::size_t>(y - piece.dy)], piece.dx) & all;
      composition.doubled[row] |= composition.covered[row] & bits;
      composition.covered[row] |= bits;
      composition.hidden[row] &= ~moved(full_row(target.width), piece.dx);
    }
  }
}

}  // namespace edgecase::conformance
