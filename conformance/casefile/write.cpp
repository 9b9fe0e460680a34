#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/casefile/coordinate.h"
#include "conformance/casefile/rounding.h"

namespace edgecase::conformance {
namespace {

/// As a JSON string; what is not UTF-8 in it becomes the replacement character.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string written(const Triangle& triangle) {
  std::vector<std::string> positions;
  for (const Position& p : triangle)
    positions.push_back(fmt::format("[\"{}\", \"{}\"]", write_coordinate(p.x), write_coordinate(p.y)));
  return fmt::format("[{}]", fmt::join(positions, ", "));
}

std::string written(const Expectation& expect, std::size_t row, std::size_t width) {
  std::string text;
  for (std::size_t x = 0; x < width; ++x) {
    const int count = expect.counts[row * width + x];
    text += count == Expectation::kMay ? '?' : count == 0 ? '.' : count == 1 ? '#' : static_cast<char>('0' + count);
  }
  return fmt::format("\"{}\"", text);
}

/// One item per line.
std::string listed(const std::vector<std::string>& items) {
  return fmt::format("[\n    {}\n  ]", fmt::join(items, ",\n    "));
}

std::string written(const std::vector<Mesh>& meshes, std::size_t triangles) {
  if (meshes.size() == 1 && meshes[0] == Mesh{0, triangles}) return "true";
  std::vector<std::string> ranges;
  for (const Mesh& mesh : meshes) ranges.push_back(fmt::format("[{}, {}]", mesh.first, mesh.count));
  return fmt::format("[{}]", fmt::join(ranges, ", "));
}

}  // namespace

std::string write_case(const Case& value) {
  const Scene& scene = value.scene;
  const Extent target = scene.setting.target;
  std::vector<std::string> fields;
  const auto add = [&](std::string_view name, std::string_view text) {
    fields.push_back(fmt::format("  \"{}\": {}", name, text));
  };
  add("about", quoted(value.about));
  add("source", quoted(value.source));
  add("target", fmt::format("[{}, {}]", target.width, target.height));
  if (scene.rules.subpixel_bits != Rules{}.subpixel_bits)
    add("subpixel_bits", std::to_string(scene.rules.subpixel_bits));
  for (const auto& [name, rounding] : kRoundingNames) {
    if (rounding == scene.rules.rounding && rounding != Rules{}.rounding) add("rounding", fmt::format("\"{}\"", name));
  }
  std::vector<std::string> triangles;
  for (const Triangle& triangle : scene.triangles) triangles.push_back(written(triangle));
  add("triangles", listed(triangles));
  if (!scene.meshes.empty()) add("watertight", written(scene.meshes, scene.triangles.size()));
  if (value.expect) {
    std::vector<std::string> rows;
    for (std::size_t y = 0; y < static_cast<std::size_t>(target.height); ++y)
      rows.push_back(written(*value.expect, y, static_cast<std::size_t>(target.width)));
    add("expect", listed(rows));
  }
  return fmt::format("{{\n{}\n}}\n", fmt::join(fields, ",\n"));
}

}  // namespace edgecase::conformance
