// What each set of rules catches of the planted faults, and what it lets pass because the specification does.
#include "conformance/scene/rule_set.h"

#include <gtest/gtest.h>

#include <string>

#include "conformance/generators/generator.h"
#include "conformance/runner/mesh_choices.h"
#include "conformance/runner/run.h"

namespace edgecase::conformance {
namespace {

struct Total {
  std::uint64_t wrong = 0;  ///< samples of triangles
  std::uint64_t torn = 0;   ///< holes and doubles of meshes
  std::uint64_t may = 0;
};

Total judged(const std::string& subject, const char* rules, std::initializer_list<const char*> names) {
  RunPlan plan;
  plan.subjects = {subject};
  plan.rule_set = find_rule_set(rules);
  for (const char* name : names) plan.testcases.push_back({nullptr, find_generator(name)});
  plan.count = 1500;
  const auto results = run(plan, [](std::uint64_t) {});
  Total total;
  EXPECT_TRUE(results) << results.error().message;
  for (const RunResult& result : *results) {
    EXPECT_FALSE(result.trial.failure) << result.trial.failure->message;
    EXPECT_FALSE(result.trial.skipped) << *result.trial.skipped;
    const Outcome& outcome = result.trial.outcome;
    total.wrong += outcome.triangles.missing + outcome.triangles.unexpected;
    total.torn += outcome.meshes.missing + outcome.meshes.doubled;
    total.may += outcome.may;
  }
  return total;
}

// Either neighbour may be snapped to in Vulkan and OpenGL; Direct3D's 0.6 units do not reach that far.
TEST(RuleSets, ATruncatingSnapIsVulkansAndNotDirect3ds) {
  for (const char* set : {"vulkan", "opengl", "webgpu"}) {
    const Total total = judged("fault:snap-truncate", set, {"floats"});
    EXPECT_EQ(total.wrong, 0U) << set;
    EXPECT_GT(total.may, 0U) << set;
  }
  EXPECT_GT(judged("fault:snap-truncate", "d3d11", {"floats"}).wrong, 0U);
}

TEST(RuleSets, TiesMayGoEitherWayInDirect3d) {
  const Total total = judged("fault:snap-half-up", "d3d11", {"float_ties"});
  EXPECT_EQ(total.wrong, 0U);
  EXPECT_GT(total.may, 0U);
  EXPECT_GT(judged("fault:snap-half-up", "exact", {"float_ties"}).wrong, 0U);
}

// Which of two triangles has a sample on their common edge is open in Vulkan; that one has it, and one only, is not; in
// WebGPU nothing is said.
TEST(RuleSets, OnACommonEdgeExactlyOne) {
  for (const char* fault : {"fault:all-inclusive", "fault:all-exclusive"}) {
    const Total vulkan = judged(fault, "vulkan", {"fan", "grid"});
    EXPECT_EQ(vulkan.wrong, 0U) << fault;
    EXPECT_GT(vulkan.torn, 0U) << fault;
    const Total webgpu = judged(fault, "webgpu", {"fan", "grid"});
    EXPECT_EQ(webgpu.wrong + webgpu.torn, 0U) << fault;
    EXPECT_GT(webgpu.may, 0U) << fault;
    EXPECT_GT(judged(fault, "d3d11", {"fan", "grid"}).wrong, 0U) << fault;
  }
}

TEST(RuleSets, WhatNoSpecificationAllowsFailsUnderEach) {
  for (const RuleSet& set : kRuleSets) {
    EXPECT_GT(judged("fault:box-short-left", set.name.data(), {"random"}).wrong, 0U) << set.name;
    EXPECT_EQ(judged("edgecase", set.name.data(), {"random", "floats", "fan"}).wrong, 0U) << set.name;
  }
}

Scene quad(float right) {
  Scene scene;
  scene.setting.target = {4, 4};
  const Position a{0, 0}, b{right, 0}, c{right, 4}, d{0, 4};
  scene.triangles = {Triangle{a, b, c}, Triangle{a, c, d}};
  scene.meshes = {{0, 2}};
  return scene;
}

// The right side lies between two grid points around the centres of column 2: only these may be in or out.
TEST(MeshChoices, OpenIsWhatTheOutlineMayPass) {
  const RuleSet& vulkan = *find_rule_set("vulkan");
  const Scene passing = quad(2.5F + 0.25F / 256);
  const auto open = open_samples(passing, vulkan, {0, 2});
  ASSERT_TRUE(open);
  EXPECT_EQ(*open, (std::vector<std::uint64_t>{4, 4, 4, 4}));
  EXPECT_TRUE(open_samples(passing, kExactRules, {0, 2})->empty());
  EXPECT_TRUE(open_samples(quad(2.5F), vulkan, {0, 2})->empty()) << "on the grid nothing is open";
  EXPECT_TRUE(open_samples(passing, *find_rule_set("d3d11"), {0, 2})) << "far from a tie";
}

// A triangle a quarter of a unit high may turn over.
TEST(MeshChoices, NothingIsCertainIfATriangleMayTurnOver) {
  Scene scene = quad(4);
  const Position middle{2, 0.25F / 256};
  scene.triangles = {Triangle{Position{0, 0}, Position{4, 0.5F / 256}, middle},
                     Triangle{Position{0, 0}, middle, Position{4, 4}},
                     Triangle{middle, Position{4, 0.5F / 256}, Position{4, 4}}};
  EXPECT_FALSE(open_samples(scene, *find_rule_set("vulkan"), {0, 3}));
}

}  // namespace
}  // namespace edgecase::conformance
