// Times draws with Google Benchmark.
#pragma once

#include <cstddef>
#include <memory>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/bench/contender.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

struct Repetitions {
  std::size_t count;
  double seconds_each;  ///< at least
};

/// Of an odd or even number of values, at least one: the median, and the quartiles' difference over it.
struct Statistics {
  double median;
  double spread;
};
Statistics statistics(std::vector<double> values);

/// Seconds that draw() takes each of the contenders, which are prepared and have drawn before, in their order. The
/// repetitions of all of them are shuffled; each clears and shuffles untimed before every draw.
tl::expected<std::vector<Statistics>, Error> time_draws(const std::vector<std::unique_ptr<Contender>>& contenders,
                                                        const Repetitions& repetitions);

}  // namespace edgecase::conformance
