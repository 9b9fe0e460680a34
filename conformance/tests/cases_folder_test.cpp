// The case files of this repository: each one is readable, complete, right by both oracles, and like no other.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/oracle/demands.h"
#include "conformance/scene/window_position.h"

namespace edgecase::conformance {
namespace {

const std::filesystem::path kRoot = std::filesystem::path(EDGECASE_SOURCE_DIR) / "cases";

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = [] {
    std::vector<Case> loaded;
    const auto files = find_cases(kRoot);
    EXPECT_TRUE(files) << files.error().message;
    for (const auto& file : *files) {
      const auto read = load_case(file, kRoot);
      EXPECT_TRUE(read) << read.error().message;
      if (read) loaded.push_back(*read);
    }
    return loaded;
  }();
  return cases;
}

std::string readme() {
  std::ifstream file(kRoot / "README.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::int8_t> counts(const Case& one, oracle::Method method) {
  const Scene& scene = one.scene;
  const Scene window{scene.setting, scene.rules, exact_window_triangles(scene).value_or(std::vector<Triangle>{}), {}};
  std::vector<std::int8_t> result;
  for (const auto& [triangles, open] :
       oracle::sample_demands(scene.setting, oracle::demands(window, *one.rule_set, method))) {
    result.push_back(open ? Expectation::kMay : static_cast<std::int8_t>(triangles));
  }
  return result;
}

/// As the rows of `expect`, the samples of a pixel side by side. Where a case under the exact rules leaves a sample
/// open, it stands for whatever they say.
std::string as_rows(const Case& one, const std::vector<std::int8_t>& counts) {
  std::string rows(1, '\n');
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const bool may =
        counts[i] == Expectation::kMay || (one.rule_set->exact() && one.expect->counts[i] == Expectation::kMay);
    rows += may ? '?' : counts[i] == 0 ? '.' : counts[i] == 1 ? '#' : static_cast<char>('0' + counts[i]);
    const auto samples = static_cast<std::size_t>(one.scene.setting.samples());
    const std::size_t width = static_cast<std::size_t>(one.scene.setting.target.width) * samples;
    if ((i + 1) % samples == 0) rows += samples > 1 ? " " : "";
    if ((i + 1) % width == 0) rows += '\n';
  }
  return rows;
}

TEST(CasesFolder, HasCases) { EXPECT_GE(all_cases().size(), 350u); }

TEST(CasesFolder, EveryExpectationIsWhatBothOraclesSay) {
  for (const Case& one : all_cases()) {
    // What a clipper has a say in, nothing can be expected of; everything else says what it expects.
    ASSERT_EQ(one.expect.has_value(), exact_window_triangles(one.scene).has_value()) << one.path;
    if (!one.expect) continue;
    const std::string expected = as_rows(one, one.expect->counts);
    EXPECT_EQ(expected, as_rows(one, counts(one, oracle::Method::by_definition))) << one.path;
    EXPECT_EQ(expected, as_rows(one, counts(one, oracle::Method::by_shift))) << one.path;
  }
}

TEST(CasesFolder, EveryCategoryIsAFolderInTheTableOfTheReadme) {
  std::set<std::string> folders;
  for (const Case& one : all_cases()) folders.insert(one.category);
  std::set<std::string> documented;
  const std::string text = readme();
  const std::size_t heading = text.find("\n## Categories\n");
  ASSERT_NE(heading, std::string::npos);
  for (std::size_t at = heading; (at = text.find("\n| `", at)) != std::string::npos; at += 4)
    documented.insert(text.substr(at + 4, text.find('`', at + 4) - at - 4));
  EXPECT_EQ(folders, documented);
}

TEST(CasesFolder, NamesAreLowerCaseWords) {
  for (const Case& one : all_cases()) {
    EXPECT_EQ(one.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_/"), std::string::npos) << one.name;
    EXPECT_EQ(std::count(one.name.begin(), one.name.end(), '/'), 1) << one.name;
  }
}

TEST(CasesFolder, NoTwoCasesAreTheSame) {
  std::map<std::string, std::string> first_with;
  for (Case one : all_cases()) {
    const std::string name = one.name;
    one.about.assign(1, '-');
    one.source = one.about;
    one.expect.reset();
    const auto [known, is_new] = first_with.emplace(write_case(one), name);
    EXPECT_TRUE(is_new) << name << " has the scene of " << known->second;
  }
}

TEST(CasesFolder, EveryCaseCanBeWrittenAgain) {
  for (const Case& one : all_cases()) {
    const auto read = parse_case(write_case(one), one.path, one.name);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->scene.setting, one.scene.setting) << one.name;
    EXPECT_EQ(read->scene.rules, one.scene.rules) << one.name;
    EXPECT_EQ(read->scene.triangles, one.scene.triangles) << one.name;
    EXPECT_EQ(read->scene.meshes, one.scene.meshes) << one.name;
    EXPECT_EQ(read->scene.assembly, one.scene.assembly) << one.name;
    EXPECT_EQ(read->scene.clip, one.scene.clip) << one.name;
    EXPECT_EQ(read->expect, one.expect) << one.name;
  }
}

}  // namespace
}  // namespace edgecase::conformance
