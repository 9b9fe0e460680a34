#include "conformance/runner/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <thread>

#include "conformance/runner/metamorphic_trial.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

// Our own rasterizer is judged by the oracle, on every triangle; it stands in for the oracle against everybody else.
bool is_ours(const std::string& subject) { return subject == "edgecase" || subject.starts_with("edgecase:"); }

// What one thread holds to test one subject. Subjects are not shared between threads.
struct Bench {
  std::unique_ptr<Subject> subject;
  Reference reference;
  Judge judge;

  Bench(std::unique_ptr<Subject> s, Reference r, const KnownDeviation* deviation)
      : subject(std::move(s)), reference(std::move(r)), judge(*subject, reference, deviation) {}
};

bool in_clip_space(const Testcase& testcase) {
  if (testcase.file != nullptr) return testcase.file->scene.clip.has_value();
  return testcase.generator != nullptr && testcase.generator->viewport.has_value();
}

using SubjectModels = std::map<std::string, SubjectModel>;

class Benches {
 public:
  Benches(const RunPlan& plan, const SubjectModels& models) : plan_(plan), models_(models) {}

  // Every subject has its model before the first call.
  tl::expected<Bench*, Error> get(const std::string& name) {
    auto& bench = benches_[name];
    if (bench) return bench.get();
    auto subject = make_subject(name);
    if (!subject) return tl::unexpected(subject.error());
    return add(name, std::move(*subject));
  }

  tl::expected<Bench*, Error> add(const std::string& name, std::unique_ptr<Subject> subject) {
    auto reference = reference_for(name, &models_.at(name));
    if (!reference) return tl::unexpected(reference.error());
    const std::string device = subject->info().device;
    auto& bench = benches_[name];
    bench = std::make_unique<Bench>(std::move(subject), std::move(*reference), excuse(plan_, name, device));
    return bench.get();
  }

 private:
  const RunPlan& plan_;
  const SubjectModels& models_;
  std::map<std::string, std::unique_ptr<Bench>> benches_;
};

void run_one(const RunPlan& plan, const SubjectModel& model, Benches& benches, RunResult& result,
             const std::function<void(std::uint64_t)>& on_progress) {
  const auto bench = benches.get(result.subject);
  if (!bench) {
    result.trial.failure = bench.error();
    return;
  }
  Subject& subject = *(*bench)->subject;
  result.device = subject.info().device;
  const RuleSet& rule_set = *plan.rule_set;
  const Rules open{rule_set.subpixel_bits(subject.info().rules.subpixel_bits)};
  const auto rules = [&](int samples) { return rule_set.exact() ? model.rules(samples) : open; };
  result.snap = rule_set.exact() ? model.description()
                                 : fmt::format("{} subpixel bits, as {} allows", open.subpixel_bits, rule_set.name);
  const Testcase& testcase = result.testcase;
  if (testcase.file != nullptr) {
    const Scene& scene = testcase.file->scene;
    result.trial = try_case(*testcase.file, subject, rules(scene.setting.samples()), rule_set, (*bench)->judge);
    on_progress(triangle_count(scene));
  } else if (testcase.metamorphosis != nullptr && rule_set.on_edge != OnEdge::top_left) {
    result.trial.skipped = fmt::format("{} does not say that samples on edges are covered alike", rule_set.name);
    on_progress(testcase.triangles(plan.count));
  } else if (testcase.metamorphosis != nullptr) {
    result.trial = try_metamorphosis(*testcase.metamorphosis, subject, rules(1),
                                     excuse(plan, result.subject, result.device), {plan.count, plan.seed, on_progress});
  } else {
    result.trial = try_generator(*testcase.generator, subject, rules(testcase.generator->setting.samples()), rule_set,
                                 (*bench)->judge, {plan.count, plan.seed, on_progress});
  }
}

}  // namespace

const KnownDeviation* excuse(const RunPlan& plan, const std::string& subject, const std::string& device) {
  return plan.rule_set->exact() ? find_known_deviation(plan.known_deviations, subject, device) : nullptr;
}

const std::vector<std::string>& default_subjects() {
  static const std::vector<std::string> names{"edgecase", "lavapipe", "osmesa-llvmpipe", "osmesa-softpipe"};
  return names;
}

tl::expected<Reference, Error> reference_for(const std::string& subject, const SubjectModel* model) {
  if (is_ours(subject)) return Reference(nullptr);
  auto fast = make_subject("edgecase");
  if (!fast) return tl::unexpected(fast.error());
  if (model == nullptr) return Reference(std::move(*fast));
  const TransformModel* clipper = model->clipper();
  return Reference(std::move(*fast), clipper != nullptr ? std::optional(*clipper) : std::nullopt, model->unjudged());
}

std::uint64_t planned_triangles(const RunPlan& plan) {
  std::uint64_t triangles = 0;
  for (const Testcase& testcase : plan.testcases) triangles += testcase.triangles(plan.count);
  return triangles * plan.subjects.size();
}

tl::expected<std::vector<RunResult>, Error> run(const RunPlan& plan,
                                                const std::function<void(std::uint64_t)>& on_progress) {
  // The first thread's subjects are made, and found out, at once: one that cannot be had ends the run before it begins.
  SubjectModels models;
  Benches first(plan, models);
  const bool clip_space = std::ranges::any_of(plan.testcases, in_clip_space);
  for (const std::string& name : plan.subjects) {
    auto subject = make_subject(name);
    if (!subject) return tl::unexpected(subject.error());
    const KnownDeviation* deviation = find_known_deviation(plan.known_deviations, name, (*subject)->info().device);
    const bool predicted = !plan.rule_set->exact() || (deviation != nullptr && deviation->replaces_rules());
    auto model = predicted ? SubjectModel::declared(**subject) : SubjectModel::find(**subject, clip_space);
    if (!model) return tl::unexpected(model.error());
    models.emplace(name, std::move(*model));
    if (auto bench = first.add(name, std::move(*subject)); !bench) return tl::unexpected(bench.error());
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
    for (std::size_t i = next++; i < results.size(); i = next++) {
      run_one(plan, models.at(results[i].subject), benches, results[i], guarded_progress);
    }
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < plan.jobs; ++i) {
    helpers.emplace_back([&] {
      Benches benches(plan, models);
      work(benches);
    });
  }
  work(first);
  helpers.clear();  // joins
  return results;
}

}  // namespace edgecase::conformance
