#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "conformance/casefile/casefile.h"
#include "conformance/casefile/cursor.h"
#include "conformance/casefile/geometry.h"
#include "conformance/casefile/json_tree.h"
#include "conformance/casefile/rounding.h"
#include "conformance/scene/nearest_name.h"

namespace edgecase::conformance {
namespace {

using Result = tl::expected<void, Error>;

/// A case while its fields are read one by one.
struct Draft {
  Case result;
  std::vector<Position> vertices;
};

Result read_sentence(const Cursor& at, std::string& to) {
  const auto text = at.string();
  if (!text) return tl::unexpected(text.error());
  if (text->empty()) return at.fault("is empty");
  to = *text;
  return {};
}

Result read_about(const Cursor& at, Draft& draft) { return read_sentence(at, draft.result.about); }
Result read_source(const Cursor& at, Draft& draft) { return read_sentence(at, draft.result.source); }

Result read_target(const Cursor& at, Draft& draft) {
  if (const auto ok = at.array("[width, height]", 2); !ok) return ok;
  const auto width = at[0].integer(1, kMaxTargetExtent);
  if (!width) return tl::unexpected(width.error());
  const auto height = at[1].integer(1, kMaxTargetExtent);
  if (!height) return tl::unexpected(height.error());
  draft.result.scene.setting.target = {static_cast<int>(*width), static_cast<int>(*height)};
  return {};
}

Result read_samples(const Cursor& at, Draft&) {
  if (at.node().kind != JsonNode::Kind::integer || at.node().integer != 1)
    return at.fault("is not a supported sample count; 1 is");
  return {};
}

Result read_subpixel_bits(const Cursor& at, Draft& draft) {
  const auto bits = at.integer(0, 16);
  if (!bits) return tl::unexpected(bits.error());
  draft.result.scene.rules.subpixel_bits = static_cast<int>(*bits);
  return {};
}

Result read_rounding(const Cursor& at, Draft& draft) {
  const auto name = at.string();
  if (!name) return tl::unexpected(name.error());
  for (const auto& [known, rounding] : kRoundingNames) {
    if (known != *name) continue;
    draft.result.scene.rules.rounding = rounding;
    return {};
  }
  return at.fault("is not nearest_even, half_up, half_away or truncate");
}

template <tl::expected<std::vector<Triangle>, Error> (*read)(const Cursor&)>
Result read_geometry(const Cursor& at, Draft& draft) {
  auto triangles = read(at);
  if (!triangles) return tl::unexpected(triangles.error());
  draft.result.scene.triangles = std::move(*triangles);
  return {};
}

Result read_vertices(const Cursor& at, Draft& draft) {
  auto vertices = read_positions(at, 3);
  if (!vertices) return tl::unexpected(vertices.error());
  draft.vertices = std::move(*vertices);
  return {};
}

Result read_triangle_indices(const Cursor& at, Draft& draft) {
  auto triangles = read_indices(at, draft.vertices);
  if (!triangles) return tl::unexpected(triangles.error());
  draft.result.scene.triangles = std::move(*triangles);
  return {};
}

Result read_meshes(const Cursor& at, Draft& draft) {
  auto meshes = read_watertight(at, draft.result.scene.triangles);
  if (!meshes) return tl::unexpected(meshes.error());
  draft.result.scene.meshes = std::move(*meshes);
  return {};
}

Result read_expect(const Cursor& at, Draft& draft) {
  const auto& scene = draft.result.scene;
  const auto height = static_cast<std::size_t>(scene.setting.target.height);
  const auto width = static_cast<std::size_t>(scene.setting.target.width);
  if (const auto ok = at.array("an array of strings, one for each row of the target"); !ok) return ok;
  if (at.size() != height) return at.remark(fmt::format("{} rows; the target is {} high", at.size(), height));
  Expectation expect;
  for (std::size_t y = 0; y < height; ++y) {
    const auto row = at[y].string();
    if (!row) return tl::unexpected(row.error());
    if (row->size() != width)
      return at[y].fault(fmt::format("has {} characters; the target is {} wide", row->size(), width));
    for (std::size_t x = 0; x < width; ++x) {
      const char c = (*row)[x];
      if (std::string_view(".#?0123456789").find(c) == std::string_view::npos)
        return at[y].fault(
            fmt::format("has '{}' in column {}; it takes '.', '#', '?' or a digit", printable({&c, 1}), x));
      const int count = c == '.' ? 0 : c == '#' ? 1 : c == '?' ? int{Expectation::kMay} : c - '0';
      if (count > 0 && static_cast<std::size_t>(count) > scene.triangles.size())
        return at[y].fault(
            fmt::format("asks for {} triangles in column {}; the scene has {}", count, x, scene.triangles.size()));
      expect.counts.push_back(static_cast<std::int8_t>(count));
    }
  }
  draft.result.expect = std::move(expect);
  return {};
}

enum class Need {
  required,
  optional,
  geometry,  ///< exactly one of these
};

struct Field {
  std::string_view name;
  Need need;
  Result (*read)(const Cursor&, Draft&);
};

/// Every field of a case file, in the order in which they are read: what a field's reader looks at stands above it.
constexpr auto kFields = std::to_array<Field>({
    {"about", Need::required, read_about},
    {"source", Need::required, read_source},
    {"target", Need::required, read_target},
    {"samples", Need::optional, read_samples},
    {"subpixel_bits", Need::optional, read_subpixel_bits},
    {"rounding", Need::optional, read_rounding},
    {"triangles", Need::geometry, read_geometry<read_triangles>},
    {"fan", Need::geometry, read_geometry<read_fan>},
    {"strip", Need::geometry, read_geometry<read_strip>},
    {"vertices", Need::optional, read_vertices},
    {"indices", Need::geometry, read_triangle_indices},
    {"watertight", Need::optional, read_meshes},
    {"expect", Need::optional, read_expect},
});

constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

std::size_t index_of(const Cursor& root, std::string_view name) {
  const auto& keys = root.node().keys;
  const auto found = std::find(keys.begin(), keys.end(), name);
  return found == keys.end() ? kAbsent : static_cast<std::size_t>(found - keys.begin());
}

Result check_names(const Cursor& root) {
  std::array<std::string_view, kFields.size()> names;
  std::transform(kFields.begin(), kFields.end(), names.begin(), [](const Field& field) { return field.name; });
  for (std::size_t i = 0; i < root.size(); ++i) {
    const std::string_view key = root.node().keys[i];
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    const auto meant = nearest_name(key, names);
    return root[i].remark(meant ? fmt::format("unknown field; did you mean {}?", *meant) : "unknown field");
  }
  return {};
}

/// Whether every required field is there, one geometry, and vertices if and only if indices are.
Result check_presence(const Cursor& root) {
  std::string_view geometry;
  for (const Field& field : kFields) {
    const std::size_t i = index_of(root, field.name);
    if (i == kAbsent && field.need == Need::required)
      return root.remark(fmt::format("{}: the field is missing", field.name));
    if (i == kAbsent || field.need != Need::geometry) continue;
    if (!geometry.empty())
      return root[i].remark(
          fmt::format("the case has {} already; it takes one of triangles, fan, strip, or vertices "
                      "with indices",
                      geometry));
    geometry = field.name;
  }
  const std::size_t vertices = index_of(root, "vertices");
  if (vertices != kAbsent && geometry != "indices")
    return root[vertices].remark("the field takes indices, and no triangles, fan or strip, beside it");
  if (vertices == kAbsent && geometry == "indices")
    return root[index_of(root, "indices")].remark("the field takes vertices beside it");
  if (geometry.empty())
    return root.remark("triangles: the field is missing, and so are fan, strip, and vertices with indices");
  return {};
}

}  // namespace

tl::expected<Case, Error> parse_case(std::string_view text, std::string path, std::string name) {
  const std::string file = printable(path, 4096);
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{}: the file is empty", file)});
  const auto tree = parse_json(text, file);
  if (!tree) return tl::unexpected(tree.error());
  const Cursor root(*tree, file);
  if (tree->kind != JsonNode::Kind::object) return root.fault("is not an object with the fields of a case");

  for (const auto check : {check_names, check_presence}) {
    if (const auto ok = check(root); !ok) return tl::unexpected(ok.error());
  }
  Draft draft;
  draft.result.path = std::move(path);
  draft.result.name = std::move(name);
  const std::size_t slash = draft.result.name.find('/');
  if (slash != std::string::npos) draft.result.category = draft.result.name.substr(0, slash);
  for (const Field& field : kFields) {
    const std::size_t i = index_of(root, field.name);
    if (i == kAbsent) continue;
    if (const auto ok = field.read(root[i], draft); !ok) return tl::unexpected(ok.error());
  }
  return std::move(draft.result);
}

}  // namespace edgecase::conformance
