#include <CLI/CLI.hpp>
#include <cstdio>
#include <thread>

#include "conformance/bench/bench.h"
#include "conformance/runner/commands.h"
#include "conformance/subjects/registry.h"

namespace {

using namespace edgecase::conformance;

const char* const kFooter =
    "Exit status: 0 all as expected; 1 a mismatch, or a known deviation that is no longer there;\n"
    "2 bad input or usage; 3 a named subject is not there.";

void add_run(CLI::App& app, RunOptions& options) {
  CLI::App* run = app.add_subcommand("run", "Compare subjects with the rules on cases and generators");
  run->add_option("CASE", options.cases, "Case: a name, a pattern of names such as 'ties/*', or a file");
  run->add_option("--subject", options.subjects, "Rasterizer under test; may be repeated")->type_name("S")->take_all();
  run->add_option("--generator", options.generators, "Generator of triangles; may be repeated")
      ->type_name("G")
      ->take_all();
  run->add_option("--count", options.count, "Triangles of each generator, at least; scenes are whole")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000'000}))
      ->capture_default_str();
  run->add_option("--seed", options.seed, "Seed of the generators")->type_name("N")->capture_default_str();
  run->add_option("--json", options.json, "Write the results as JSON")->type_name("FILE");
  run->add_option("--junit", options.junit, "Write the results as JUnit XML")->type_name("FILE");
  run->add_option("--report", options.report, "Folder for pictures, reproductions and index.html")->type_name("DIR");
  run->add_option("--jobs", options.jobs, "Threads")->type_name("N")->check(CLI::Range(1, 1024))->capture_default_str();
}

void add_show(CLI::App& app, ShowOptions& options) {
  CLI::App* show = app.add_subcommand("show", "Show what a case covers, by the rules or as a subject draws it");
  show->add_option("CASE", options.case_name, "Case: a name or a file")->required();
  show->add_option("--subject", options.subject, "Show this rasterizer's masks beside the rules")->type_name("S");
  show->add_option("--png", options.png, "Write a picture")->type_name("FILE");
}

void add_bench(CLI::App& app, BenchOptions& options) {
  CLI::App* bench = app.add_subcommand("bench", "Measure rasterizers: speed, and error beside it");
  bench->add_option("--workload", options.workloads, "Set of triangles; may be repeated")->type_name("W")->take_all();
  bench->add_option("--subject", options.subjects, "Rasterizer to measure beside the plain loop; may be repeated")
      ->type_name("S")
      ->take_all();
  bench->add_flag("--quick", options.quick, "Fewer triangles and repetitions: less than a minute in all");
  bench->add_option("--seed", options.seed, "Seed of the workloads")->type_name("N")->capture_default_str();
  bench->add_option("--json", options.json, "Write the rows as JSON; - for standard output")->type_name("FILE");
  bench->add_option("--plot", options.plot, "Draw error over time as PNG")->type_name("FILE");
  bench
      ->add_option(
          "--growth", options.growth,
          "Instead, measure time against the number, area, range and samples of triangles and the target's size, "
          "into this folder")
      ->type_name("DIR")
      ->excludes("--workload")
      ->excludes("--subject")
      ->excludes("--json")
      ->excludes("--plot");
}

int dispatch(int argc, char** argv) {
  CLI::App app("Checks that rasterizers cover exactly the samples that the rules say.", "edgecase");
  app.set_version_flag("--version", std::string("edgecase ") + EDGECASE_VERSION);
  app.require_subcommand(1);
  app.footer(kFooter);

  std::string list_what;
  CLI::App* list = app.add_subcommand("list", "Name the cases, subjects and generators there are");
  list->add_option("WHAT", list_what, "cases, subjects or generators; all of them without")
      ->check(CLI::IsMember({"cases", "subjects", "generators"}));
  RunOptions run_options;
  run_options.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  add_run(app, run_options);
  ShowOptions show_options;
  add_show(app, show_options);

  BenchOptions bench_options;
  bench_options.make_subject = make_subject;
  add_bench(app, bench_options);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kAsExpected : kBadInput;
  }

  const std::filesystem::path source = EDGECASE_SOURCE_DIR;
  const DataFiles data{source / "cases", source / "conformance" / "known_deviations.json"};
  if (*list) return list_command(data, list_what);
  if (app.got_subcommand("bench")) return bench_command(bench_options);
  if (app.got_subcommand("show")) return show_command(data, show_options);
  return run_command(data, run_options);
}

}  // namespace

int main(int argc, char** argv) { return dispatch(argc, argv); }
