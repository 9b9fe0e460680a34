// The subjects that are graphics drivers: lavapipe, lavapipe:bgra8, osmesa-llvmpipe, osmesa-softpipe,
// swiftshader, vulkan:DEVICE-OR-ICD.
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// Starts the program `edgecase-worker`, which is looked for beside the running program and then where it was built,
/// with the environment that the driver needs. `vulkan:` is followed by part of a device's or driver's name, or by an
/// ICD file: a path, or the name of a .json file in one of the loader's folders. The environment variable
/// EDGECASE_VALIDATION=1 switches Vulkan's validation layer on; every message of it is an Error then.
/// EDGECASE_COPY_MASKS=1 keeps Vulkan drivers from drawing into the memory that the processes share.
tl::expected<std::unique_ptr<Subject>, Error> make_driver_subject(const std::string& name);

}  // namespace edgecase::conformance
