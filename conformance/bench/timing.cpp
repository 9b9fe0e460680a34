#include "conformance/bench/timing.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <string>
#include <utility>

namespace edgecase::conformance {
namespace {

/// Keeps what Google Benchmark measured instead of printing it.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const auto index = static_cast<std::size_t>(std::stoul(run.run_name.function_name));
      if (run.error_occurred) {
        error = run.error_message;
      } else {
        real_seconds[index].push_back(run.real_accumulated_time / static_cast<double>(run.iterations));
        cpu_seconds[index].push_back(run.cpu_accumulated_time / static_cast<double>(run.iterations));
      }
    }
  }

  std::map<std::size_t, std::vector<double>> real_seconds, cpu_seconds;
  std::string error;
};

void initialize_google_benchmark() {
  static const bool once = [] {
    std::array<std::string, 2> arguments{"edgecase", "--benchmark_enable_random_interleaving=true"};
    std::array<char*, 3> pointers{arguments[0].data(), arguments[1].data(), nullptr};
    int count = 2;
    benchmark::Initialize(&count, pointers.data());
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace

Statistics statistics(std::vector<double> values) {
  std::ranges::sort(values);
  // Between the values, where the share falls between two of them.
  const auto quantile = [&](double share) {
    const double position = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (values[above] - values[below]) * (position - static_cast<double>(below));
  };
  const double median = quantile(0.5);
  return {median, (quantile(0.75) - quantile(0.25)) / median};
}

tl::expected<std::vector<Statistics>, Error> time_draws(const std::vector<std::unique_ptr<Contender>>& contenders,
                                                        const Repetitions& repetitions) {
  initialize_google_benchmark();
  benchmark::ClearRegisteredBenchmarks();
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    const auto run = [contender = contenders[i].get(), random = std::mt19937_64()](benchmark::State& state) mutable {
      for (auto _ : state) {
        state.PauseTiming();
        contender->clear();
        contender->shuffle(random);
        const double before = contender->driver_seconds();
        state.ResumeTiming();
        if (const auto drawn = contender->draw(); !drawn) {
          state.SkipWithError(drawn.error().message.c_str());
          break;
        }
        benchmark::ClobberMemory();
        if (contender->clock() == Clock::driver) state.SetIterationTime(contender->driver_seconds() - before);
      }
    };
    auto* const registered = benchmark::RegisterBenchmark(std::to_string(i).c_str(), run);
    registered->Repetitions(static_cast<int>(repetitions.count))->MinTime(repetitions.seconds_each);
    if (contenders[i]->clock() == Clock::wall) registered->UseRealTime();
    if (contenders[i]->clock() == Clock::driver) registered->UseManualTime();
  }
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector, "all");
  benchmark::ClearRegisteredBenchmarks();
  if (!collector.error.empty()) return tl::unexpected(Error{ErrorKind::subject, collector.error});
  std::vector<Statistics> seconds;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    seconds.push_back(
        statistics(contenders[i]->clock() == Clock::thread ? collector.cpu_seconds[i] : collector.real_seconds[i]));
  }
  return seconds;
}

}  // namespace edgecase::conformance
