// Exhaustion: that it counts every triangle once, that its oracle is the oracle, that it can fail, and that it goes on
// after a kill as if nothing had happened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "conformance/oracle/lattice_oracle.h"
#include "conformance/oracle/oracle.h"
#include "conformance/runner/exhaust.h"
#include "conformance/runner/exhaust_state.h"
#include "conformance/tests/temporary_folder.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

ExhaustPlan plan_for(const std::string& subject, int bits = 1, Extent target = {4, 4}, int jobs = 1) {
  return {bits, target, subject, nullptr, jobs};
}

Exhaustion run(const ExhaustPlan& plan, const Exhaustion& done = {}) {
  auto subject = make_subject(plan.subject).value();
  EXPECT_FALSE(check_exhaust(plan, *subject));
  auto found = exhaust(plan, std::move(subject), done, [](const Exhaustion&) {});
  EXPECT_TRUE(found) << found.error().message;
  return found.value_or(Exhaustion{});
}

TEST(LatticeOracle, IsTheOracleByDefinition) {
  for (const Extent target : {Extent{3, 2}, Extent{2, 3}, Extent{1, 5}}) {
    const oracle::LatticeOracle lattice(target, 1);
    Setting setting;
    setting.target = target;
    const MaskLayout layout(setting);
    std::vector<std::uint64_t> expected(layout.words());
    for (std::size_t a = 0; a < lattice.points(); ++a) {
      for (std::size_t b = 0; b < lattice.points(); ++b) {
        for (std::size_t c = 0; c < lattice.points(); ++c) {
          if (a == b || b == c || c == a) continue;
          std::uint64_t mask = 0;
          lattice.cover(a, b, c, {&mask, 1});
          oracle::cover_by_definition(setting, {}, {lattice.position(a), lattice.position(b), lattice.position(c)},
                                      expected);
          for (int y = 0; y < target.height; ++y) {
            for (int x = 0; x < target.width; ++x) {
              ASSERT_EQ(mask >> (y * target.width + x) & 1, covered(expected, layout.bit(x, y, 0)) ? 1u : 0u)
                  << a << ' ' << b << ' ' << c << " at " << x << ' ' << y;
            }
          }
        }
      }
    }
  }
}

TEST(Exhaust, NumbersEverySetOfThreePointsOnce) {
  const ExhaustPlan plan = plan_for("edgecase", 0, {3, 2});
  ASSERT_EQ(exhaust_triangles(plan), 12u * 11 * 10 / 6);
  std::set<std::set<std::pair<float, float>>> seen;
  for (std::uint64_t i = 0; i < exhaust_triangles(plan); ++i) {
    std::set<std::pair<float, float>> points;
    for (const Position& p : exhaust_triangle(plan, i)) points.insert({p.x, p.y});
    EXPECT_EQ(points.size(), 3u);
    EXPECT_TRUE(seen.insert(points).second);
  }
  EXPECT_EQ(exhaust_triangles(plan_for("edgecase", 3)), 214'652'064u);
}

TEST(Exhaust, FindsOursRightAndPlantedFaultsWrong) {
  const Exhaustion ours = run(plan_for("edgecase", 1, {4, 4}, 2));
  EXPECT_EQ(ours.triangles, 85'320u);
  EXPECT_EQ(ours.samples_compared, 85'320u * 16);
  EXPECT_EQ(ours.wrong, 0u);
  EXPECT_FALSE(ours.first);
  for (const char* fault : {"fault:right-inclusive", "fault:all-exclusive", "fault:corner-sample", "fault:y-flipped"}) {
    const Exhaustion found = run(plan_for(fault));
    EXPECT_GT(found.wrong, 1000u) << fault;
    EXPECT_GE(found.wrong, found.unexplained) << fault;
    ASSERT_TRUE(found.first) << fault;
  }
}

TEST(Exhaust, NamesTheFirstWrongSample) {
  const ExhaustPlan plan = plan_for("fault:right-inclusive");
  const Exhaustion found = run(plan);
  ASSERT_TRUE(found.first);
  const Triangle triangle = exhaust_triangle(plan, found.first->triangle);
  const auto explained = oracle::explain(Setting{{4, 4}}, {}, triangle, found.first->x, found.first->y, 0);
  EXPECT_EQ(explained.inside, found.first->missing);
}

TEST(Exhaust, GoesOnWhereItStopped) {
  const ExhaustPlan plan = plan_for("fault:all-exclusive", 1, {4, 4}, 2);
  const Exhaustion whole = run(plan);
  // What a state says after the first 12,345 triangles, by way of its file.
  const TemporaryFolder folder;
  Exhaustion part;
  part.triangles = 12'345;
  auto rest = run(plan, part);
  part.wrong = whole.wrong - rest.wrong;
  part.unexplained = whole.unexplained - rest.unexplained;
  part.first = whole.first;
  EXPECT_GT(part.wrong, 0u);
  EXPECT_GT(rest.wrong, 0u);
  std::ofstream(folder / "state.json") << exhaust_state(plan, "", part);
  const auto loaded = load_exhaust_state(folder / "state.json", plan, "");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->triangles, part.triangles);
  const Exhaustion resumed = run(plan, *loaded);
  EXPECT_EQ(resumed.triangles, whole.triangles);
  EXPECT_EQ(resumed.samples_compared, whole.triangles * 16);
  EXPECT_EQ(resumed.wrong, whole.wrong);
  EXPECT_EQ(resumed.unexplained, whole.unexplained);
  EXPECT_EQ(resumed.first, whole.first);
}

TEST(Exhaust, RefusesAStateOfSomethingElse) {
  const TemporaryFolder folder;
  const fs::path file = folder / "state.json";
  const ExhaustPlan plan = plan_for("fault:all-exclusive");
  Exhaustion done;
  done.triangles = 500;
  done.wrong = 7;
  done.unexplained = 3;
  done.first = {12, 1, 2, true};
  const auto good = nlohmann::json::parse(exhaust_state(plan, "a device", done));
  const auto complaint = [&](const std::string& text) -> std::string {
    std::ofstream(file, std::ios::trunc) << text;
    const auto loaded = load_exhaust_state(file, plan, "a device");
    return loaded ? "" : loaded.error().message;
  };
  const auto with = [&](const char* field, const nlohmann::json& value) {
    auto changed = good;
    changed[field] = value;
    return changed.dump();
  };
  EXPECT_EQ(complaint(good.dump()), "");
  EXPECT_THAT(complaint(with("subject", "edgecase")), HasSubstr("subject is \"edgecase\""));
  EXPECT_THAT(complaint(with("lattice_bits", 2)), HasSubstr("lattice_bits is 2"));
  EXPECT_THAT(complaint(with("target", {8, 4})), HasSubstr("target is [8,4]"));
  EXPECT_THAT(complaint(with("device", "another")), HasSubstr("device is \"another\""));
  EXPECT_THAT(complaint(with("edgecase", "9.9")), HasSubstr("edgecase is \"9.9\""));
  EXPECT_THAT(complaint(with("triangles", 1'000'000)), HasSubstr("triangles = 1000000"));
  EXPECT_THAT(complaint(with("triangles", -1)), HasSubstr("triangles = -1"));
  EXPECT_THAT(complaint(with("wrong", 500 * 16 + 1)), HasSubstr("wrong = 8001"));
  EXPECT_THAT(complaint(with("wrong", 0)), HasSubstr("first = "));
  EXPECT_THAT(complaint(with("first", nullptr)), HasSubstr("first = null"));
  EXPECT_THAT(complaint(with("first", {{"triangle", 500}, {"x", 1}, {"y", 1}, {"missing", true}})),
              HasSubstr("first: triangle = 500"));
  EXPECT_THAT(complaint(with("seconds", "long")), HasSubstr("seconds = \"long\""));
  EXPECT_THAT(complaint("{\"edgecase\": 1"), HasSubstr("state.json: is no state"));
  EXPECT_THAT(complaint("{}"), HasSubstr("there is no field edgecase"));
  fs::remove(file);
  EXPECT_EQ(load_exhaust_state(file, plan, "a device")->triangles, 0u);
}

TEST(Exhaust, RefusesWhatItCannotHold) {
  const auto subject = make_subject("edgecase").value();
  const auto complaint = [&](const ExhaustPlan& plan) {
    return check_exhaust(plan, *subject).value_or(Error{}).message;
  };
  EXPECT_EQ(complaint(plan_for("edgecase", 3, {8, 8})), "");
  EXPECT_THAT(complaint(plan_for("edgecase", 1, {13, 5})), HasSubstr("--target 13x5: 65 pixels"));
  EXPECT_THAT(complaint(plan_for("edgecase", 4, {8, 8})), HasSubstr("--lattice-bits 4: 16641 lattice points"));
}

}  // namespace
}  // namespace edgecase::conformance
