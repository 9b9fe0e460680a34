#include "conformance/runner/triangle_choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <vector>

#include "conformance/oracle/allowed.h"

namespace edgecase::conformance {
namespace {

// By the other method. Of what is wrong the first sample is enough: a faulty subject may have millions, and each choice
// is a triangle.
tl::expected<void, Error> confirm_choices(const Scene& scene, const RuleSet& rule_set, std::size_t triangle,
                                          MaskView asked, MaskView must, MaskView may) {
  std::vector<std::uint64_t> one(asked.size()), must_again(asked.size()), may_again(asked.size());
  std::size_t w = 0;
  while (w + 1 < asked.size() && (asked[w] & ~may[w]) == 0) ++w;
  const std::uint64_t wrong = asked[w] & ~may[w];
  if (wrong != 0) one[w] = wrong & -wrong;
  if (wrong == 0) std::ranges::copy(asked, one.begin());
  oracle::allow_by_shift(scene.setting, scene.rules, rule_set, scene.triangles[triangle], one, must_again, may_again);
  for (w = 0; w < asked.size(); ++w) {
    if (must_again[w] == (must[w] & one[w]) && may_again[w] == (may[w] & one[w])) continue;
    return tl::unexpected(
        Error{ErrorKind::subject, fmt::format("the oracles differ on what {} allows of {}", rule_set.name,
                                              coordinates(scene.triangles[triangle]))});
  }
  return {};
}

}  // namespace

// What Rules and the top-left rule cover is legal under every set. So only the samples that the subject covers
// otherwise are asked for, and where that is legal, too, it becomes what is expected.
tl::expected<std::uint64_t, Error> grant_choices(const Scene& scene, const RuleSet& rule_set, std::uint64_t first_index,
                                                 const MaskBatchView& observed, Reference& reference,
                                                 MaskBatch& expected) {
  std::uint64_t granted = 0;
  const std::size_t words = MaskLayout(scene.setting).words();
  std::vector<std::uint64_t> asked(words), must(words), may(words);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (std::ranges::equal(expected[i], observed[i])) continue;
    std::ranges::transform(expected[i], observed[i], asked.begin(), std::bit_xor<>());
    oracle::allow_by_definition(scene.setting, scene.rules, rule_set, scene.triangles[i], asked, must, may);
    const bool legal = std::ranges::equal(may, asked);
    if (!legal || (first_index + i) % kOracleShare == 0) {
      if (auto confirmed = reference.confirm(scene, i, expected[i]); !confirmed)
        return tl::unexpected(confirmed.error());
      if (auto confirmed = confirm_choices(scene, rule_set, i, asked, must, may); !confirmed)
        return tl::unexpected(confirmed.error());
    }
    for (std::size_t w = 0; w < words; ++w) {
      granted += static_cast<std::uint64_t>(std::popcount(may[w]));
      expected[i][w] = (expected[i][w] & ~asked[w]) | must[w] | (observed[i][w] & may[w]);
    }
  }
  return granted;
}

}  // namespace edgecase::conformance
