// The program as a script sees it: exit statuses, one clear line for every bad input, and files that are whole or
// absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "conformance/tests/temporary_folder.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

class CommandLine : public testing::Test {
 protected:
  Outcome run(const std::string& arguments, const std::string& environment = "") {
    return shell(environment + " '" EDGECASE_PROGRAM "' " + arguments);
  }

  Outcome shell(const std::string& in_folder) {
    const std::string command = "cd '" + folder_.string() + "' && " + in_folder + " >out.txt 2>err.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(folder_ / "out.txt"),
            content_of(folder_ / "err.txt")};
  }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return name;
  }

  static void expect_one_line(const Outcome& outcome, int status, const std::string& part) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(part));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }

  TemporaryFolder folder_;
};

constexpr const char* kCase = R"({"about": "A test.", "source": "none", "target": [4, 4],
  "triangles": [[["0", "0"], ["4", "0"], ["0", "4"]]]})";

// Without a network, and without Debian, there is one line, and nothing else is touched.
TEST_F(CommandLine, MesaFromBackportsSaysInOneLineThatItCannotBeHad) {
  const Outcome outcome = shell("EDGECASE_DEBIAN_MIRROR=http://127.0.0.1:9/debian '" EDGECASE_SOURCE_DIR
                                "/conformance/subjects/mesa_backports.sh' unpacked");
  expect_one_line(outcome, 2, "edgecase: ");
}

TEST_F(CommandLine, ComparesSeveralVulkanDriversInOneRun) {
  // The same driver by its ICD file and by its device.
  const Outcome outcome =
      run("run fill_rule/flat_top --subject vulkan:lvp_icd.x86_64.json --subject vulkan:llvmpipe --json two.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(content_of(folder_ / "two.json"));
  ASSERT_EQ(json.at("results").size(), 2U);
  for (const auto& result : json.at("results")) {
    EXPECT_EQ(result.at("verdict"), "pass");
    EXPECT_THAT(result.at("device").get<std::string>(), HasSubstr("llvmpipe"));
  }
}

TEST_F(CommandLine, RunsACaseAndWritesJson) {
  const Outcome outcome = run("run " + write("a.json", kCase) + " --subject edgecase --json r.json --seed 5");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(content_of(folder_ / "r.json"));
  EXPECT_EQ(json["seed"], 5);
  ASSERT_EQ(json["results"].size(), 1u);
  const auto& result = json["results"][0];
  EXPECT_EQ(result["subject"], "edgecase");
  EXPECT_EQ(result["verdict"], "pass");
  EXPECT_EQ(result["triangles"], 1);
  EXPECT_EQ(result["samples_compared"], 16);
  EXPECT_EQ(json["totals"]["pass"], 1);
}

TEST_F(CommandLine, AMismatchIsStatusOneWithPictureReproductionAndCommand) {
  const Outcome outcome =
      run("run --subject fault:right-inclusive --generator ties --count 500 --report rep --junit j.xml");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("fail"));
  EXPECT_THAT(content_of(folder_ / "j.xml"), HasSubstr("<failure"));
  ASSERT_TRUE(fs::exists(folder_ / "rep/fault-right-inclusive-ties-1.png"));
  ASSERT_TRUE(fs::exists(folder_ / "rep/fault-right-inclusive-ties-1.svg"));
  ASSERT_TRUE(fs::exists(folder_ / "rep/index.html"));
  // The reproduction shows the fault again, and clears the innocent.
  EXPECT_EQ(run("run rep/fault-right-inclusive-ties-1.json --subject fault:right-inclusive --report rep2").status, 1);
  EXPECT_EQ(run("run rep/fault-right-inclusive-ties-1.json --subject edgecase").status, 0);
}

TEST_F(CommandLine, TheSameSeedGivesTheSameResult) {
  const std::string arguments = "run --subject fault:corner-sample --generator fan --count 3000 --report rep --json ";
  run(arguments + "a.json --jobs 1");
  run(arguments + "b.json --jobs 2");
  auto a = nlohmann::json::parse(content_of(folder_ / "a.json"));
  auto b = nlohmann::json::parse(content_of(folder_ / "b.json"));
  for (auto* json : {&a, &b}) {
    (*json)["totals"].erase("seconds");
    for (auto& result : (*json)["results"]) {
      result.erase("seconds");
      result.erase("subject_seconds");
    }
  }
  EXPECT_EQ(a, b);
}

TEST_F(CommandLine, ListsAndShows) {
  EXPECT_THAT(run("list subjects").out, AllOf(HasSubstr("lavapipe"), HasSubstr("fault:snap-truncate")));
  EXPECT_THAT(run("list generators").out, HasSubstr("fan"));
  const Outcome cases = run("list cases");
  EXPECT_EQ(cases.status, 0) << cases.err;
  EXPECT_GE(std::count(cases.out.begin(), cases.out.end(), '\n'), 60);
  const Outcome shown = run("show " + write("a.json", kCase));
  EXPECT_EQ(shown.status, 0);
  EXPECT_THAT(shown.out, AllOf(HasSubstr("A test."), HasSubstr("#")));
  EXPECT_THAT(run("show clip/depth_at_both_ends --subject lavapipe").out, HasSubstr("###."));
  EXPECT_EQ(run("show clip/depth_at_both_ends --subject osmesa-softpipe").status, 2);
  EXPECT_THAT(run("show clip/one_w_near_0 --subject lavapipe").out,
              HasSubstr("beyond the reach of its clipper's model"));
  EXPECT_THAT(run("show clip/behind_the_eye --subject fault:behind-drawn").out, HasSubstr("\n> 0 xxx.\n"));
  expect_one_line(run("show clip/mesh_across_the_near_plane"), 2, "--subject");
  EXPECT_THAT(run("show fill_rule/flat_top --rules webgpu").out, HasSubstr("\n  0 ------\n"));
  expect_one_line(run("show fan"), 2, "'fan/*'");
  EXPECT_EQ(run("run --subject edgecase fill_rule/flat_top").status, 0);  // an option takes one value
  EXPECT_EQ(run("show clip/mesh_across_the_near_plane --subject lavapipe --png clipped.png").status, 0);
  EXPECT_EQ(run("show a.json --subject fault:all-exclusive --png p.png").status, 0);
  EXPECT_THAT(content_of(folder_ / "p.png").substr(1, 3), "PNG");
}

TEST_F(CommandLine, NamesCategoriesAndRunsThem) {
  const std::string categories = run("list categories").out;
  for (const char* name : {"fan ", "shared_edge ", "ties ", "range ", "winding ", "metamorphic "}) {
    EXPECT_THAT(categories, HasSubstr(name));
  }
  std::istringstream lines(categories);
  for (std::string line; std::getline(lines, line);) EXPECT_GT(line.size(), 40u) << "says nothing: " << line;

  const auto run_categories = [&](const std::string& arguments) {
    EXPECT_EQ(run("run --subject edgecase --count 400 --json r.json " + arguments).status, 0);
    std::set<std::string> found;
    const auto json = nlohmann::json::parse(content_of(folder_ / "r.json"));
    for (const auto& result : json["results"]) found.insert(result["category"]);
    return found;
  };
  EXPECT_EQ(run_categories("--category fan --category metamorphic"), (std::set<std::string>{"fan", "metamorphic"}));
  EXPECT_EQ(run_categories("--category fan --generator fan --generator ties"), std::set<std::string>{"fan"});
  EXPECT_EQ(run_categories("--generator tiles"), std::set<std::string>{"metamorphic"});
  expect_one_line(run("run --category metamorfic"), 2, "did you mean \"metamorphic\"?");
  expect_one_line(run("run --category fan --generator ties"), 2, "is of category \"fan\"");
  const Outcome caught = run("run --category metamorphic --count 4000 --subject fault:all-exclusive");
  EXPECT_EQ(caught.status, 1);
  EXPECT_THAT(caught.out, HasSubstr("covered before the change, and not after it"));
}

TEST_F(CommandLine, FindsTheLimitsOfSubjects) {
  const Outcome limits = run("limits --subject edgecase --subject lavapipe");
  EXPECT_EQ(limits.status, 0) << limits.err;
  EXPECT_EQ(
      limits.out,
      "edgecase: exact to ±32,767.99609375 px; beyond: not accepted\n"
      "lavapipe: exact to ±2,847.8515625 px, as its known deviation predicts to ±8,192 px; beyond: not accepted\n");
  expect_one_line(run("limits --subject lavapip"), 2, "lavapip");
}

TEST_F(CommandLine, UnknownNamesAreBadInputAndProposeTheNearest) {
  expect_one_line(run("run --subject lavapip"), 2, "lavapipe");
  expect_one_line(run("run --generator fam --subject edgecase"), 2, "\"fan\"");
  expect_one_line(run("run no_such_case --subject edgecase"), 2, "no_such_case");
  expect_one_line(run("run gone.json --subject edgecase"), 2, "gone.json");
  EXPECT_EQ(run("runn").status, 2);
  EXPECT_EQ(run("run --count 0").status, 2);
  EXPECT_EQ(run("").status, 2);
  EXPECT_EQ(run("--help").status, 0);
}

TEST_F(CommandLine, AMissingDriverIsStatusThree) {
  expect_one_line(run("run --subject vulkan:no-such-device --generator tiny --count 10"), 3, "no-such-device");
  expect_one_line(run("run --subject vulkan:/no/such/icd.json --generator tiny --count 10"), 3, "/no/such/icd.json");
}

TEST_F(CommandLine, EveryBadCaseFileIsNamedWithFieldAndValue) {
  const auto expect_bad = [&](const std::string& text, const std::string& part) {
    SCOPED_TRACE(text);
    const Outcome outcome = run("run " + write("bad.json", text) + " --subject edgecase --json r.json");
    expect_one_line(outcome, 2, "bad.json");
    EXPECT_THAT(outcome.err, HasSubstr(part));
    EXPECT_FALSE(fs::exists(folder_ / "r.json"));
  };
  const std::string head = R"({"about": "x", "source": "y", "target": )";
  expect_bad("", "");
  expect_bad("{", "");
  expect_bad(head + R"([4, 4], "trianglez": []})", "trianglez");
  expect_bad(head + R"([4], "triangles": [[["0","0"],["1","0"],["0","1"]]]})", "target");
  expect_bad(head + R"([0, 4], "triangles": [[["0","0"],["1","0"],["0","1"]]]})", "0");
  expect_bad(head + R"([4, 99999], "triangles": [[["0","0"],["1","0"],["0","1"]]]})", "99999");
  expect_bad(head + R"([4, 4], "triangles": [[["0.1","0"],["1","0"],["0","1"]]]})", "0.1");
  expect_bad(head + R"([4, 4], "triangles": [[["1e9","0"],["1","0"],["0","1"]]]})", "1e9");
  expect_bad(head + R"([4, 4], "triangles": [[["nan","0"],["1","0"],["0","1"]]]})", "nan");
  expect_bad(head + R"([4, 4], "vertices": [["0","0"],["1","0"],["0","1"]], "indices": [0, 1, 7]})", "7");
  expect_bad(head + R"([4, 4], "target": [4, 4], "triangles": [[["0","0"],["1","0"],["0","1"]]]})", "target");
  expect_bad(head + R"([4, 4], "triangles": [[["0","0"],["1","0"],["0","1"]]], "expect": ["...."]})", "expect");
  // What it expects contradicts the rules: the case is wrong, not the subject.
  const Outcome contradiction = run("run " +
                                    write("c.json", head + R"([2, 1], "triangles": [[["0","0"],["2","0"],["0","2"]]],
      "expect": ["##"]})") + " --subject edgecase");
  EXPECT_EQ(contradiction.status, 1);
  EXPECT_THAT(contradiction.out, HasSubstr("the case says 1 triangles, the rules say 0"));
}

TEST_F(CommandLine, ExhaustsALatticeAlsoAfterBeingKilled) {
  // Far more triangles than can be drawn until it is killed; a state is written every second.
  const std::string arguments =
      "exhaust --lattice-bits 3 --target 4x4 --subject fault:all-exclusive --jobs 1 --state s.json";
  const auto killed_at = [&] {
    const int status = std::system(
        ("cd '" + folder_.string() + "' && timeout -s KILL 1.6 '" EDGECASE_PROGRAM "' " + arguments + " 2>/dev/null")
            .c_str());
    EXPECT_NE(status, 0);
    return nlohmann::json::parse(content_of(folder_ / "s.json"))["triangles"].get<std::uint64_t>();
  };
  const std::uint64_t first = killed_at();
  EXPECT_GT(first, 0u);
  EXPECT_GT(killed_at(), first);
  const Outcome other = run("exhaust --lattice-bits 3 --target 4x4 --subject fault:y-flipped --state s.json");
  expect_one_line(other, 2, "s.json: subject is \"fault:all-exclusive\"");
  const std::string smaller = "exhaust --lattice-bits 1 --target 4x4 --subject fault:all-exclusive --json r.json";
  EXPECT_EQ(run(smaller).status, 1);
  const auto json = nlohmann::json::parse(content_of(folder_ / "r.json"));
  EXPECT_EQ(json["triangles"], 85'320);
  EXPECT_EQ(json["samples_compared"], 85'320 * 16);
  EXPECT_GT(json["wrong"], 0);
  EXPECT_GT(json["seconds"], 0);
  EXPECT_EQ(json["missing"].get<int>() + json["unexpected"].get<int>(), json["wrong"].get<int>());
  EXPECT_EQ(run("exhaust --lattice-bits 1 --target 2x2 --subject fault:right-inclusive --report r").status, 1);
  EXPECT_THAT(content_of(folder_ / "r/index.html"), HasSubstr("exhaustion.png"));
  EXPECT_TRUE(fs::exists(folder_ / "r/exhaustion.svg"));
  EXPECT_EQ(run("run r/exhaustion.json --subject fault:right-inclusive").status, 1);
  EXPECT_EQ(run("run r/exhaustion.json --subject edgecase").status, 0);
  expect_one_line(run("exhaust --lattice-bits 1 --target 2x2 --report /proc/none"), 2, "/proc/none");
  expect_one_line(run("exhaust --lattice-bits 1 --target 13x5"), 2, "13x5");
  EXPECT_EQ(run("exhaust --target 4x").status, 2);
  EXPECT_EQ(run("exhaust --target 65x1").status, 2);
}

TEST_F(CommandLine, FilesAreWholeOrAbsent) {
  write("a.json", kCase);
  expect_one_line(run("run a.json --subject edgecase --report /proc/none"), 2, "/proc/none");
  write("file", "");
  expect_one_line(run("run a.json --subject edgecase --report file"), 2, "file");
  const Outcome full = run("run a.json --subject edgecase --json /dev/full");
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.err, HasSubstr("/dev/full"));
  const Outcome nowhere = run("run a.json --subject edgecase --json no/such/folder/r.json");
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("no/such/folder/r.json"));
}

}  // namespace
}  // namespace edgecase::conformance
