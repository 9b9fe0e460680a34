// The coverage pass on a Vulkan device.
#pragma once

#include <memory>
#include <tl/expected.hpp>

#include "conformance/subjects/driver.h"
#include "conformance/subjects/vulkan_device.h"

namespace edgecase::conformance {

/// One draw for all triangles in a render pass without attachments; the fragment shader notes gl_SampleMaskIn in a
/// storage buffer that holds one mask per triangle. With validation, any message of the layer fails the draw.
tl::expected<std::unique_ptr<Driver>, Error> open_vulkan_driver(const VulkanSelection& selection);

}  // namespace edgecase::conformance
