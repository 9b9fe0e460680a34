// Measuring one workload: how long each contender takes, and how much of what it covers is wrong.
//
// Time. Google Benchmark runs every contender's draw() several times over, the repetitions of all contenders shuffled,
// so that a slow phase of the machine meets all of them; a ratio counts only within one such run. Masks are cleared,
// and short lists put into another order, outside the time. Whose time that is, see Clock.
//
// Error. Every triangle is drawn on its own and held against the scalar rasterizer, so that a missing and an
// unexpected pixel never cancel; one triangle in 64 of those answers is held against the oracle by definition. That is
// the error against the rules, of which snapping to 8 subpixel bits is a part: the vertices are on that grid. The error
// against the real geometry is another one: the vertices lie between the points of the grid, and what the unsnapped
// triangle covers is expected. Who snaps as the rules say has some.
//
// Instructions. Of a whole draw, where the machine counts them. Where it does not, they can be counted one by one, see
// instructions.h, of a draw of as many triangles as Effort::steps suffice for, in whole groups spread over the
// workload.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/bench/contender.h"
#include "conformance/bench/timing.h"
#include "conformance/bench/workloads.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// One contender on one workload.
struct BenchRow {
  std::string rasterizer;
  std::string isa;
  std::string workload;
  std::size_t triangles = 0;
  double ns_per_triangle = 0;    ///< the median of the repetitions
  double spread = 0;             ///< the difference of their upper and lower quartile over the median
  double ratio_to_plain = 0;     ///< how many times as fast as the plain loop; above 1 is faster
  double wrong_per_million = 0;  ///< missing and unexpected pixels, over the pixels that are to be covered
  double covered_px_per_second = 0;
  Clock clock = Clock::thread;
  Extent target{};  ///< that it drew on
  /// Against the real geometry; nothing for workloads that have none, see make_off_grid.
  std::optional<double> wrong_per_million_real{};
  /// Of one draw, outside the kernel; nothing if they were not counted, are not run by this thread, or are too many.
  std::optional<double> instructions_per_triangle{};
};

struct Effort {
  Repetitions repetitions;
  /// Divides the number of the workload's triangles.
  std::size_t divisor;
  /// The most instructions of a row to count one by one, if the machine has no counter; 0 for not at all.
  std::uint64_t steps = 0;
};
inline constexpr std::uint64_t kManySteps = 200'000;
inline constexpr Effort kQuick{{3, 0.01}, 100};
/// A quarter: the slowest arithmetics take half a second for one draw of a whole workload.
inline constexpr Effort kThorough{{9, 0.05}, 4};

/// A row per contender, in their order. The first of them must be the plain loop.
tl::expected<std::vector<BenchRow>, Error> measure(const Workload& workload,
                                                   const std::vector<std::unique_ptr<Contender>>& contenders,
                                                   const Effort& effort, std::uint64_t seed);

/// What a pixel is expected to be.
enum class Truth { rules, real_geometry };

/// Pixels that `contender`, prepared for `scene` and drawn, covers wrongly, each triangle on its own, and pixels that
/// are to be covered.
struct ErrorCount {
  std::uint64_t wrong = 0;
  std::uint64_t covered = 0;
};
tl::expected<ErrorCount, Error> count_errors(Contender& contender, const Scene& scene, Truth truth = Truth::rules);

}  // namespace edgecase::conformance
