// Categories: what testcases are about.
#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"

namespace edgecase::conformance {

inline constexpr const char* kMetamorphicCategory = "metamorphic";

struct Category {
  std::string name;
  std::string about;  ///< one line
};

/// Every category of the case files below `cases`, of the generators and of the metamorphic checks, by name. What a
/// category of cases is about stands in the table of the README.md there; that of a generator alone in the generator.
tl::expected<std::vector<Category>, Error> load_categories(const std::filesystem::path& cases);

}  // namespace edgecase::conformance
