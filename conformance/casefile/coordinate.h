// Binary32 numbers as text: exact in both directions.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace edgecase::conformance {

/// The binary32 number that `text` denotes exactly: decimal (`-1.5`, `2e-3`) or hexadecimal (`0x1.8p-1`).
/// Otherwise the rest of a sentence that begins with the text itself, as `is not finite`.
/// Window coordinates lie from -kMaxCaseCoordinate to +kMaxCaseCoordinate.
tl::expected<float, std::string> parse_coordinate(std::string_view text);

/// The same for any finite binary32 number.
tl::expected<float, std::string> parse_finite(std::string_view text);

/// Text that parse_finite, and parse_coordinate if it is in range, read back as the same bits: decimal where that is
/// short, else hexadecimal. `value` is finite.
std::string write_coordinate(float value);

}  // namespace edgecase::conformance
