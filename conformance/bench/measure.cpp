#include "conformance/bench/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "conformance/bench/geometry.h"
#include "conformance/bench/instructions.h"
#include "conformance/oracle/oracle.h"
#include "rasterizer/rasterizer.h"
#include "rasterizer/scalar.h"

namespace edgecase::conformance {
namespace {

/// One in this many triangles of the scalar rasterizer's answers is given to the oracle.
constexpr std::size_t kJudgedShare = 64;

/// The rows of the target that hold every sample in the triangle's bounding box, and one more on either side.
std::pair<std::size_t, std::size_t> rows_of(const Triangle& triangle, int height) {
  const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  const auto row = [&](float y) { return static_cast<std::size_t>(std::clamp(y, 0.0f, static_cast<float>(height))); };
  return {row(std::floor(low) - 1), row(std::floor(high) + 2)};
}

/// What the scalar rasterizer covers.
class Expectation {
 public:
  explicit Expectation(const Scene& scene)
      : scene_(scene),
        target_(*rasterizer::Target::make(scene.setting.target.width, scene.setting.target.height)),
        words_(target_.mask_words()) {}

  std::vector<std::uint64_t>& words() { return words_; }

  /// Adds triangle i of the scene.
  tl::expected<void, Error> add(std::size_t i) {
    const auto& [v0, v1, v2] = scene_.triangles[i];
    rasterizer::FixedTriangle<rasterizer::Format16_8> snapped;
    const rasterizer::Triangle triangle{{{v0.x, v0.y}, {v1.x, v1.y}, {v2.x, v2.y}}};
    if (const auto error = rasterizer::snap<rasterizer::Format16_8>(triangle, snapped, i)) {
      return tl::unexpected(Error{ErrorKind::bad_input, rasterizer::describe(*error)});
    }
    const auto mask = *rasterizer::Mask::over(target_, words_);
    rasterizer::cover_scalar<rasterizer::Format16_8>(
        snapped, rasterizer::View<>{target_}, [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
    return {};
  }

 private:
  const Scene& scene_;
  rasterizer::Target target_;
  std::vector<std::uint64_t> words_;
};

/// Holds the scalar rasterizer against the oracle on the stated share of the triangles.
tl::expected<void, Error> judge_expectation(const Scene& scene) {
  Expectation expectation(scene);
  std::vector<std::uint64_t> oracle_mask(expectation.words().size());
  for (std::size_t i = 0; i < scene.triangles.size(); i += kJudgedShare) {
    std::ranges::fill(expectation.words(), 0);
    if (auto added = expectation.add(i); !added) return added;
    oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], oracle_mask);
    if (expectation.words() != oracle_mask) {
      return tl::unexpected(
          Error{ErrorKind::subject, fmt::format("our rasterizer and the oracle differ on triangle {}", i)});
    }
  }
  return {};
}

}  // namespace

tl::expected<ErrorCount, Error> count_errors(Contender& contender, const Scene& scene, Truth truth) {
  const MaskLayout layout(scene.setting);
  // Between triangles only the rows that the triangle can reach are looked at and cleared; what a contender put
  // elsewhere stays, and is counted at the end.
  Expectation expectation(scene);
  std::vector<std::uint64_t>& expected = expectation.words();
  std::vector<std::uint64_t> observed(layout.words());
  ErrorCount count;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    contender.cover(i, observed);
    if (truth == Truth::real_geometry) {
      cover_geometry(scene.triangles[i], scene.setting.target, expected);
    } else if (auto added = expectation.add(i); !added) {
      return tl::unexpected(added.error());
    }
    const auto [first, last] = rows_of(scene.triangles[i], layout.target.height);
    for (std::size_t k = first * layout.row_words(); k < last * layout.row_words(); ++k) {
      count.wrong += static_cast<std::uint64_t>(std::popcount(observed[k] ^ expected[k]));
      count.covered += static_cast<std::uint64_t>(std::popcount(expected[k]));
      observed[k] = expected[k] = 0;
    }
  }
  for (const std::uint64_t word : observed) count.wrong += static_cast<std::uint64_t>(std::popcount(word));
  return count;
}

namespace {

/// Prepares the contender for the scene and has it draw once.
tl::expected<void, Error> warm_up(Contender& contender, const Scene& scene) {
  if (auto prepared = contender.prepare(scene); !prepared) return prepared;
  contender.clear();
  return contender.draw();
}

double wrong_per_million(const ErrorCount& count) {
  return count.covered == 0 ? 0 : static_cast<double>(count.wrong) / static_cast<double>(count.covered) * 1e6;
}

/// The share of a workload's triangles that is judged by the real geometry, at most, and how many.
constexpr std::size_t kRealShare = 5;
constexpr std::size_t kMostReal = 20'000;

/// Nothing for a workload without real geometry.
tl::expected<std::optional<double>, Error> real_error(const Workload& workload, std::size_t wanted, std::uint64_t seed,
                                                      Contender& contender) {
  const std::size_t count = std::min({wanted, workload.triangles / kRealShare, kMostReal});
  auto scene = make_off_grid(workload, count, seed);
  if (!scene) return std::nullopt;
  scene->triangles.resize(std::min(scene->triangles.size(), contender.most_triangles(*scene)));
  if (auto drawn = warm_up(contender, *scene); !drawn) return tl::unexpected(drawn.error());
  const auto counted = count_errors(contender, *scene, Truth::real_geometry);
  if (!counted) return tl::unexpected(counted.error());
  return wrong_per_million(*counted);
}

/// Whatever sets up neighbours together, 16 at most, finds them together.
constexpr std::size_t kNeighbours = 16;

/// `count` of the scene's triangles: the first, or as many groups of neighbours spread over all of it.
Scene part_of(const Scene& scene, std::size_t count) {
  Scene part = scene;
  part.triangles.resize(count);
  const std::size_t groups = count / kNeighbours, all = scene.triangles.size() / kNeighbours;
  for (std::size_t i = 0; i < groups * kNeighbours; ++i) {
    part.triangles[i] = scene.triangles[i / kNeighbours * all / groups * kNeighbours + i % kNeighbours];
  }
  return part;
}

/// Instructions of a triangle, one by one, of as many triangles as `most` suffices for. Which ones depends on nothing
/// but the instructions: equal programs have equal counts.
tl::expected<std::optional<double>, Error> step_through_draw(Contender& contender, const Scene& scene,
                                                             std::uint64_t most) {
  std::optional<double> each;
  for (std::size_t count = 1, next = 0;; count = next) {
    const Scene part = part_of(scene, count);
    if (auto drawn = warm_up(contender, part); !drawn) return tl::unexpected(drawn.error());
    if (contender.clock() != Clock::thread) return std::nullopt;
    contender.clear();
    tl::expected<void, Error> drawn;
    const auto steps = step_through([&] { drawn = contender.draw(); }, most);
    if (!drawn) return tl::unexpected(drawn.error());
    if (!steps) return each;
    each = std::max(static_cast<double>(*steps), 1.0) / static_cast<double>(count);
    // The more triangles, the less weighs what they share: more may fit than fewer made it seem.
    next = std::min(static_cast<std::size_t>(static_cast<double>(most) * 0.9 / *each), scene.triangles.size());
    if (next >= kNeighbours) next -= next % kNeighbours;
    if (next < 2 * count) return each;
  }
}

/// Of one draw of a contender that has drawn before.
tl::expected<std::optional<double>, Error> count_draw(Contender& contender, std::size_t triangles) {
  if (contender.clock() != Clock::thread) return std::nullopt;
  contender.clear();
  tl::expected<void, Error> drawn;
  const auto count = count_instructions([&] { drawn = contender.draw(); });
  if (!drawn) return tl::unexpected(drawn.error());
  if (!count) return std::nullopt;
  return static_cast<double>(*count) / static_cast<double>(triangles);
}

}  // namespace

tl::expected<std::vector<BenchRow>, Error> measure(const Workload& workload,
                                                   const std::vector<std::unique_ptr<Contender>>& contenders,
                                                   const Effort& effort, std::uint64_t seed) {
  std::vector<BenchRow> rows;
  std::vector<std::uint64_t> covered;
  const std::size_t wanted = std::max<std::size_t>(workload.triangles / effort.divisor, 4);
  const Scene whole = make_workload(workload, wanted, seed);
  if (auto judged = judge_expectation(whole); !judged) return tl::unexpected(judged.error());
  for (const auto& contender : contenders) {
    const auto real = real_error(workload, wanted, seed, *contender);
    if (!real) return tl::unexpected(real.error());
    Scene scene = whole;
    if (const std::size_t most = contender->most_triangles(scene); most < scene.triangles.size()) {
      scene = make_workload(workload, most, seed);
    }
    tl::expected<std::optional<double>, Error> instructions;
    const bool counter = has_instruction_counter();
    if (!counter && effort.steps != 0) instructions = step_through_draw(*contender, scene, effort.steps);
    if (auto drawn = warm_up(*contender, scene); !drawn) return tl::unexpected(drawn.error());
    const auto counted = count_errors(*contender, scene);
    if (!counted) return tl::unexpected(counted.error());
    if (counter) instructions = count_draw(*contender, scene.triangles.size());
    if (!instructions) return tl::unexpected(instructions.error());
    BenchRow& row = rows.emplace_back();
    row.rasterizer = contender->name();
    row.isa = contender->isa();
    row.workload = workload.name;
    row.clock = contender->clock();
    row.target = contender->target().value_or(scene.setting.target);
    row.triangles = scene.triangles.size();
    row.wrong_per_million = wrong_per_million(*counted);
    row.wrong_per_million_real = *real;
    row.instructions_per_triangle = *instructions;
    covered.push_back(counted->covered);
  }
  const auto seconds = time_draws(contenders, effort.repetitions);
  if (!seconds) return tl::unexpected(seconds.error());

  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Statistics draw = (*seconds)[i];
    BenchRow& row = rows[i];
    row.ns_per_triangle = draw.median / static_cast<double>(row.triangles) * 1e9;
    row.spread = draw.spread;
    row.ratio_to_plain = rows.front().ns_per_triangle / row.ns_per_triangle;
    row.covered_px_per_second = static_cast<double>(covered[i]) / draw.median;
  }
  return rows;
}

}  // namespace edgecase::conformance
