// The family of rasterizers as subjects.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

struct FamilySubjectName {
  std::string_view name;
  std::string_view about;  ///< one line for a person
};

/// The names that make_family_subject() knows, in the order of the family.
std::vector<FamilySubjectName> family_subjects();

/// `edgecase:NAME` for the member of the family of that name; null for any other.
///
/// 16.8, snapped to nearest even, one sample in the pixel's centre; coordinates up to one subpixel below 32768 px of
/// either sign.
std::unique_ptr<Subject> make_family_subject(std::string_view name);

}  // namespace edgecase::conformance
