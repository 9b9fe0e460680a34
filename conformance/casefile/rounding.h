// The snap roundings under the names they have in case files.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "conformance/scene/setting.h"

namespace edgecase::conformance {

inline constexpr auto kRoundingNames = std::to_array<std::pair<std::string_view, SnapRounding>>({
    {"nearest_even", SnapRounding::nearest_even},
    {"half_up", SnapRounding::half_up},
    {"half_away", SnapRounding::half_away},
    {"truncate", SnapRounding::truncate},
});

}  // namespace edgecase::conformance
