#include <fmt/format.h>

#include <cstdio>

#include "conformance/generators/generator.h"
#include "conformance/metamorphic/metamorphosis.h"
#include "conformance/runner/case_library.h"
#include "conformance/runner/categories.h"
#include "conformance/runner/commands.h"
#include "conformance/subjects/fault_subject.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {

int fail(const Error& error) {
  fmt::print(stderr, "edgecase: {}\n", error.message);
  switch (error.kind) {
    case ErrorKind::bad_input:
      return kBadInput;
    case ErrorKind::absent:
      return kAbsent;
    case ErrorKind::subject:
      break;
  }
  return kMismatch;
}

int list_command(const DataFiles& data, const std::string& what) {
  const auto heading = [&](const char* name) {
    if (what.empty()) fmt::print("{}:\n", name);
    return what.empty() || what == name;
  };
  const auto line = [&](std::string_view name, std::string_view about) {
    fmt::print("{}{:<28} {}\n", what.empty() ? "  " : "", name, about);
  };
  if (heading("cases")) {
    const auto cases = load_all_cases(data.cases);
    if (!cases) return fail(cases.error());
    for (const Case& c : *cases) line(c.name, c.about);
  }
  if (heading("subjects")) {
    for (const SubjectName& subject : subject_names()) line(subject.name, subject.about);
  }
  if (heading("generators")) {
    for (const Generator& generator : generators()) line(generator.name, generator.about);
    for (const Generator& generator : clip_generators()) line(generator.name, generator.about);
    for (const Metamorphosis& check : metamorphoses()) line(check.name, check.about);
  }
  if (heading("categories")) {
    const auto categories = load_categories(data.cases);
    if (!categories) return fail(categories.error());
    for (const Category& category : *categories) line(category.name, category.about);
  }
  return kAsExpected;
}

}  // namespace edgecase::conformance
