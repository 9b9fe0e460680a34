// The worker's side: a driver, served over the connection that the program left on kWorkerSocket and kWorkerMemory.
#pragma once

#include <functional>
#include <memory>
#include <tl/expected.hpp>

#include "conformance/subjects/driver.h"

namespace edgecase::conformance {

/// Opens the driver, tells the program how that went, and then draws what it is asked to until the program closes the
/// connection or dies; the process ends with it, whatever the driver is doing then. Never returns.
[[noreturn]] void serve_driver(const std::function<tl::expected<std::unique_ptr<Driver>, Error>()>& open);

}  // namespace edgecase::conformance
