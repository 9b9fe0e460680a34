// What the rules demand of a batch of triangles: a fast answer, and the oracles to judge it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// One in this many triangles that our fast rasterizer answers for is given to both oracles as well.
inline constexpr std::uint64_t kOracleShare = 64;

class Reference {
 public:
  /// `fast` answers in bulk, and the oracles judge it; without it the oracle by definition answers for every triangle.
  explicit Reference(std::unique_ptr<Subject> fast) : fast_(std::move(fast)) {}

  /// Fills `must` with one mask per triangle of `scene`. `first_index` counts on through a run and picks the share that
  /// the oracles check. An error is a fault of ours: two of the three answers differ.
  tl::expected<void, Error> expect(const Scene& scene, std::uint64_t first_index, MaskBatch& must);

  /// Gives triangle `index` of `scene` to both oracles; an error if one of them differs from `must`.
  tl::expected<void, Error> confirm(const Scene& scene, std::size_t index, MaskView must);

  /// Triangles given to both oracles so far.
  std::uint64_t confirmed() const { return confirmed_; }

 private:
  /// Fills snapped_ with the scene's vertices as its rules snap them; exact, a grid coordinate having at most 24 bits.
  void snap_all(const Scene& scene);

  std::unique_ptr<Subject> fast_;
  Scene snapped_;
  std::vector<std::uint64_t> scratch_;
  std::uint64_t confirmed_ = 0;
};

}  // namespace edgecase::conformance
