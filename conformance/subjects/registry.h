// The subjects that can be named.
#pragma once

#include <string>
#include <vector>

#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

struct SubjectName {
  /// As make_subject() takes it; capitals stand for what the user fills in: `vulkan:DEVICE-OR-ICD`.
  std::string name;
  /// One line for a person.
  std::string about;
};

/// Every name that make_subject() knows, whether or not its driver is installed.
std::vector<SubjectName> subject_names();

}  // namespace edgecase::conformance
