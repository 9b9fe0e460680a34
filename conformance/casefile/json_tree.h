// JSON text as a tree that knows its lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"

namespace edgecase::conformance {

struct JsonNode {
  enum class Kind { null, boolean, integer, real, string, array, object };

  Kind kind = Kind::null;
  int line = 0;  ///< the first line is 1
  bool boolean = false;
  std::int64_t integer = 0;
  /// A string's characters (valid UTF-8), or a `real` as it was written; integers beyond 64 bits are `real`.
  std::string text;
  /// keys[i] names children[i]; keys of arrays stay empty.
  std::vector<std::string> keys;
  std::vector<JsonNode> children;
};

/// Arrays and objects inside one another, the outermost counted.
inline constexpr std::size_t kMaxJsonDepth = 16;

/// Standard JSON, and comments (`//` and `/* */`). Duplicate keys and deeper nesting than kMaxJsonDepth are errors.
/// `path` begins the error's line; it is printable.
tl::expected<JsonNode, Error> parse_json(std::string_view text, std::string_view path);

/// At most `longest` bytes of `text`, on one line: control characters as \xNN, a longer text cut and ended by `...`.
std::string printable(std::string_view text, std::size_t longest = 60);

}  // namespace edgecase::conformance
