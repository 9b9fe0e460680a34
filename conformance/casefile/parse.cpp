#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "conformance/casefile/casefile.h"
#include "conformance/casefile/draft.h"
#include "conformance/casefile/geometry.h"
#include "conformance/casefile/json_tree.h"
#include "conformance/casefile/names.h"
#include "conformance/scene/nearest_name.h"

namespace edgecase::conformance {
namespace {

FieldResult read_sentence(const Cursor& at, std::string& to) {
  const auto text = at.string();
  if (!text) return tl::unexpected(text.error());
  if (text->empty()) return at.fault("is empty");
  to = *text;
  return {};
}

FieldResult read_about(const Cursor& at, Draft& draft) { return read_sentence(at, draft.result.about); }
FieldResult read_source(const Cursor& at, Draft& draft) { return read_sentence(at, draft.result.source); }

template <tl::expected<std::vector<Triangle>, Error> (*read)(const Cursor&)>
FieldResult read_geometry(const Cursor& at, Draft& draft) {
  auto triangles = read(at);
  if (!triangles) return tl::unexpected(triangles.error());
  draft.result.scene.triangles = std::move(*triangles);
  return {};
}

FieldResult read_topology(const Cursor& at, Draft& draft) {
  const auto topology = at.choice(kTopologyNames);
  if (!topology) return tl::unexpected(topology.error());
  draft.topology = *topology;
  return {};
}

/// Makes triangles of the vertices and `indices`. A topology asks for the rasterizer to do so itself.
FieldResult assemble_scene(const Cursor& at, Draft& draft, std::vector<std::uint32_t> indices) {
  Assembly assembly{draft.topology.value_or(Topology::list), std::move(draft.vertices), std::move(indices)};
  auto triangles = read_assembled(at, assembly);
  if (!triangles) return tl::unexpected(triangles.error());
  draft.result.scene.triangles = std::move(*triangles);
  if (draft.topology) draft.result.scene.assembly = std::move(assembly);
  return {};
}

FieldResult read_vertices(const Cursor& at, Draft& draft) {
  auto vertices = read_positions(at, 3);
  if (!vertices) return tl::unexpected(vertices.error());
  draft.vertices = std::move(*vertices);
  if (draft.indexed) return {};
  return assemble_scene(at, draft, {});
}

FieldResult read_vertex_indices(const Cursor& at, Draft& draft) {
  const bool restarts = draft.topology.value_or(Topology::list) != Topology::list;
  auto indices = read_indices(at, draft.vertices.size(), restarts);
  if (!indices) return tl::unexpected(indices.error());
  return assemble_scene(at, draft, std::move(*indices));
}

FieldResult read_clip_viewport(const Cursor& at, Draft& draft) {
  const auto viewport = read_viewport(at);
  if (!viewport) return tl::unexpected(viewport.error());
  draft.viewport = *viewport;
  return {};
}

FieldResult read_clip(const Cursor& at, Draft& draft) {
  auto triangles = read_clip_triangles(at);
  if (!triangles) return tl::unexpected(triangles.error());
  const Extent target = draft.result.scene.setting.target;
  const Viewport whole{0, 0, static_cast<float>(target.width), static_cast<float>(target.height)};
  draft.result.scene.clip = {draft.viewport.value_or(whole), std::move(*triangles)};
  return {};
}

FieldResult read_meshes(const Cursor& at, Draft& draft) {
  if (draft.result.scene.setting.cull != CullMode::none)
    return at.remark("the field takes no culling beside it: culled triangles leave holes");
  auto meshes = read_watertight(at, draft.result.scene);
  if (!meshes) return tl::unexpected(meshes.error());
  draft.result.scene.meshes = std::move(*meshes);
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
  FieldResult (*read)(const Cursor&, Draft&);
};

/// Every field of a case file, in the order in which they are read: what a field's reader looks at stands above it.
constexpr auto kFields = std::to_array<Field>({
    {"about", Need::required, read_about},
    {"source", Need::required, read_source},
    {"target", Need::required, read_target},
    {"samples", Need::optional, read_samples},
    {"sample_positions", Need::optional, read_sample_positions},
    {"scissor", Need::optional, read_scissor},
    {"cull", Need::optional, read_cull},
    {"front_face", Need::optional, read_front_face},
    {"rules", Need::optional, read_rules},
    {"subpixel_bits", Need::optional, read_subpixel_bits},
    {"rounding", Need::optional, read_rounding},
    {"half_pixel_first", Need::optional, read_half_pixel_first},
    {"triangles", Need::geometry, read_geometry<read_triangles>},
    {"fan", Need::geometry, read_geometry<read_fan>},
    {"strip", Need::geometry, read_geometry<read_strip>},
    {"topology", Need::optional, read_topology},
    {"vertices", Need::geometry, read_vertices},
    {"indices", Need::optional, read_vertex_indices},
    {"viewport", Need::optional, read_clip_viewport},
    {"clip", Need::geometry, read_clip},
    {"watertight", Need::optional, read_meshes},
    {"expect", Need::optional, read_expect},
});

/// Fields that mean nothing without another.
constexpr auto kBeside = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"indices", "vertices"},
    {"topology", "vertices"},
    {"viewport", "clip"},
});

constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

std::size_t index_of(const Cursor& root, std::string_view name) {
  const auto& keys = root.node().keys;
  const auto found = std::find(keys.begin(), keys.end(), name);
  return found == keys.end() ? kAbsent : static_cast<std::size_t>(found - keys.begin());
}

FieldResult check_names(const Cursor& root) {
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

/// Whether every required field is there, one geometry, and beside each field those that it takes.
FieldResult check_presence(const Cursor& root) {
  std::string_view geometry;
  for (const Field& field : kFields) {
    const std::size_t i = index_of(root, field.name);
    if (i == kAbsent && field.need == Need::required)
      return root.remark(fmt::format("{}: the field is missing", field.name));
    if (i == kAbsent || field.need != Need::geometry) continue;
    if (!geometry.empty())
      return root[i].remark(
          fmt::format("the case has {} already; it takes one of triangles, fan, strip, vertices and clip", geometry));
    geometry = field.name;
  }
  for (const auto& [name, other] : kBeside) {
    const std::size_t i = index_of(root, name);
    if (i != kAbsent && geometry != other) return root[i].remark(fmt::format("the field takes {} beside it", other));
  }
  if (geometry.empty()) return root.remark("triangles: the field is missing, and so are fan, strip, vertices and clip");
  if (geometry == "vertices" && index_of(root, "indices") == kAbsent && index_of(root, "topology") == kAbsent)
    return root[index_of(root, "vertices")].remark("the field takes indices, topology or both beside it");
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
  draft.indexed = index_of(root, "indices") != kAbsent;
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
