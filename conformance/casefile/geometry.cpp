#include "conformance/casefile/geometry.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <map>
#include <string_view>
#include <utility>

#include "conformance/casefile/coordinate.h"
#include "conformance/casefile/names.h"
#include "conformance/scene/assemble.h"

namespace edgecase::conformance {
namespace {

tl::expected<Position, Error> read_position(const Cursor& at) {
  if (const auto ok = at.array("a position [x, y]", 2); !ok) return tl::unexpected(ok.error());
  const auto x = at[0].coordinate();
  if (!x) return tl::unexpected(x.error());
  const auto y = at[1].coordinate();
  if (!y) return tl::unexpected(y.error());
  return Position{*x, *y};
}

tl::expected<ClipPosition, Error> read_clip_position(const Cursor& at) {
  if (const auto ok = at.array("a position [x, y, z, w]", 4); !ok) return tl::unexpected(ok.error());
  std::array<float, 4> values;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto value = at[i].finite();
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  return ClipPosition{values[0], values[1], values[2], values[3]};
}

template <class Corners>
tl::expected<Corners, Error> read_corners(
    const Cursor& at, std::string_view what,
    tl::expected<typename Corners::value_type, Error> (*read_corner)(const Cursor&)) {
  if (const auto ok = at.array(what, 3); !ok) return tl::unexpected(ok.error());
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto corner = read_corner(at[i]);
    if (!corner) return tl::unexpected(corner.error());
    corners[i] = *corner;
  }
  return corners;
}

/// At least one triangle, each read by `read_one`.
template <class Item>
tl::expected<std::vector<Item>, Error> read_list(const Cursor& at, std::string_view what,
                                                 tl::expected<Item, Error> (*read_one)(const Cursor&)) {
  if (const auto ok = at.array(what); !ok) return tl::unexpected(ok.error());
  if (at.size() == 0) return at.fault("triangles; a scene has at least one");
  std::vector<Item> items;
  items.reserve(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto item = read_one(at[i]);
    if (!item) return tl::unexpected(item.error());
    items.push_back(*item);
  }
  return items;
}

tl::expected<std::vector<Triangle>, Error> read_plain(const Cursor& at, Topology topology) {
  auto vertices = read_positions(at, 3);
  if (!vertices) return tl::unexpected(vertices.error());
  return assemble({topology, std::move(*vertices), {}});
}

std::array<float, 2> coordinates_of(const Position& p) { return {p.x, p.y}; }
std::array<float, 4> coordinates_of(const ClipPosition& p) { return {p.x, p.y, p.z, p.w}; }

std::string listed(std::span<const float> coordinates) {
  std::string text;
  for (const float v : coordinates) text += fmt::format("{}\"{}\"", text.empty() ? "[" : ", ", write_coordinate(v));
  return text + "]";
}

/// In a mesh as scene.h defines it, no two triangles run along the same edge in the same direction: two that are wound
/// the same way and do so lie on the same side of it. Triangles with two equal vertices cover nothing and are left out.
template <typename AnyTriangle>
tl::expected<void, Error> check_mesh(const Cursor& at, const Mesh& mesh, std::span<const AnyTriangle> triangles) {
  using Coordinates = decltype(coordinates_of(triangles[0][0]));
  std::map<std::pair<Coordinates, Coordinates>, std::size_t> first_along;
  for (std::size_t i = mesh.first; i < mesh.first + mesh.count; ++i) {
    const auto& [a, b, c] = triangles[i];
    if (a == b || b == c || c == a) continue;
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      const auto [other, is_first] = first_along.try_emplace({coordinates_of(from), coordinates_of(to)}, i);
      if (is_first) continue;
      return at.remark(fmt::format("triangles {} and {} both run from {} to {}; they overlap or differ in winding",
                                   other->second, i, listed(coordinates_of(from)), listed(coordinates_of(to))));
    }
  }
  return {};
}

tl::expected<Mesh, Error> read_mesh(const Cursor& at, std::size_t triangles) {
  if (const auto ok = at.array("a range of triangles [first, count]", 2); !ok) return tl::unexpected(ok.error());
  const auto first = at[0].integer(0, static_cast<std::int64_t>(triangles) - 1);
  if (!first) return tl::unexpected(first.error());
  const auto count = at[1].integer(1, static_cast<std::int64_t>(triangles) - *first);
  if (!count) return tl::unexpected(count.error());
  return Mesh{static_cast<std::size_t>(*first), static_cast<std::size_t>(*count)};
}

}  // namespace

tl::expected<std::vector<Position>, Error> read_positions(const Cursor& at, std::size_t least) {
  if (const auto ok = at.array("an array of positions [x, y]"); !ok) return tl::unexpected(ok.error());
  if (at.size() < least) return at.fault(fmt::format("positions; it takes at least {}", least));
  std::vector<Position> positions;
  positions.reserve(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto position = read_position(at[i]);
    if (!position) return tl::unexpected(position.error());
    positions.push_back(*position);
  }
  return positions;
}

tl::expected<std::vector<Triangle>, Error> read_triangles(const Cursor& at) {
  return read_list<Triangle>(at, "an array of triangles", [](const Cursor& item) {
    return read_corners<Triangle>(item, "a triangle of 3 positions", read_position);
  });
}

tl::expected<std::vector<Triangle>, Error> read_strip(const Cursor& at) { return read_plain(at, Topology::strip); }
tl::expected<std::vector<Triangle>, Error> read_fan(const Cursor& at) { return read_plain(at, Topology::fan); }

tl::expected<std::vector<std::uint32_t>, Error> read_indices(const Cursor& at, std::size_t vertices, bool restarts) {
  if (const auto ok = at.array("an array of indices"); !ok) return tl::unexpected(ok.error());
  if (at.size() == 0) return at.fault("indices; they make no triangle");
  std::vector<std::uint32_t> indices;
  indices.reserve(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const JsonNode& item = at[i].node();
    if (item.kind == JsonNode::Kind::string && item.text == kRestartName) {
      if (!restarts) return at[i].fault("takes a topology of strip or fan beside it");
      indices.push_back(kRestartIndex);
      continue;
    }
    const auto index = at[i].integer(0, static_cast<std::int64_t>(vertices) - 1);
    if (!index) return tl::unexpected(index.error());
    indices.push_back(static_cast<std::uint32_t>(*index));
  }
  return indices;
}

tl::expected<std::vector<Triangle>, Error> read_assembled(const Cursor& at, const Assembly& assembly) {
  const char* what = assembly.indices.empty() ? "positions" : "indices";
  if (assembly.topology == Topology::list && at.size() % 3 != 0)
    return at.fault(fmt::format("{}; it takes three for each triangle", what));
  auto triangles = assemble(assembly);
  if (triangles.empty()) return at.fault(fmt::format("{}; they make no triangle", what));
  return triangles;
}

tl::expected<Viewport, Error> read_viewport(const Cursor& at) {
  if (const auto ok = at.array("[x, y, width, height]", 4); !ok) return tl::unexpected(ok.error());
  std::array<float, 4> values;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto value = at[i].coordinate();
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  if (!(values[2] > 0)) return at[2].fault("is not above 0");
  if (values[3] == 0) return at[3].fault("is 0");
  return Viewport{values[0], values[1], values[2], values[3]};
}

tl::expected<std::vector<ClipTriangle>, Error> read_clip_triangles(const Cursor& at) {
  return read_list<ClipTriangle>(at, "an array of triangles", [](const Cursor& item) {
    return read_corners<ClipTriangle>(item, "a triangle of 3 positions [x, y, z, w]", read_clip_position);
  });
}

tl::expected<std::vector<Mesh>, Error> read_watertight(const Cursor& at, const Scene& scene) {
  std::vector<Mesh> meshes;
  const std::size_t triangles = triangle_count(scene);
  if (at.node().kind == JsonNode::Kind::boolean) {
    if (at.node().boolean) meshes.push_back({0, triangles});
  } else {
    if (const auto ok = at.array("true, false or an array of ranges [first, count]"); !ok)
      return tl::unexpected(ok.error());
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto mesh = read_mesh(at[i], triangles);
      if (!mesh) return tl::unexpected(mesh.error());
      meshes.push_back(*mesh);
    }
  }
  for (const Mesh& mesh : meshes) {
    const auto ok = scene.clip ? check_mesh(at, mesh, std::span<const ClipTriangle>(scene.clip->triangles))
                               : check_mesh(at, mesh, std::span<const Triangle>(scene.triangles));
    if (!ok) return tl::unexpected(ok.error());
  }
  return meshes;
}

}  // namespace edgecase::conformance
