#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "conformance/compare/atomic_file.h"
#include "conformance/generators/generator.h"
#include "conformance/metamorphic/metamorphosis.h"
#include "conformance/report/report.h"
#include "conformance/runner/case_library.h"
#include "conformance/runner/categories.h"
#include "conformance/runner/commands.h"
#include "conformance/runner/findings.h"
#include "conformance/runner/progress.h"
#include "conformance/runner/run.h"
#include "conformance/scene/nearest_name.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

// Where pictures go if the user names no folder and there is something to show.
constexpr const char* kDefaultReport = "edgecase-report";

tl::unexpected<Error> no_such(const char* kind, const std::string& name, const std::vector<std::string_view>& all,
                              const char* listed) {
  const auto nearest = nearest_name(name, all);
  return tl::unexpected(
      Error{ErrorKind::bad_input, fmt::format("no {} is called \"{}\"{}", kind, name,
                                              nearest ? fmt::format("; did you mean \"{}\"?", *nearest)
                                                      : fmt::format("; `edgecase list {}` names them all", listed))});
}

// Generators and metamorphic checks.
tl::expected<std::vector<Testcase>, Error> chosen_generators(const std::vector<std::string>& names, bool everything) {
  std::vector<Testcase> all;
  for (const Generator& generator : generators()) all.push_back({nullptr, &generator, nullptr});
  for (const Generator& generator : clip_generators()) all.push_back({nullptr, &generator, nullptr});
  for (const Metamorphosis& check : metamorphoses()) all.push_back({nullptr, nullptr, &check});
  if (everything) return all;
  std::vector<Testcase> chosen;
  std::vector<std::string> names_of_all;
  for (const Testcase& testcase : all) names_of_all.push_back(testcase.name());
  const std::vector<std::string_view> known(names_of_all.begin(), names_of_all.end());
  for (const std::string& name : names) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end()) return no_such("generator", name, known, "generators");
    const auto is_there = [&](const Testcase& testcase) { return testcase.name() == name; };
    if (std::ranges::none_of(chosen, is_there)) chosen.push_back(all[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

tl::expected<void, Error> keep_categories(const DataFiles& data, const std::vector<std::string>& names,
                                          std::vector<Testcase>& testcases) {
  if (names.empty()) return {};
  const auto categories = load_categories(data.cases);
  if (!categories) return tl::unexpected(categories.error());
  std::vector<std::string_view> known;
  for (const Category& category : *categories) known.push_back(category.name);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) == known.end()) return no_such("category", name, known, "categories");
  }
  std::erase_if(testcases, [&](const Testcase& t) { return std::ranges::find(names, t.category()) == names.end(); });
  if (!testcases.empty()) return {};
  return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("nothing of what is named is of category \"{}\"",
                                                                fmt::join(names, "\" or \""))});
}

struct Selection {
  std::vector<Case> cases;
  RunPlan plan;  ///< its testcases point into `cases`
};

tl::expected<void, Error> select(const DataFiles& data, const RunOptions& options, Selection& selection) {
  const bool everything = options.cases.empty() && options.generators.empty();
  if (everything || !options.cases.empty()) {
    auto cases = everything ? load_all_cases(data.cases) : load_cases(data.cases, options.cases);
    if (!cases) return tl::unexpected(cases.error());
    selection.cases = std::move(*cases);
  }
  const auto chosen = chosen_generators(options.generators, everything);
  if (!chosen) return tl::unexpected(chosen.error());
  auto known = load_known_deviations(data.known_deviations);
  if (!known) return tl::unexpected(known.error());

  RunPlan& plan = selection.plan;
  plan.known_deviations = std::move(*known);
  for (const std::string& subject : options.subjects.empty() ? default_subjects() : options.subjects) {
    if (std::ranges::find(plan.subjects, subject) == plan.subjects.end()) plan.subjects.push_back(subject);
  }
  for (const Case& c : selection.cases) plan.testcases.push_back({&c, nullptr, nullptr});
  plan.testcases.insert(plan.testcases.end(), chosen->begin(), chosen->end());
  if (auto kept = keep_categories(data, options.categories, plan.testcases); !kept) return kept;
  plan.rule_set = find_rule_set(options.rules);
  plan.count = options.count;
  plan.seed = options.seed;
  plan.jobs = options.jobs;
  return {};
}

tl::expected<void, Error> write_files(const RunOptions& options, const std::string& folder, const Report& report) {
  struct File {
    fs::path path;
    std::string (*render)(const Report&);
  };
  std::vector<File> files;
  if (!options.json.empty()) files.push_back({options.json, to_json});
  if (!options.junit.empty()) files.push_back({options.junit, to_junit});
  if (!folder.empty()) files.push_back({fs::path(folder) / "index.html", to_html});
  for (const File& file : files) {
    if (auto written = write_file_atomically(file.path, file.render(report)); !written) return written;
  }
  return {};
}

}  // namespace

int run_command(const DataFiles& data, const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (const auto error = unwritable(options.report)) return fail(*error);
  Selection selection;
  if (auto selected = select(data, options, selection); !selected) return fail(selected.error());
  const RunPlan& plan = selection.plan;

  tl::expected<std::vector<RunResult>, Error> runs;
  {
    Progress progress(planned_triangles(plan));
    runs = run(plan, [&](std::uint64_t triangles) { progress.add(triangles); });
  }
  if (!runs) return fail(runs.error());

  Report report;
  report.version = EDGECASE_VERSION;
  report.seed = plan.seed;
  report.rules = plan.rule_set->name;
  for (const RunResult& result : *runs) report.results.push_back(describe_result(result, plan));
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  std::string folder = options.report;
  const bool anything_to_show =
      std::ranges::any_of(*runs, [](const RunResult& result) { return !result.trial.outcome.findings.empty(); });
  if (folder.empty() && anything_to_show) {
    // Nobody asked for this folder: a working directory that cannot be written costs the pictures, not the run.
    if (const auto error = unwritable(kDefaultReport)) {
      fmt::print(stderr, "edgecase: no pictures written: {}\n", error->message);
    } else {
      folder = kDefaultReport;
    }
  }
  if (!folder.empty()) {
    if (auto shown = show_findings(folder, *runs, plan, report.results); !shown) return fail(shown.error());
  }
  if (auto written = write_files(options, folder, report); !written) return fail(written.error());

  fmt::print("{}", to_text(report, isatty(STDOUT_FILENO) == 1));
  if (anything_to_show && !folder.empty())
    fmt::print("Pictures and reproductions: {}\n", (fs::path(folder) / "index.html").string());
  if (std::fflush(stdout) != 0) return fail({ErrorKind::bad_input, "standard output: no space left or closed"});
  const bool failed =
      std::ranges::any_of(report.results, [](const Result& result) { return result.verdict == Verdict::fail; });
  return failed ? kMismatch : kAsExpected;
}

}  // namespace edgecase::conformance
