// The coverage pass on OSMesa.
#pragma once

#include <memory>
#include <tl/expected.hpp>

#include "conformance/subjects/driver.h"

namespace edgecase::conformance {

/// The same pass as Vulkan's: a framebuffer without attachments, one draw, masks in a storage buffer. OpenGL's rows are
/// read as rows with y down: its left and bottom rule in y-up coordinates is the top-left rule then.
/// `gallium`: "llvmpipe" or "softpipe", which GALLIUM_DRIVER has to name too; another one running is an Error.
tl::expected<std::unique_ptr<Driver>, Error> open_osmesa_driver(const std::string& gallium);

}  // namespace edgecase::conformance
