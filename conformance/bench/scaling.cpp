#include "conformance/bench/scaling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "conformance/bench/clock.h"
#include "conformance/bench/contenders.h"
#include "conformance/bench/progress.h"
#include "conformance/bench/whole_draws.h"
#include "conformance/bench/workloads.h"
#include "rasterizer/threads/agenda.h"
#include "rasterizer/threads/threads.h"
#include "rasterizer/threads/tiled_draw.h"

namespace edgecase::conformance {
namespace {

constexpr std::string_view kWide = "wide200";

using FixedTriangle = rasterizer::FixedTriangle<rasterizer::Format16_8>;
using rasterizer::Plan;
using rasterizer::StripMask;
using rasterizer::TiledDraw;

constexpr int kMostThreads = 64;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Keeps the least of what `act` takes: others run on this machine, too.
template <class Act>
void time_into(double& least, const Act& act, clockid_t clock = CLOCK_MONOTONIC) {
  least = std::min(least, time_of(act, clock));
}

TaskCosts time_tasks(const rasterizer::FastRasterizer& fast, std::span<const FixedTriangle> triangles, const Plan& plan,
                     std::size_t repetitions, StripMask& mask) {
  const auto tiles = static_cast<std::size_t>(plan.grid.count());
  TiledDraw::Memory memory;
  TiledDraw::Canvas canvas(1);  // one that is added to the mask in the end
  rasterizer::TileMask tile_mask;
  TaskCosts costs{kNever, {}, {}, std::vector<double>(tiles, kNever)};
  std::vector<double> clear(tiles, kNever);
  for (std::size_t i = 0; i < repetitions; ++i) {
    time_into(costs.plan, [&] { static_cast<void>(make_plan(triangles, mask.target(), plan.threads)); });
    mask.clear();
    TiledDraw drawing(fast, triangles, plan, mask, memory);
    costs.bins.resize(drawing.binned() ? drawing.chunks() : 0, kNever);
    costs.parts.resize(tiles, std::vector<double>(plan.parts.count(), kNever));
    for (std::size_t chunk = 0; chunk < costs.bins.size(); ++chunk) {
      time_into(costs.bins[chunk], [&] { drawing.bin(chunk); });
    }
    // Threads clear what they have last drawn into when the draw is over.
    tile_mask.clear();
    canvas.clear();
    for (std::size_t t = 0; t < tiles; ++t) {
      const int tile = static_cast<int>(t);
      time_into(clear[t], [&] { tile_mask.begin(plan.grid.tile(tile)); });
      for (std::size_t part = 0; part < plan.parts.count(); ++part) {
        time_into(costs.parts[t][part], [&] { drawing.draw({tile, part}, canvas); });
      }
      time_into(costs.tiles[t], [&] { drawing.finish(canvas); });
    }
  }
  for (std::size_t t = 0; t < tiles; ++t) {
    // The first part's time has it, and every thread that joins will need it.
    costs.parts[t].front() = std::max(costs.parts[t].front() - clear[t], 0.0);
    costs.tiles[t] += clear[t];
  }
  return costs;
}

tl::expected<void, Error> measure_workload(std::string_view name, const Scene& scene, std::size_t repetitions,
                                           std::vector<ScalingPoint>& points) {
  const auto triangles = snap_all<rasterizer::Format16_8>(scene);
  if (!triangles) return tl::unexpected(triangles.error());
  const rasterizer::FastRasterizer fast;
  const rasterizer::Target target = target_of(scene.setting);
  StripMask mask(target);
  double one_thread = kNever;
  for (std::size_t i = 0; i < repetitions; ++i) {
    mask.clear();
    // The time of the thread, as what else runs would take its share of whole draws more than of short tasks.
    time_into(
        one_thread, [&] { fast.cover_union(*triangles, mask); }, CLOCK_THREAD_CPUTIME_ID);
  }
  const auto processors = static_cast<int>(std::thread::hardware_concurrency());
  for (int threads = 1; threads <= kMostThreads; threads *= 2) {
    const Plan plan = make_plan(*triangles, target, threads);
    ScalingPoint& point = points.emplace_back();
    point.workload = name;
    point.triangles = triangles->size();
    point.threads = threads;
    point.used = plan.threads;
    point.tile_columns = plan.grid.columns();
    point.tile_rows = plan.grid.rows();
    point.chunks = (triangles->size() + plan.chunk - 1) / plan.chunk;
    point.one_thread_ns = one_thread;
    if (plan.threads == 1) {
      point.tasks_ns = point.predicted_ns = one_thread;
      point.predicted_speedup = point.predicted_asleep = 1;
    } else {
      const TaskCosts costs = time_tasks(fast, *triangles, plan, repetitions, mask);
      const Schedule schedule = play(costs, plan, rasterizer::start_awake);
      point.tasks_ns = schedule.tasks;
      point.predicted_ns = costs.plan + schedule.end;
      point.predicted_speedup = one_thread / point.predicted_ns;
      point.predicted_asleep = one_thread / (costs.plan + play(costs, plan, rasterizer::start_asleep).end);
    }
    if (threads == 1 || threads > processors) continue;
    point.measured = time_whole_draws(threads, fast, *triangles, target, repetitions);
  }
  return {};
}

}  // namespace

Schedule play(const TaskCosts& costs, const Plan& plan, double (*start)(int thread)) {
  rasterizer::Agenda agenda(plan.tile_work, plan.parts, plan.least_help);
  // A single tile is drawn in place by the first thread, and the masks of the others are added up by all in the end.
  const bool single = costs.parts.size() == 1;
  if (single) agenda.begin();
  struct Thread {
    double time;
    int tile;
    bool in_place;
    bool worked = false;
  };
  std::vector<Thread> threads;
  for (int i = 0; i < plan.threads; ++i) threads.push_back({start(i), single && i == 0 ? 0 : -1, single && i == 0});
  std::vector<double> binned_at(costs.bins.size());
  std::size_t next_bin = 0, apart = 0;
  Schedule schedule;
  const auto work = [&](Thread& thread, double cost) {
    thread.time += cost;
    thread.worked = true;
    schedule.tasks += cost;
  };
  const auto finish = [&](Thread& thread) {
    if (thread.tile < 0 || thread.in_place) return;
    if (single) {
      ++apart;
    } else {
      work(thread, costs.tiles[static_cast<std::size_t>(thread.tile)]);
    }
  };
  while (!threads.empty()) {
    // Who is free first acts first.
    const auto first = std::ranges::min_element(threads, {}, &Thread::time);
    Thread& thread = *first;
    if (next_bin < costs.bins.size()) {
      work(thread, costs.bins[next_bin]);
      binned_at[next_bin++] = thread.time;
      continue;
    }
    const auto part = agenda.next(thread.tile);
    const int tile = part ? part->tile : -1;
    if (tile != thread.tile) finish(thread);
    thread.tile = tile;
    if (part) {
      if (!binned_at.empty()) {
        for (std::size_t c = plan.parts.begin(part->number); c < plan.parts.begin(part->number + 1); ++c) {
          thread.time = std::max(thread.time, binned_at[c]);
        }
      }
      work(thread, costs.parts[static_cast<std::size_t>(tile)][part->number]);
    } else {
      // Who finds nothing left as it starts is waited for by nobody.
      if (thread.worked) schedule.end = std::max(schedule.end, thread.time);
      threads.erase(first);
    }
  }
  if (apart > 0) {
    const double added = static_cast<double>(apart) * costs.tiles.front();
    schedule.tasks += added;
    schedule.end += added / plan.threads;
  }
  return schedule;
}

std::vector<std::string_view> scaling_workloads() {
  std::vector<std::string_view> names;
  for (const Workload& workload : workloads()) names.push_back(workload.name);
  names.push_back(kWide);
  return names;
}

tl::expected<std::vector<ScalingPoint>, Error> measure_scaling(std::span<const std::string_view> names,
                                                               const ScalingEffort& effort, std::uint64_t seed) {
  constexpr std::size_t kWideTriangles = 200'000;
  const Progress progress(names.size(), "workloads");
  std::vector<ScalingPoint> points;
  for (std::size_t i = 0; i < names.size(); ++i) {
    progress.show(i, names[i]);
    const Workload* workload = find_workload(names[i]);
    const Scene scene =
        workload != nullptr
            ? make_workload(*workload, std::max<std::size_t>(workload->triangles / effort.divisor, 4), seed)
            : make_even({16'384, 16'384}, kWideTriangles / effort.divisor, 200, seed);
    if (auto measured = measure_workload(names[i], scene, effort.repetitions, points); !measured) {
      return tl::unexpected(measured.error());
    }
  }
  return points;
}

}  // namespace edgecase::conformance
