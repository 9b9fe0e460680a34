// The case files a command works on.
#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// Every case below `root`, in the order of their paths.
tl::expected<std::vector<Case>, Error> load_all_cases(const std::filesystem::path& root);

/// The cases that `patterns` name, each once: a path of a file, a case's name as `list cases` prints it, or a pattern
/// of such names with *, ? and [...]. A pattern without any match is bad input; its message proposes the nearest name.
tl::expected<std::vector<Case>, Error> load_cases(const std::filesystem::path& root,
                                                  const std::vector<std::string>& patterns);

}  // namespace edgecase::conformance
