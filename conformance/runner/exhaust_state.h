// How far an exhaustion has come, on disk: so that one that was killed goes on.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "conformance/runner/exhaust.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// JSON that names the plan and the device besides what has been found.
std::string exhaust_state(const ExhaustPlan& plan, std::string_view device, const Exhaustion& done);

/// What `file` says; nothing done if there is no such file. An error names file, field and value: if it is no state, if
/// it belongs to another plan, device or version, or if its numbers cannot be.
tl::expected<Exhaustion, Error> load_exhaust_state(const std::filesystem::path& file, const ExhaustPlan& plan,
                                                   std::string_view device);

}  // namespace edgecase::conformance
