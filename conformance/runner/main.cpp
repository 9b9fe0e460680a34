#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <thread>

#include "conformance/bench/bench.h"
#include "conformance/runner/commands.h"
#include "conformance/scene/rule_set.h"
#include "conformance/subjects/registry.h"

namespace {

using namespace edgecase::conformance;

const char* const kFooter =
    "Exit status: 0 all as expected; 1 a mismatch, or a known deviation that is no longer there;\n"
    "2 bad input or usage; 3 a named subject is not there.";

std::vector<std::string> rule_set_names() {
  std::vector<std::string> names;
  for (const RuleSet& set : kRuleSets) names.emplace_back(set.name);
  return names;
}

void add_run(CLI::App& app, RunOptions& options) {
  CLI::App* run = app.add_subcommand("run", "Compare subjects with the rules on cases and generators");
  run->add_option("CASE", options.cases, "Case: a name, a pattern of names such as 'ties/*', or a file");
  run->add_option("--subject", options.subjects, "Rasterizer under test; may be repeated")
      ->type_name("S")
      ->allow_extra_args(false);
  run->add_option("--generator", options.generators, "Generator or metamorphic check; may be repeated")
      ->type_name("G")
      ->allow_extra_args(false);
  run->add_option("--category", options.categories, "Only what is of this category; may be repeated")
      ->type_name("C")
      ->allow_extra_args(false);
  run->add_option("--rules", options.rules, "Judge by what that specification says, and leave open what it does")
      ->type_name("SET")
      ->check(CLI::IsMember(rule_set_names()))
      ->capture_default_str();
  run->add_option("--count", options.count, "Triangles of each generator, at least; scenes are whole")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000'000}))
      ->capture_default_str();
  run->add_option("--seed", options.seed, "Seed of the generators")->type_name("N")->capture_default_str();
  run->add_option("--json", options.json, "Write the results as JSON")->type_name("FILE");
  run->add_option("--junit", options.junit, "Write the results as JUnit XML")->type_name("FILE");
  run->add_option("--report", options.report,
                  "Folder for pictures, reproductions and index.html; edgecase-report if there are any")
      ->type_name("DIR");
  run->add_option("--jobs", options.jobs, "Threads")->type_name("N")->check(CLI::Range(1, 1024))->capture_default_str();
}

// "4x4": nothing but two whole numbers from 1 to 64 is a target small enough.
std::string parse_target(const std::string& text, Extent& target) {
  int end = -1;
  const bool parsed = std::sscanf(text.c_str(), "%4dx%4d%n", &target.width, &target.height, &end) == 2;
  if (parsed && static_cast<std::size_t>(end) == text.size() && std::min(target.width, target.height) >= 1 &&
      std::max(target.width, target.height) <= 64) {
    return {};
  }
  return "\"" + text + "\" is no WIDTHxHEIGHT, each from 1 to 64 pixels";
}

void add_exhaust(CLI::App& app, ExhaustOptions& options) {
  CLI::App* exhaust =
      app.add_subcommand("exhaust", "Compare one subject with the oracle on every triangle of a lattice");
  exhaust->add_option("--lattice-bits", options.lattice_bits, "The lattice has 2^B steps a pixel")
      ->type_name("B")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  exhaust
      ->add_option_function<std::string>(
          "--target",
          [&options](const std::string& text) {
            if (const std::string error = parse_target(text, options.target); !error.empty()) {
              throw CLI::ValidationError("--target", error);
            }
          },
          "Pixels; their corners belong to the lattice [4x4]")
      ->type_name("WxH");
  exhaust->add_option("--subject", options.subject, "Rasterizer under test")->type_name("S")->capture_default_str();
  exhaust->add_option("--json", options.json, "Write the result as JSON")->type_name("FILE");
  exhaust->add_option("--report", options.report, "Folder for a picture and a reproduction of what is wrong first")
      ->type_name("DIR");
  exhaust->add_option("--state", options.state, "Keep there how far it has come, and go on from there")
      ->type_name("FILE");
  exhaust->add_option("--jobs", options.jobs, "Threads")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

void add_limits(CLI::App& app, LimitsOptions& options) {
  CLI::App* limits = app.add_subcommand("limits", "Find by bisection how far from the target subjects stay exact");
  limits->add_option("--subject", options.subjects, "Rasterizer under test; may be repeated")
      ->type_name("S")
      ->allow_extra_args(false);
  limits->add_option("--seed", options.seed, "Seed of the triangles")->type_name("N")->capture_default_str();
}

void add_stability(CLI::App& app, StabilityOptions& options) {
  CLI::App* stability = app.add_subcommand("stability", "Measure what inexact arithmetics cost on hard cases");
  stability->add_option("--count", options.count, "Triangles of each family, at least")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}))
      ->capture_default_str();
  stability->add_option("--seed", options.seed, "Seed of the triangles")->type_name("N")->capture_default_str();
  stability->add_option("--json", options.json, "Write the table as JSON")->type_name("FILE");
  stability->add_option("--plot", options.plot, "Draw the table as PNG")->type_name("FILE");
}

void add_show(CLI::App& app, ShowOptions& options) {
  CLI::App* show = app.add_subcommand("show", "Show what a case covers, by the rules or as a subject draws it");
  show->add_option("CASE", options.case_name, "Case: a name or a file")->required();
  show->add_option("--subject", options.subject, "Show this rasterizer's masks beside the rules")->type_name("S");
  show->add_option("--rules", options.rules, "Show what that specification demands, and leaves open")
      ->type_name("SET")
      ->check(CLI::IsMember(rule_set_names()));
  show->add_option("--png", options.png, "Write a picture")->type_name("FILE");
}

void add_bench(CLI::App& app, BenchOptions& options) {
  CLI::App* bench = app.add_subcommand("bench", "Measure rasterizers: speed, and error beside it");
  bench->add_option("--workload", options.workloads, "Set of triangles; may be repeated")
      ->type_name("W")
      ->allow_extra_args(false);
  bench->add_option("--subject", options.subjects, "Rasterizer to measure beside the plain loop; may be repeated")
      ->type_name("S")
      ->allow_extra_args(false);
  bench->add_flag("--quick", options.quick, "Fewer triangles and repetitions: less than a minute in all");
  bench->add_flag("--instructions", options.instructions,
                  "Count instructions one by one if the machine has no counter: some seconds a row");
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
  bench
      ->add_option(
          "--scaling", options.scaling,
          "Instead, model and measure the speed of 1 to 64 threads, into this folder; wide200 is one more workload")
      ->type_name("DIR")
      ->excludes("--growth")
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
  CLI::App* list = app.add_subcommand("list", "Name the cases, subjects, generators and categories there are");
  list->add_option("WHAT", list_what, "cases, subjects, generators or categories; all of them without")
      ->check(CLI::IsMember({"cases", "subjects", "generators", "categories"}));
  RunOptions run_options;
  run_options.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  add_run(app, run_options);
  ExhaustOptions exhaust_options;
  exhaust_options.jobs = run_options.jobs;
  add_exhaust(app, exhaust_options);
  LimitsOptions limits_options;
  add_limits(app, limits_options);
  StabilityOptions stability_options;
  add_stability(app, stability_options);
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
  if (app.got_subcommand("exhaust")) return exhaust_command(data, exhaust_options);
  if (app.got_subcommand("limits")) return limits_command(data, limits_options);
  if (app.got_subcommand("stability")) return stability_command(stability_options);
  if (app.got_subcommand("show")) return show_command(data, show_options);
  return run_command(data, run_options);
}

}  // namespace

int main(int argc, char** argv) { return dispatch(argc, argv); }
