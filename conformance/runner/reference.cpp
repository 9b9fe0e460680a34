#include "conformance/runner/reference.h"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/oracle/oracle.h"

namespace edgecase::conformance {
namespace {

std::string coordinates(const Triangle& triangle) {
  return fmt::format("({:a}, {:a}) ({:a}, {:a}) ({:a}, {:a})", triangle[0].x, triangle[0].y, triangle[1].x,
                     triangle[1].y, triangle[2].x, triangle[2].y);
}

}  // namespace

tl::expected<void, Error> Reference::expect(const Scene& scene, std::uint64_t first_index, MaskBatch& must) {
  const bool fast = fast_ && !fast_->refusal(scene);
  if (fast) {
    if (auto drawn = fast_->draw(scene, must); !drawn) return drawn;
  } else {
    must.reset(MaskLayout(scene.setting), scene.triangles.size());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], must[i]);
    }
  }
  for (std::size_t i = (kOracleShare - first_index % kOracleShare) % kOracleShare; i < scene.triangles.size();
       i += kOracleShare) {
    if (auto confirmed = confirm(scene, i, must[i]); !confirmed) return confirmed;
  }
  return {};
}

tl::expected<void, Error> Reference::confirm(const Scene& scene, std::size_t index, MaskView must) {
  const Triangle& triangle = scene.triangles[index];
  scratch_.resize(must.size());
  ++confirmed_;
  oracle::cover_by_definition(scene.setting, scene.rules, triangle, scratch_);
  if (!std::ranges::equal(scratch_, must)) {
    return tl::unexpected(
        Error{ErrorKind::subject,
              fmt::format("our rasterizer and the oracle by definition differ on {}", coordinates(triangle))});
  }
  oracle::cover_by_shift(scene.setting, scene.rules, triangle, scratch_);
  if (!std::ranges::equal(scratch_, must)) {
    return tl::unexpected(
        Error{ErrorKind::subject, fmt::format("the oracles differ from each other on {}", coordinates(triangle))});
  }
  return {};
}

}  // namespace edgecase::conformance
