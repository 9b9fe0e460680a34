#include "conformance/runner/run.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <thread>

#include "conformance/runner/metamorphic_trial.h"
#include "conformance/runner/snap_probe.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

// Our own rasterizer is judged by the oracle, on every triangle; it stands in for the oracle against everybody else.
bool is_ours(const std::string& subject) { return subject == "edgecase" || subject.starts_with("edgecase:"); }

// Ours snap as the scene asks or as they claim, and a model that replaces the rules needs none; drivers are found out.
tl::expected<Rules, Error> rules_of(Subject& subject, const KnownDeviation* deviation) {
  if (subject.info().device.empty() || (deviation != nullptr && deviation->replaces_rules())) {
    return subject.info().rules;
  }
  return find_snap(subject);
}

// What one thread holds to test one subject. Subjects are not shared between threads.
struct Bench {
  std::unique_ptr<Subject> subject;
  Rules rules;  ///< what the subject is judged by
  Reference reference;
  Judge judge;

  Bench(std::unique_ptr<Subject> s, const Rules& snap, Reference r, const KnownDeviation* deviation)
      : subject(std::move(s)), rules(snap), reference(std::move(r)), judge(*subject, reference, deviation) {}
};

class Benches {
 public:
  explicit Benches(const RunPlan& plan) : plan_(plan) {}

  tl::expected<Bench*, Error> get(const std::string& name) {
    auto& bench = benches_[name];
    if (!bench) {
      auto subject = make_subject(name);
      if (!subject) return tl::unexpected(subject.error());
      auto reference = reference_for(name, (*subject)->info().device);
      if (!reference) return tl::unexpected(reference.error());
      const KnownDeviation* deviation = find_known_deviation(plan_.known_deviations, name, (*subject)->info().device);
      auto rules = rules_of(**subject, deviation);
      if (!rules) return tl::unexpected(rules.error());
      bench = std::make_unique<Bench>(std::move(*subject), *rules, std::move(*reference), deviation);
    }
    return bench.get();
  }

 private:
  const RunPlan& plan_;
  std::map<std::string, std::unique_ptr<Bench>> benches_;
};

void run_one(const RunPlan& plan, Benches& benches, RunResult& result,
             const std::function<void(std::uint64_t)>& on_progress) {
  const auto bench = benches.get(result.subject);
  if (!bench) {
    result.trial.failure = bench.error();
    return;
  }
  Subject& subject = *(*bench)->subject;
  result.device = subject.info().device;
  result.snap = describe_snap((*bench)->rules);
  if (result.testcase.file != nullptr) {
    result.trial = try_case(*result.testcase.file, subject, (*bench)->rules, (*bench)->judge);
    on_progress(triangle_count(result.testcase.file->scene));
  } else if (result.testcase.metamorphosis != nullptr) {
    result.trial = try_metamorphosis(*result.testcase.metamorphosis, subject, (*bench)->rules,
                                     find_known_deviation(plan.known_deviations, result.subject, result.device),
                                     {plan.count, plan.seed, on_progress});
  } else {
    result.trial = try_generator(*result.testcase.generator, subject, (*bench)->rules, (*bench)->judge,
                                 {plan.count, plan.seed, on_progress});
  }
}

}  // namespace

const std::vector<std::string>& default_subjects() {
  static const std::vector<std::string> names{"edgecase", "lavapipe", "osmesa-llvmpipe", "osmesa-softpipe"};
  return names;
}

tl::expected<Reference, Error> reference_for(const std::string& subject, const std::string& device) {
  if (is_ours(subject)) return Reference(nullptr);
  auto fast = make_subject("edgecase");
  if (!fast) return tl::unexpected(fast.error());
  return Reference(std::move(*fast), find_transform_model(subject, device));
}

std::uint64_t planned_triangles(const RunPlan& plan) {
  std::uint64_t triangles = 0;
  for (const Testcase& testcase : plan.testcases) triangles += testcase.triangles(plan.count);
  return triangles * plan.subjects.size();
}

tl::expected<std::vector<RunResult>, Error> run(const RunPlan& plan,
                                                const std::function<void(std::uint64_t)>& on_progress) {
  // The first thread's subjects are made at once: one that cannot be had ends the run before it begins.
  Benches first(plan);
  for (const std::string& subject : plan.subjects) {
    if (auto bench = first.get(subject); !bench) return tl::unexpected(bench.error());
  }

  std::vector<RunResult> results;
  for (const std::string& subject : plan.subjects) {
    for (const Testcase& testcase : plan.testcases) results.push_back({subject, {}, {}, testcase, {}});
  }

  std::mutex progress_mutex;
  const auto guarded_progress = [&](std::uint64_t triangles) {
    const std::lock_guard lock(progress_mutex);
    on_progress(triangles);
  };
  std::atomic<std::size_t> next = 0;
  const auto work = [&](Benches& benches) {
    for (std::size_t i = next++; i < results.size(); i = next++) run_one(plan, benches, results[i], guarded_progress);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < plan.jobs; ++i) {
    helpers.emplace_back([&] {
      Benches benches(plan);
      work(benches);
    });
  }
  work(first);
  helpers.clear();  // joins
  return results;
}

}  // namespace edgecase::conformance
