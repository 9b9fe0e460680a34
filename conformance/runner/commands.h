// The commands of the command line. Each prints, and returns the program's exit status.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/scene/setting.h"

namespace edgecase::conformance {

enum ExitStatus : int {
  kAsExpected = 0,
  kMismatch = 1,  ///< or a known deviation that is no longer there
  kBadInput = 2,
  kAbsent = 3,  ///< a named subject is not there
};

/// Where this build finds its own data.
struct DataFiles {
  std::filesystem::path cases;
  std::filesystem::path known_deviations;
};

struct RunOptions {
  std::vector<std::string> cases;
  std::vector<std::string> subjects;
  /// Names of generators or metamorphic checks.
  std::vector<std::string> generators;
  std::vector<std::string> categories;
  std::string rules = "exact";  ///< the name of a RuleSet
  std::uint64_t count = 50'000;
  std::uint64_t seed = 1;
  std::string json;
  std::string junit;
  std::string report;
  int jobs = 1;
};

struct ExhaustOptions {
  int lattice_bits = 2;
  Extent target{4, 4};
  std::string subject = "edgecase";
  std::string json;
  std::string state;
  std::string report;
  int jobs = 1;
};

struct LimitsOptions {
  std::vector<std::string> subjects;
  std::uint64_t seed = 1;
};

struct StabilityOptions {
  std::uint64_t count = 5'000;  ///< triangles of each family, at least
  std::uint64_t seed = 1;
  std::string json;
  std::string plot;
};

struct ShowOptions {
  std::string case_name;
  std::string subject;
  std::string rules;  ///< the name of a RuleSet; the case's own if empty
  std::string png;
};

/// `what` is "cases", "subjects", "generators", "categories", or empty for all of them.
int list_command(const DataFiles& data, const std::string& what);
int run_command(const DataFiles& data, const RunOptions& options);
int exhaust_command(const DataFiles& data, const ExhaustOptions& options);
int limits_command(const DataFiles& data, const LimitsOptions& options);
int stability_command(const StabilityOptions& options);
int show_command(const DataFiles& data, const ShowOptions& options);

/// Prints `error` to standard error and returns the exit status of its kind.
int fail(const Error& error);

}  // namespace edgecase::conformance
