#include "conformance/bench/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "conformance/bench/growth.h"
#include "conformance/bench/plot.h"
#include "conformance/bench/progress.h"
#include "conformance/bench/scaling.h"
#include "conformance/scene/nearest_name.h"

namespace edgecase::conformance {
namespace {

tl::unexpected<Error> unknown(std::string_view kind, std::string_view name, std::span<const std::string_view> known) {
  std::string message = fmt::format("there is no {} \"{}\"", kind, name);
  if (const auto nearest = nearest_name(name, known)) message += fmt::format("; did you mean \"{}\"?", *nearest);
  return tl::unexpected(Error{ErrorKind::bad_input, message});
}

tl::expected<std::vector<const Workload*>, Error> chosen_workloads(const BenchOptions& options) {
  std::vector<const Workload*> chosen;
  std::vector<std::string_view> known;
  for (const Workload& workload : workloads()) {
    known.push_back(workload.name);
    if (options.workloads.empty()) chosen.push_back(&workload);
  }
  for (const std::string& name : options.workloads) {
    const Workload* workload = find_workload(name);
    if (workload == nullptr) return unknown("workload", name, known);
    if (std::ranges::find(chosen, workload) == chosen.end()) chosen.push_back(workload);
  }
  return chosen;
}

tl::expected<std::vector<std::string_view>, Error> chosen_scaling_workloads(const BenchOptions& options) {
  const std::vector<std::string_view> known = scaling_workloads();
  if (options.workloads.empty()) return known;
  std::vector<std::string_view> chosen;
  for (const std::string& name : options.workloads) {
    if (std::ranges::find(known, name) == known.end()) return unknown("workload", name, known);
    if (std::ranges::find(chosen, name) == chosen.end()) chosen.push_back(name);
  }
  return chosen;
}

tl::expected<std::vector<std::unique_ptr<Contender>>, Error> chosen_contenders(const BenchOptions& options) {
  auto built_in = built_in_contenders();
  if (options.subjects.empty()) return built_in;
  std::vector<std::unique_ptr<Contender>> chosen;
  chosen.push_back(std::move(built_in.front()));
  for (const std::string& name : options.subjects) {
    const auto named = [&](const auto& contender) { return contender && contender->name() == name; };
    if (std::ranges::any_of(chosen, named)) continue;
    if (const auto found = std::ranges::find_if(built_in, named); found != built_in.end()) {
      chosen.push_back(std::move(*found));
      continue;
    }
    auto subject = options.make_subject(name);
    if (!subject) return tl::unexpected(subject.error());
    chosen.push_back(make_subject_contender(std::move(*subject)));
  }
  return chosen;
}

int exit_status(ErrorKind kind) { return kind == ErrorKind::absent ? 3 : kind == ErrorKind::bad_input ? 2 : 1; }

tl::unexpected<Error> cannot_write(const std::string& path) {
  return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("cannot write {}: {}", path, std::strerror(errno))});
}

/// The whole text, or no file.
tl::expected<void, Error> write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (file) return {};
  auto error = cannot_write(path);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
  return error;
}

/// A path that cannot be written to is an error before anything is measured, not after.
tl::expected<void, Error> check_writable(const std::string& path) {
  if (path.empty() || path == "-") return {};
  std::error_code ignored;
  const bool existed = std::filesystem::exists(path, ignored);
  if (!std::ofstream(path, std::ios::binary | std::ios::app)) return cannot_write(path);
  if (!existed) std::filesystem::remove(path, ignored);
  return {};
}

tl::expected<void, Error> run(const BenchOptions& options) {
  for (const std::string& path : {options.json, options.plot}) {
    if (auto writable = check_writable(path); !writable) return writable;
  }
  const auto rows = bench(options);
  if (!rows) return tl::unexpected(rows.error());
  const bool json_to_output = options.json == "-";
  fmt::print("{}", json_to_output ? bench_json(*rows) : bench_table(*rows));
  if (!options.json.empty() && !json_to_output) {
    if (auto written = write_file(options.json, bench_json(*rows)); !written) return written;
  }
  if (!options.plot.empty()) return plot_bench(*rows, options.plot);
  return {};
}

/// Makes the folder and finds that `json` in it can be written to; the path of it.
tl::expected<std::string, Error> prepare_folder(const std::filesystem::path& folder, const char* json) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return tl::unexpected(
        Error{ErrorKind::bad_input, fmt::format("cannot make the folder {}: {}", folder.string(), error.message())});
  }
  std::string path = (folder / json).string();
  if (auto writable = check_writable(path); !writable) return tl::unexpected(writable.error());
  return path;
}

tl::expected<void, Error> run_scaling(const BenchOptions& options) {
  const auto chosen = chosen_scaling_workloads(options);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto json = prepare_folder(options.scaling, "scaling.json");
  if (!json) return tl::unexpected(json.error());
  const auto points = measure_scaling(*chosen, options.quick ? kQuickScaling : kThoroughScaling, options.seed);
  if (!points) return tl::unexpected(points.error());
  fmt::print("{}", scaling_table(*points));
  if (auto written = write_file(*json, scaling_json(*points)); !written) return written;
  const std::string picture = (std::filesystem::path(options.scaling) / "scaling.png").string();
  return run_gnuplot(scaling_plot_program(*points, picture), picture);
}

tl::expected<void, Error> run_growth(const BenchOptions& options) {
  const std::filesystem::path folder = options.growth;
  const auto json = prepare_folder(folder, "growth.json");
  if (!json) return tl::unexpected(json.error());
  const auto points =
      measure_growth(options.quick ? kQuickGrowth : kThoroughGrowth, options.seed, options.make_subject);
  if (!points) return tl::unexpected(points.error());
  fmt::print("{}", growth_table(*points));
  if (auto written = write_file(*json, growth_json(*points)); !written) return written;
  for (const GrowthAxis& axis : growth_axes()) {
    const std::string path = (folder / fmt::format("growth-{}.png", axis.name)).string();
    if (auto drawn = run_gnuplot(growth_plot_program(axis, *points, path), path); !drawn) return drawn;
  }
  return {};
}

}  // namespace

tl::expected<std::vector<BenchRow>, Error> bench(const BenchOptions& options) {
  const auto chosen = chosen_workloads(options);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto contenders = chosen_contenders(options);
  if (!contenders) return tl::unexpected(contenders.error());
  Effort effort = options.quick ? kQuick : kThorough;
  if (options.instructions) effort.steps = kManySteps;
  const Progress progress(chosen->size(), "workloads");
  std::vector<BenchRow> rows;
  for (std::size_t i = 0; i < chosen->size(); ++i) {
    progress.show(i, (*chosen)[i]->name);
    const auto measured = measure(*(*chosen)[i], *contenders, effort, options.seed);
    if (!measured) return tl::unexpected(measured.error());
    rows.insert(rows.end(), measured->begin(), measured->end());
  }
  return rows;
}

int bench_command(const BenchOptions& options) {
  const auto done = !options.scaling.empty()  ? run_scaling(options)
                    : !options.growth.empty() ? run_growth(options)
                                              : run(options);
  if (!done) {
    fmt::print(stderr, "edgecase: {}\n", done.error().message);
    return exit_status(done.error().kind);
  }
  return 0;
}

}  // namespace edgecase::conformance
