// An exhaustion as a page, with a picture of what is wrong first.
#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "conformance/runner/exhaust.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// Writes index.html into `folder`, and if anything is wrong, picture and case file of the first triangle that is,
/// which is drawn once more for that.
tl::expected<void, Error> write_exhaust_report(const std::filesystem::path& folder, const ExhaustPlan& plan,
                                               const std::string& device, const Exhaustion& found);

}  // namespace edgecase::conformance
