#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "conformance/compare/atomic_file.h"
#include "conformance/runner/commands.h"
#include "conformance/runner/exhaust.h"
#include "conformance/runner/exhaust_report.h"
#include "conformance/runner/exhaust_state.h"
#include "conformance/runner/findings.h"
#include "conformance/runner/progress.h"

namespace edgecase::conformance {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr auto kBetweenStates = std::chrono::seconds(1);

double rate(const Exhaustion& found) {
  return found.seconds > 0 ? static_cast<double>(found.triangles) / found.seconds : 0;
}

std::string vertices(const Triangle& t) {
  return fmt::format("({}, {}) ({}, {}) ({}, {})", t[0].x, t[0].y, t[1].x, t[1].y, t[2].x, t[2].y);
}

std::string to_json(const ExhaustPlan& plan, const std::string& device, const Exhaustion& found) {
  Json json{{"edgecase", EDGECASE_VERSION},
            {"subject", plan.subject},
            {"device", device},
            {"lattice_bits", plan.lattice_bits},
            {"target", {plan.target.width, plan.target.height}},
            {"triangles", found.triangles},
            {"samples_compared", found.samples_compared},
            {"wrong", found.wrong},
            {"missing", found.missing},
            {"unexpected", found.wrong - found.missing},
            {"unexplained_triangles", found.unexplained},
            {"first", nullptr},
            {"seconds", found.seconds},
            {"triangles_per_second", rate(found)}};
  if (found.first) {
    Json triangle = Json::array();
    for (const Position& p : exhaust_triangle(plan, found.first->triangle)) triangle.push_back({p.x, p.y});
    json["first"] = {{"kind", found.first->missing ? "missing" : "unexpected"},
                     {"triangle", found.first->triangle},
                     {"x", found.first->x},
                     {"y", found.first->y},
                     {"vertices", triangle}};
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const ExhaustPlan& plan, const Exhaustion& found) {
  std::string text = fmt::format(
      "{}: {} triangles, all there are on {} bits over {}x{} pixels; {} samples compared, {} wrong\n", plan.subject,
      found.triangles, plan.lattice_bits, plan.target.width, plan.target.height, found.samples_compared, found.wrong);
  if (found.first) {
    text += fmt::format("first: {} pixel ({}, {}) of triangle {}: {}\n",
                        found.first->missing ? "missing" : "unexpected", found.first->x, found.first->y,
                        found.first->triangle, vertices(exhaust_triangle(plan, found.first->triangle)));
  }
  if (plan.deviation != nullptr && plan.deviation->replaces_rules()) {
    text += found.unexplained == 0
                ? fmt::format("every mask is as predicted: {}\n", plan.deviation->cause)
                : fmt::format("{} triangles are not what the known deviation's model predicts\n", found.unexplained);
  }
  return text + fmt::format("{:.1f} s, {:.0f} triangles/s\n", found.seconds, rate(found));
}

tl::expected<Exhaustion, Error> run(const ExhaustPlan& plan, std::unique_ptr<Subject> subject,
                                    const std::string& state) {
  const std::string device = subject->info().device;
  Exhaustion start;
  if (!state.empty()) {
    auto loaded = load_exhaust_state(state, plan, device);
    if (!loaded) return loaded;
    start = std::move(*loaded);
    // A state that cannot be written is found out before an hour of drawing, not after.
    if (auto written = write_file_atomically(state, exhaust_state(plan, device, start)); !written) {
      return tl::unexpected(written.error());
    }
  }
  Progress progress(exhaust_triangles(plan) - start.triangles);
  std::uint64_t shown = start.triangles;
  auto saved = std::chrono::steady_clock::now();
  tl::expected<void, Error> written;
  auto found = exhaust(plan, std::move(subject), start, [&](const Exhaustion& done) {
    progress.add(done.triangles - std::exchange(shown, done.triangles));
    const auto now = std::chrono::steady_clock::now();
    if (state.empty() || !written || now - saved < kBetweenStates) return;
    saved = now;
    written = write_file_atomically(state, exhaust_state(plan, device, done));
  });
  if (found && !state.empty()) written = write_file_atomically(state, exhaust_state(plan, device, *found));
  if (!written) return tl::unexpected(written.error());
  return found;
}

}  // namespace

int exhaust_command(const DataFiles& data, const ExhaustOptions& options) {
  const auto known = load_known_deviations(data.known_deviations);
  if (!known) return fail(known.error());
  ExhaustPlan plan{options.lattice_bits, options.target, options.subject, nullptr, options.jobs};
  auto subject = make_subject(options.subject);
  if (!subject) return fail(subject.error());
  const std::string device = (*subject)->info().device;
  plan.deviation = find_known_deviation(*known, options.subject, device);
  if (const auto error = check_exhaust(plan, **subject)) return fail(*error);
  if (const auto error = unwritable(options.report)) return fail(*error);
  const auto found = run(plan, std::move(*subject), options.state);
  if (!found) return fail(found.error());
  if (!options.report.empty()) {
    if (auto written = write_exhaust_report(options.report, plan, device, *found); !written) {
      return fail(written.error());
    }
  }
  if (!options.json.empty()) {
    if (auto written = write_file_atomically(options.json, to_json(plan, device, *found)); !written) {
      return fail(written.error());
    }
  }
  fmt::print("{}", to_text(plan, *found));
  if (!options.report.empty()) fmt::print("Report: {}\n", (fs::path(options.report) / "index.html").string());
  if (std::fflush(stdout) != 0) return fail({ErrorKind::bad_input, "standard output: no space left or closed"});
  return found->unexplained == 0 ? kAsExpected : kMismatch;
}

}  // namespace edgecase::conformance
