#include "rasterizer/threads/parts.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace edgecase::rasterizer {

Parts Parts::falling(std::size_t chunks, std::size_t threads, std::span<const double> work) {
  // After so many batches twice as many chunks are left as there are threads, at most four times as many.
  const std::size_t of_a_thread = std::max<std::size_t>(chunks / (2 * threads), 1);
  const auto batches = static_cast<std::size_t>(std::bit_width(of_a_thread)) - 1;
  std::vector<double> until(work.size());
  std::partial_sum(work.begin(), work.end(), until.begin());
  assert(!until.empty() && until.back() > 0);
  const double per_unit = 1 / until.back();
  for (double& share : until) share *= per_unit;
  return Parts(chunks, threads, batches, std::min(2 * threads, chunks), std::move(until));
}

std::size_t Parts::begin(std::size_t part) const {
  if (part == 0 || part >= count()) return part == 0 ? 0 : chunks_;
  const double share = work_before(part);
  double of_list = share;
  if (!work_until_.empty()) {
    // The stretch in which it lies, and where: both rise with it, so that parts follow each other.
    const auto stretch = std::ranges::upper_bound(work_until_, share);
    if (stretch == work_until_.end()) return chunks_;
    const double from = stretch == work_until_.begin() ? 0 : stretch[-1];
    of_list = (static_cast<double>(stretch - work_until_.begin()) + (share - from) / (*stretch - from)) /
              static_cast<double>(work_until_.size());
  }
  return std::min(static_cast<std::size_t>(of_list * static_cast<double>(chunks_) + 0.5), chunks_);
}

}  // namespace edgecase::rasterizer
