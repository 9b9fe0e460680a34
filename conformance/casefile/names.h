// Choices under the names they have in case files.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

template <class Choice>
using Named = std::pair<std::string_view, Choice>;

inline constexpr auto kRoundingNames = std::to_array<Named<SnapRounding>>({
    {"nearest_even", SnapRounding::nearest_even},
    {"half_up", SnapRounding::half_up},
    {"half_away", SnapRounding::half_away},
    {"truncate", SnapRounding::truncate},
});

inline constexpr auto kRuleSetNames = [] {
  std::array<Named<const RuleSet*>, kRuleSets.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = {kRuleSets[i].name, &kRuleSets[i]};
  return names;
}();

inline constexpr auto kCullNames = std::to_array<Named<CullMode>>({
    {"none", CullMode::none},
    {"front", CullMode::front},
    {"back", CullMode::back},
});

inline constexpr auto kFrontFaceNames = std::to_array<Named<FrontFace>>({
    {"clockwise", FrontFace::clockwise},
    {"counter_clockwise", FrontFace::counter_clockwise},
});

inline constexpr auto kTopologyNames = std::to_array<Named<Topology>>({
    {"list", Topology::list},
    {"strip", Topology::strip},
    {"fan", Topology::fan},
});

/// Stands for kRestartIndex among indices.
inline constexpr std::string_view kRestartName = "restart";

template <class Choice, std::size_t N>
std::string_view name_of(const std::array<Named<Choice>, N>& names, Choice choice) {
  for (const auto& [name, known] : names) {
    if (known == choice) return name;
  }
  return "";
}

}  // namespace edgecase::conformance
