// The words and numbers under a picture, the same for pixels and for characters.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "conformance/compare/exhibit.h"

namespace edgecase::conformance {

/// `value` / 2^bits as an exact decimal without trailing zeros; bits from 0 to 16.
std::string exact_decimal(std::int64_t value, int bits);

struct EdgeRow {
  std::string edge;   ///< "v0 -> v1"
  std::string value;  ///< with its sign, and groups of three digits
  std::string side;   ///< "top", "left" or "-"
};

struct Caption {
  std::string setting;                  ///< target, samples, subpixel bits and rounding
  std::string verdict;                  ///< "missing at pixel (12, 7), sample 0"; empty if nothing is wrong
  std::string meaning;                  ///< what the rules and the subject say of it
  std::string location;                 ///< where that sample lies, in pixels
  std::string triangle;                 ///< which triangle the vertices and edges are of
  std::array<std::string, 3> vertices;  ///< "v0 (1.5, 2)", snapped; empty without an explanation or a single triangle
  std::vector<EdgeRow> edges;           ///< empty without an explanation
  std::string edge_unit;                ///< what the values of the edges mean
  std::string reason;                   ///< why the rules decide so; empty without an explanation
};

Caption make_caption(const Exhibit& exhibit);

}  // namespace edgecase::conformance
