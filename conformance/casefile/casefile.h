// Case files: one JSON file, one scene, and what has to be covered. cases/README.md documents every field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// Window coordinates of a case file lie from -kMaxCaseCoordinate to +kMaxCaseCoordinate pixels, ends included.
inline constexpr float kMaxCaseCoordinate = 32768;

/// A larger file is refused before it is read.
inline constexpr std::size_t kMaxCaseBytes = std::size_t{8} << 20;

/// How many triangles of the scene cover each sample. Of a scene in clip space there is an expectation only if it has
/// exact_window_triangles, see scene/window_position.h.
struct Expectation {
  /// For a sample that the specification leaves open.
  static constexpr std::int8_t kMay = -1;

  /// One entry per sample, each kMay or 0 to 9: rows top to bottom, in them pixels left to right, in them the samples.
  std::vector<std::int8_t> counts;
  friend bool operator==(const Expectation&, const Expectation&) = default;
};

struct Case {
  /// The file as it was named to load_case, or whatever parse_case was given to stand in messages.
  std::string path;
  /// Path relative to the cases folder, with slashes and without .json: `fill_rule/rectangle_on_centres`.
  std::string name;
  /// The first folder of `name`; empty for a file that lies in none.
  std::string category;
  /// What the case shows, in one sentence.
  std::string about;
  /// Where the rule stands, or where this broke a rasterizer.
  std::string source;
  Scene scene;
  /// What the scene is judged by, and what `expect` says: under a set that leaves something open kMay is exactly that,
  /// and the other counts are those of triangles that have to cover a sample.
  const RuleSet* rule_set = &kExactRules;
  std::optional<Expectation> expect;
};

/// Reads one case file. The error is one line, `FILE:LINE: FIELD: VALUE ...`, where there is a line and a field;
/// for text that is not JSON it is `FILE:LINE:COLUMN: ...`.
/// `root` is the cases folder that the name is relative to; a file outside it is named by its own path, without
/// category.
tl::expected<Case, Error> load_case(const std::filesystem::path& file, const std::filesystem::path& root);

/// The same from memory; `path` stands in the messages.
tl::expected<Case, Error> parse_case(std::string_view text, std::string path, std::string name);

/// The text of a case file that parse_case reads back as the same about, source, scene and expectation, bit for bit.
/// Needs a scene that a case file can hold: at least one triangle, 1 to 16 samples on the sixteenths, coordinates in
/// range, a scissor of no negative size, no mesh beside culling, an expectation of the target's size, of a clipped
/// scene none, and UTF-8 in about and source, neither of them empty.
std::string write_case(const Case& value);

/// Every .json file below `root` in the order of their paths, byte by byte; names that begin with a dot are passed
/// over.
tl::expected<std::vector<std::filesystem::path>, Error> find_cases(const std::filesystem::path& root);

}  // namespace edgecase::conformance
