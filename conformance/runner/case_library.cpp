#include "conformance/runner/case_library.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>

#include "conformance/scene/nearest_name.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

struct CaseFile {
  fs::path path;
  std::string name;
};

tl::expected<std::vector<CaseFile>, Error> case_files(const fs::path& root) {
  auto paths = find_cases(root);
  if (!paths) return tl::unexpected(paths.error());
  std::vector<CaseFile> files;
  for (const fs::path& path : *paths) {
    files.push_back({path, path.lexically_relative(root).replace_extension().generic_string()});
  }
  return files;
}

bool looks_like_a_path(const std::string& pattern) {
  return pattern.ends_with(".json") && pattern.find_first_of("*?[") == std::string::npos;
}

Error no_such_case(const std::string& pattern, const std::vector<CaseFile>& files) {
  std::vector<std::string_view> names;
  for (const CaseFile& file : files) names.push_back(file.name);
  const std::string folder = pattern + (pattern.ends_with('/') ? "" : "/");
  if (std::ranges::any_of(names, [&](std::string_view name) { return name.starts_with(folder); })) {
    return {ErrorKind::bad_input,
            fmt::format("no case is called \"{0}\"; those in the folder are '{1}*'", pattern, folder)};
  }
  const auto nearest = nearest_name(pattern, names);
  return {ErrorKind::bad_input, fmt::format("no case is called \"{}\"{}", pattern,
                                            nearest ? fmt::format("; did you mean \"{}\"?", *nearest)
                                                    : std::string("; `edgecase list cases` names them all"))};
}

}  // namespace

tl::expected<std::vector<Case>, Error> load_all_cases(const fs::path& root) { return load_cases(root, {"*"}); }

tl::expected<std::vector<Case>, Error> load_cases(const fs::path& root, const std::vector<std::string>& patterns) {
  const auto files = case_files(root);
  if (!files) return tl::unexpected(files.error());

  std::vector<fs::path> chosen;
  const auto choose = [&](const fs::path& path) {
    if (std::find(chosen.begin(), chosen.end(), path) == chosen.end()) chosen.push_back(path);
  };
  for (const std::string& pattern : patterns) {
    std::error_code ignored;
    if (looks_like_a_path(pattern) || fs::is_regular_file(pattern, ignored)) {
      choose(pattern);
      continue;
    }
    bool any = false;
    for (const CaseFile& file : *files) {
      if (fnmatch(pattern.c_str(), file.name.c_str(), 0) != 0) continue;
      choose(file.path);
      any = true;
    }
    if (!any) return tl::unexpected(no_such_case(pattern, *files));
  }

  std::vector<Case> cases;
  for (const fs::path& path : chosen) {
    auto loaded = load_case(path, root);
    if (!loaded) return tl::unexpected(loaded.error());
    cases.push_back(std::move(*loaded));
  }
  return cases;
}

}  // namespace edgecase::conformance
