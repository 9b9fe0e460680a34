// Window coordinates as text: exact in both directions.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace edgecase::conformance {

/// The binary32 number that `text` denotes exactly: decimal (`-1.5`, `2e-3`) or hexadecimal (`0x1.8p-1`).
/// Otherwise the rest of a sentence that begins with the text itself, as `is not finite`.
tl::expected<float, std::string> parse_coordinate(std::string_view text);

/// Text that parse_coordinate reads back as the same bits: decimal where that is short, else hexadecimal.
/// `value` is finite.
std::string write_coordinate(float value);

}  // namespace edgecase::conformance
