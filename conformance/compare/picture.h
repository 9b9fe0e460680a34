// Pictures of an exhibit, PNG and SVG from one cairo drawing.
#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "conformance/compare/exhibit.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// The bytes of the file. Shows the window of choose_window() enlarged: the pixels with their coordinates, the sample
/// points with their marks, the exact outlines of the snapped triangles, a legend, the caption, and, where the window
/// is not the whole target, an overview of where it lies. White ground; about 800 to 1,200 pixels wide at scale 1.
/// `scale` enlarges the PNG's pixels, not its content. Fails only where cairo does, for want of memory.
tl::expected<std::string, Error> render_png(const Exhibit& exhibit, double scale = 1);
tl::expected<std::string, Error> render_svg(const Exhibit& exhibit);

/// The same as a file, whole or not at all: see write_file_atomically().
tl::expected<void, Error> write_png(const Exhibit& exhibit, const std::filesystem::path& path, double scale = 1);
tl::expected<void, Error> write_svg(const Exhibit& exhibit, const std::filesystem::path& path);

}  // namespace edgecase::conformance
