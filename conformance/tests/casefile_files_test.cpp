// Case files on disk: names, categories, the walk over the folder, and files that are none.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "conformance/casefile/casefile.h"
#include "conformance/tests/temporary_folder.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kGood =
    R"({"about": "a", "source": "s", "target": [1, 1], "fan": [["0","0"],["4","0"],["0","4"]]})";

class CaseFiles : public testing::Test {
 protected:
  fs::path put(const fs::path& relative, std::string_view text) const {
    const fs::path file = folder_ / relative;
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  std::string message(const fs::path& file) const {
    const auto result = load_case(file, folder_.path());
    return result ? "no error" : result.error().message;
  }

  TemporaryFolder folder_;
};

TEST_F(CaseFiles, AreNamedByTheirPlaceBelowTheRoot) {
  const auto deep = load_case(put("cases/fan/deep/x.y.json", kGood), folder_ / "cases");
  ASSERT_TRUE(deep) << deep.error().message;
  EXPECT_EQ(deep->name, "fan/deep/x.y");
  EXPECT_EQ(deep->category, "fan");
  EXPECT_EQ(deep->path, (folder_ / "cases/fan/deep/x.y.json").string());

  const auto top = load_case(put("cases/top.json", kGood), folder_ / "cases/");
  ASSERT_TRUE(top);
  EXPECT_EQ(top->name, "top");
  EXPECT_EQ(top->category, "");

  const auto detour = load_case(folder_ / "cases/fan/../top.json", folder_ / "cases");
  ASSERT_TRUE(detour);
  EXPECT_EQ(detour->name, "top");
}

TEST_F(CaseFiles, OutsideTheRootHaveNoCategory) {
  put("report/x.json", kGood);
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  const auto outside = load_case("report/x.json", "cases");
  fs::current_path(before);
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->name, "report/x");
  EXPECT_EQ(outside->category, "");
}

TEST_F(CaseFiles, AreFoundInTheOrderOfTheirPaths) {
  for (const auto file : {"b/z.json", "b/a.json", "a/z.json", "a.json", "README.md", "a/.hidden.json", ".git/x.json"})
    put(file, kGood);
  const auto found = find_cases(folder_.path());
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(*found, (std::vector<fs::path>{folder_ / "a.json", folder_ / "a/z.json", folder_ / "b/a.json",
                                           folder_ / "b/z.json"}));
}

TEST_F(CaseFiles, FolderThatIsNone) {
  EXPECT_EQ(find_cases(folder_ / "none").error().message, (folder_ / "none").string() + ": there is no such folder");
  EXPECT_EQ(find_cases(put("x.json", kGood)).error().message, (folder_ / "x.json").string() + ": is not a folder");
}

TEST_F(CaseFiles, FileThatIsNone) {
  const std::string folder = folder_.string();
  EXPECT_EQ(message(folder_ / "none.json"), folder + "/none.json: there is no such file");
  EXPECT_EQ(message(folder_.path()), folder + ": is a folder, not a case file");
  EXPECT_EQ(message(put("empty.json", "")), folder + "/empty.json: the file is empty");
  EXPECT_EQ(message(put("x.json", "{")),
            folder + "/x.json:1:2: not JSON: unexpected end of input; expected string literal");
  EXPECT_EQ(message(folder_ / "x.json/y.json"), folder + "/x.json/y.json: there is no such file");
}

TEST_F(CaseFiles, PipesAreNotWaitedFor) {
  const fs::path pipe = folder_ / "pipe.json";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(message(pipe), pipe.string() + ": is not a regular file");
}

TEST_F(CaseFiles, SizeIsLimited) {
  const std::string padding(kMaxCaseBytes - kGood.size(), ' ');
  EXPECT_EQ(message(put("most.json", padding + std::string(kGood))), "no error");
  const fs::path file = put("more.json", " " + padding + std::string(kGood));
  EXPECT_EQ(message(file), file.string() + ": is larger than 8388608 bytes, the most a case file may have");
}

TEST_F(CaseFiles, WithoutPermission) {
  const fs::path file = put("x.json", kGood);
  fs::permissions(file, fs::perms::none);
  fs::permissions(folder_.path(), fs::perms::all);
  // Root may read every file: become somebody else for this one.
  constexpr uid_t kNobody = 65534;
  const bool root = geteuid() == 0;
  ASSERT_EQ(root ? seteuid(kNobody) : 0, 0);
  const std::string refused = message(file);
  ASSERT_EQ(root ? seteuid(0) : 0, 0);
  EXPECT_EQ(refused, file.string() + ": cannot be read: Permission denied");
}

}  // namespace
}  // namespace edgecase::conformance
