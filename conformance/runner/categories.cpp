#include "conformance/runner/categories.h"

#include <fstream>
#include <map>
#include <regex>

#include "conformance/casefile/casefile.h"
#include "conformance/generators/generator.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

// The rows | `name` | text | of the README's table of folders.
std::map<std::string, std::string> table_of(const fs::path& readme) {
  std::map<std::string, std::string> lines;
  std::ifstream in(readme);
  const std::regex row(R"(^\| `([a-z0-9_]+)` \| ([^|]+) \|\s*$)");
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_match(line, match, row)) lines.emplace(match[1], match[2]);
  }
  return lines;
}

}  // namespace

tl::expected<std::vector<Category>, Error> load_categories(const fs::path& cases) {
  const auto files = find_cases(cases);
  if (!files) return tl::unexpected(files.error());
  const auto table = table_of(cases / "README.md");
  std::map<std::string, std::string> found;
  for (const fs::path& file : *files) {
    const fs::path relative = file.lexically_relative(cases);
    if (!relative.has_parent_path()) continue;
    const std::string folder = relative.begin()->string();
    const auto about = table.find(folder);
    found.emplace(folder, about == table.end() ? "" : about->second);
  }
  for (const auto& all : {generators(), clip_generators()}) {
    for (const Generator& generator : all) {
      std::string& about = found[std::string(generator.category)];
      if (about.empty()) about = generator.about;
    }
  }
  found.emplace(kMetamorphicCategory, "changes of a scene after which the same has to be covered, whatever that is");
  std::vector<Category> result;
  for (const auto& [name, about] : found) result.push_back({name, about});
  return result;
}

}  // namespace edgecase::conformance
