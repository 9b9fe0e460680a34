// Files that are either whole or not there.
#pragma once

#include <filesystem>
#include <string_view>
#include <tl/expected.hpp>

#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// Writes `bytes` to a temporary file beside `path` and renames it, so that whoever opens `path` finds the old content
/// or all of the new, also after a crash or on a full disk. Follows a symbolic link to the file it names; an existing
/// file keeps its mode. What is there and is no regular file (a pipe, a device) is written to directly: it has no half
/// to hide. So are /dev/stdout, /dev/stderr, /dev/fd/N and /proc/self/fd/N, through the open descriptor itself and
/// after flushing stdio, so that the bytes stand in order with what the program prints. Fails with one line that names
/// the file.
tl::expected<void, Error> write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace edgecase::conformance
