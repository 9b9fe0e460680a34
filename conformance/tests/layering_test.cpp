// The design's layering, kept by reading every #include of ours.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

// Which parts each part may include, besides itself. What is not listed here may include anything and be included by
// nobody.
const std::map<std::string, std::set<std::string>> kAllowed{
    {"rasterizer", {}},
    {"conformance/scene", {}},
    {"conformance/casefile", {"conformance/scene"}},
    {"conformance/generators", {"conformance/scene"}},
    {"conformance/metamorphic", {"conformance/scene", "conformance/generators"}},
    {"conformance/oracle", {"conformance/scene"}},
    {"conformance/models", {"conformance/scene"}},
    {"conformance/compare", {"conformance/scene"}},
    {"conformance/subjects", {"conformance/scene"}},
    {"conformance/report", {"conformance/scene", "conformance/compare"}},
};

// Our own subjects are the one place where the suite meets the rasterizer.
bool is_own_subject(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("edgecase_subject") || name.starts_with("family_subject");
}

std::string part_of(const std::string& path) {
  const fs::path p(path);
  auto it = p.begin();
  const std::string top = it->string();
  if (top != "conformance") return top;
  return ++it == p.end() ? top : top + "/" + it->string();
}

TEST(Layering, EveryIncludeIsAllowed) {
  const fs::path root = EDGECASE_SOURCE_DIR;
  const std::regex include(R"re(^\s*#\s*include\s*[<"]((?:rasterizer|conformance)/[^>"]+)[>"])re");
  int includes = 0;
  for (const char* top : {"rasterizer", "conformance"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      const std::string file = entry.path().lexically_relative(root).generic_string();
      const auto rule = kAllowed.find(part_of(file));
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, include)) continue;
        ++includes;
        const std::string target = part_of(match[1]);
        if (target == part_of(file)) continue;
        if (rule == kAllowed.end()) {
          EXPECT_TRUE(kAllowed.contains(target) || target == "conformance/runner" || target == "conformance/bench")
              << file << " includes " << match[1];
          continue;
        }
        const bool own =
            rule->first == "conformance/subjects" && target == "rasterizer" && is_own_subject(entry.path());
        EXPECT_TRUE(rule->second.contains(target) || own) << file << " includes " << match[1];
      }
    }
  }
  EXPECT_GT(includes, 50) << "the pattern no longer finds our includes";
}

}  // namespace
