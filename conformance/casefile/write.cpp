#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/casefile/coordinate.h"
#include "conformance/casefile/names.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

/// As a JSON string; what is not UTF-8 in it becomes the replacement character.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

template <class Items, class Write>
std::vector<std::string> all_written(const Items& items, Write write) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(write(item));
  return texts;
}

template <class Items, class Write>
std::string bracketed(const Items& items, Write write) {
  return fmt::format("[{}]", fmt::join(all_written(items, write), ", "));
}

std::string written(std::initializer_list<float> numbers) {
  return bracketed(numbers, [](float number) { return fmt::format("\"{}\"", write_coordinate(number)); });
}

std::string written(const Position& p) { return written({p.x, p.y}); }
std::string written(const ClipPosition& p) { return written({p.x, p.y, p.z, p.w}); }
std::string written(const SampleLocation& location) { return fmt::format("[{}, {}]", location.x, location.y); }

template <class Corner>
std::string written(const std::array<Corner, 3>& triangle) {
  return bracketed(triangle, [](const Corner& corner) { return written(corner); });
}

std::string written_index(std::uint32_t index) {
  return index == kRestartIndex ? fmt::format("\"{}\"", kRestartName) : std::to_string(index);
}

/// One row of one sample.
std::string written(const Expectation& expect, const MaskLayout& layout, int row, int sample) {
  const auto width = static_cast<std::size_t>(layout.target.width);
  const auto samples = static_cast<std::size_t>(layout.samples);
  std::string text;
  for (std::size_t x = 0; x < width; ++x) {
    const std::size_t pixel = static_cast<std::size_t>(row) * width + x;
    const int count = expect.counts[pixel * samples + static_cast<std::size_t>(sample)];
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

class Fields {
 public:
  void add(std::string_view name, std::string_view text) { fields_.push_back(fmt::format("  \"{}\": {}", name, text)); }
  void add_name(std::string_view name, std::string_view choice) { add(name, fmt::format("\"{}\"", choice)); }
  std::string text() const { return fmt::format("{{\n{}\n}}\n", fmt::join(fields_, ",\n")); }

 private:
  std::vector<std::string> fields_;
};

void add_setting(const Setting& setting, Fields& fields) {
  fields.add("target", fmt::format("[{}, {}]", setting.target.width, setting.target.height));
  if (!has_standard_samples(setting)) {
    const auto location = [](const SampleLocation& at) { return written(at); };
    fields.add("sample_positions", bracketed(setting.sample_locations, location));
  } else if (setting.samples() != 1) {
    fields.add("samples", std::to_string(setting.samples()));
  }
  if (const auto& s = setting.scissor)
    fields.add("scissor", fmt::format("[{}, {}, {}, {}]", s->x, s->y, s->width, s->height));
  if (setting.cull != Setting{}.cull) fields.add_name("cull", name_of(kCullNames, setting.cull));
  if (setting.front_face != Setting{}.front_face)
    fields.add_name("front_face", name_of(kFrontFaceNames, setting.front_face));
}

void add_rules(const Rules& rules, Fields& fields) {
  if (rules.subpixel_bits != Rules{}.subpixel_bits) fields.add("subpixel_bits", std::to_string(rules.subpixel_bits));
  if (rules.rounding != Rules{}.rounding) fields.add_name("rounding", name_of(kRoundingNames, rules.rounding));
  if (rules.half_pixel_first) fields.add("half_pixel_first", "true");
}

void add_geometry(const Scene& scene, Fields& fields) {
  const auto each = [](const auto& item) { return written(item); };
  if (const auto& clip = scene.clip) {
    const Viewport& v = clip->viewport;
    fields.add("viewport", written({v.x, v.y, v.width, v.height}));
    fields.add("clip", listed(all_written(clip->triangles, each)));
  } else if (const auto& assembly = scene.assembly) {
    fields.add_name("topology", name_of(kTopologyNames, assembly->topology));
    fields.add("vertices", listed(all_written(assembly->vertices, each)));
    if (!assembly->indices.empty()) fields.add("indices", bracketed(assembly->indices, written_index));
  } else {
    fields.add("triangles", listed(all_written(scene.triangles, each)));
  }
  if (!scene.meshes.empty()) fields.add("watertight", written(scene.meshes, triangle_count(scene)));
}

std::string written(const Expectation& expect, const Setting& setting) {
  const MaskLayout layout(setting);
  std::vector<std::string> samples;
  for (int sample = 0; sample < layout.samples; ++sample) {
    std::vector<std::string> rows;
    for (int row = 0; row < layout.target.height; ++row) rows.push_back(written(expect, layout, row, sample));
    if (layout.samples == 1) return listed(rows);
    samples.push_back(fmt::format("[{}]", fmt::join(rows, ", ")));
  }
  return listed(samples);
}

}  // namespace

std::string write_case(const Case& value) {
  Fields fields;
  fields.add("about", quoted(value.about));
  fields.add("source", quoted(value.source));
  add_setting(value.scene.setting, fields);
  if (!value.rule_set->exact()) fields.add_name("rules", value.rule_set->name);
  add_rules(value.scene.rules, fields);
  add_geometry(value.scene, fields);
  if (value.expect) fields.add("expect", written(*value.expect, value.scene.setting));
  return fields.text();
}

}  // namespace edgecase::conformance
