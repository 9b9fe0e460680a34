// Scaling: how the time of a draw falls with the number of threads, beyond the processors that there are.
//
// The tasks of a drawing (rasterizer/threads/tiled_draw.h) are timed one after the other on one thread, and then played
// through the very agenda that the threads follow, on as many of them as asked for. Beside that stands what is measured
// where there are as many processors, and what threads reach there that share nothing but the machine.
//
// What the model leaves out:
//   - cache lines that move between processors: a helper's mask is added up by all threads, so half of its lines, and
//     as many of the target's, are in another one's cache. It weighs on draws of a few hundred us; a mask shared by
//     many threads moves more of it. `line` says how far apart the processors are;
//   - bandwidth that processors share, of the last-level cache and the memory: who draws into a large target alone may
//     already use most of it;
//   - clocks that fall as more processors work, and neighbours on the same machine: what `apart` shows;
//   - how long it takes to start threads beyond the processors that there are: start_awake() and start_asleep() are
//     measured for one and assumed for others.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/bench/whole_draws.h"
#include "conformance/scene/error.h"
#include "rasterizer/threads/plan.h"

namespace edgecase::conformance {

/// ns of each task of a drawing on one thread.
struct TaskCosts {
  double plan = 0;                         ///< before threads start
  std::vector<double> bins;                ///< of each chunk; none if there is but one tile
  std::vector<std::vector<double>> parts;  ///< of each tile
  std::vector<double> tiles;  ///< to clear and to add a mask of each tile, once for each thread that has one
};

struct Schedule {
  double end = 0;    ///< ns until the last thread is done, from the call on
  double tasks = 0;  ///< the sum of all tasks, helpers' masks included
};

/// Plays the tasks through the agenda with plan.threads threads, of which thread i starts at start(i).
Schedule play(const TaskCosts& costs, const rasterizer::Plan& plan, double (*start)(int thread));

struct ScalingPoint {
  std::string workload;
  std::size_t triangles = 0;
  int threads = 0;  ///< that there are
  int used = 0;     ///< by the plan
  int tile_columns = 0;
  int tile_rows = 0;
  std::size_t chunks = 0;
  double one_thread_ns = 0;  ///< the fast path by itself
  double tasks_ns = 0;       ///< all tasks of these threads
  double predicted_ns = 0;
  double predicted_speedup = 0;
  double predicted_asleep = 0;           ///< the speed-up, if the threads have to be woken
  std::optional<WholeDraws> measured{};  ///< where there are that many processors
};

struct ScalingEffort {
  std::size_t repetitions;  ///< the least time of a task counts, and the median of whole draws
  std::size_t divisor;      ///< of the number of the workloads' triangles
};
inline constexpr ScalingEffort kQuickScaling{2, 100};
inline constexpr ScalingEffort kThoroughScaling{9, 1};

/// The names of workloads(), and wide200: 200,000 triangles of 200 px on 16384x16384 pixels.
std::vector<std::string_view> scaling_workloads();

/// Each of these workloads for 1, 2, 4 ... 64 threads.
tl::expected<std::vector<ScalingPoint>, Error> measure_scaling(std::span<const std::string_view> names,
                                                               const ScalingEffort& effort, std::uint64_t seed);

/// {"points": [...]}, an object per point with the fields' names as keys, indented.
std::string scaling_json(std::span<const ScalingPoint> points);
std::string scaling_table(std::span<const ScalingPoint> points);
/// The gnuplot program for a PNG at `path`.
std::string scaling_plot_program(std::span<const ScalingPoint> points, const std::string& path);

}  // namespace edgecase::conformance
