// Every hard case of cases/HARD_CASES.md is covered: a case file or a generator names each of its sources.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/generators/generator.h"

namespace edgecase::conformance {
namespace {

const std::filesystem::path kRoot = std::filesystem::path(EDGECASE_SOURCE_DIR) / "cases";

struct HardCase {
  std::string number;
  std::vector<std::string> sources;
};

/// What stands between the bars of a table's row, without the spaces around it.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  for (std::size_t bar = 0, next; (next = row.find('|', bar + 1)) != std::string::npos; bar = next) {
    const std::string cell = row.substr(bar + 1, next - bar - 1);
    const std::size_t first = cell.find_first_not_of(' ');
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
  }
  return cells;
}

std::vector<std::string> in_backquotes(const std::string& text) {
  std::vector<std::string> found;
  for (std::size_t open = 0; (open = text.find('`', open)) != std::string::npos;) {
    const std::size_t close = text.find('`', open + 1);
    if (close == std::string::npos) break;
    found.push_back(text.substr(open + 1, close - open - 1));
    open = close + 1;
  }
  return found;
}

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> listed;
  std::ifstream file(kRoot / "HARD_CASES.md");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("| ") || line.starts_with("| |")) continue;
    const auto cells = cells_of(line);
    EXPECT_EQ(cells.size(), 3u) << line;
    if (cells.size() == 3) listed.push_back({cells[0], in_backquotes(cells[2])});
  }
  return listed;
}

/// Every text that may name a source.
std::vector<std::string> citations() {
  std::vector<std::string> texts;
  const auto files = find_cases(kRoot);
  EXPECT_TRUE(files) << files.error().message;
  for (const auto& file : *files) {
    const auto read = load_case(file, kRoot);
    EXPECT_TRUE(read) << read.error().message;
    if (read) texts.push_back(read->source);
  }
  for (const Generator& generator : generators()) texts.emplace_back(generator.about);
  for (const Generator& generator : clip_generators()) texts.emplace_back(generator.about);
  return texts;
}

TEST(HardCases, TheListIsNumberedAndNamesItsSources) {
  const auto listed = hard_cases();
  ASSERT_EQ(listed.size(), 25u);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    EXPECT_EQ(listed[i].number, std::to_string(i + 1));
    EXPECT_FALSE(listed[i].sources.empty()) << listed[i].number;
  }
}

TEST(HardCases, EverySourceIsCited) {
  const auto texts = citations();
  for (const HardCase& hard : hard_cases()) {
    for (const std::string& source : hard.sources) {
      const bool cited = std::ranges::any_of(texts, [&](const std::string& text) {
        const std::size_t at = text.find(source);
        // #36 is not #365.
        const std::size_t end = at + source.size();
        return at != std::string::npos && (end == text.size() || text[end] < '0' || text[end] > '9');
      });
      EXPECT_TRUE(cited) << "no case cites " << source << ", hard case " << hard.number;
    }
  }
}

}  // namespace
}  // namespace edgecase::conformance
