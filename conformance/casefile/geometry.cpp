#include "conformance/casefile/geometry.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include "conformance/casefile/coordinate.h"

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

tl::expected<Triangle, Error> read_triangle(const Cursor& at) {
  if (const auto ok = at.array("a triangle of 3 positions", 3); !ok) return tl::unexpected(ok.error());
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto position = read_position(at[i]);
    if (!position) return tl::unexpected(position.error());
    triangle[i] = *position;
  }
  return triangle;
}

/// In a mesh as scene.h defines it, no two triangles run along the same edge in the same direction: two that are wound
/// the same way and do so lie on the same side of it. Triangles with two equal vertices cover nothing and are left out.
tl::expected<void, Error> check_mesh(const Cursor& at, const Mesh& mesh, std::span<const Triangle> triangles) {
  std::map<std::array<float, 4>, std::size_t> first_along;
  for (std::size_t i = mesh.first; i < mesh.first + mesh.count; ++i) {
    const auto& [a, b, c] = triangles[i];
    if (a == b || b == c || c == a) continue;
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      const auto [other, is_first] = first_along.try_emplace({from.x, from.y, to.x, to.y}, i);
      if (is_first) continue;
      return at.remark(fmt::format(
          "triangles {} and {} both run from [\"{}\", \"{}\"] to [\"{}\", \"{}\"]; they overlap or differ in winding",
          other->second, i, write_coordinate(from.x), write_coordinate(from.y), write_coordinate(to.x),
          write_coordinate(to.y)));
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
  if (const auto ok = at.array("an array of triangles"); !ok) return tl::unexpected(ok.error());
  if (at.size() == 0) return at.fault("triangles; a scene has at least one");
  std::vector<Triangle> triangles;
  triangles.reserve(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto triangle = read_triangle(at[i]);
    if (!triangle) return tl::unexpected(triangle.error());
    triangles.push_back(*triangle);
  }
  return triangles;
}

tl::expected<std::vector<Triangle>, Error> read_fan(const Cursor& at) {
  const auto v = read_positions(at, 3);
  if (!v) return tl::unexpected(v.error());
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < v->size(); ++i) triangles.push_back({v->front(), (*v)[i + 1], (*v)[i + 2]});
  return triangles;
}

tl::expected<std::vector<Triangle>, Error> read_strip(const Cursor& at) {
  const auto v = read_positions(at, 3);
  if (!v) return tl::unexpected(v.error());
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < v->size(); ++i) {
    triangles.push_back({(*v)[i], (*v)[i + 1], (*v)[i + 2]});
    if (i % 2 == 1) std::swap(triangles.back()[1], triangles.back()[2]);
  }
  return triangles;
}

tl::expected<std::vector<Triangle>, Error> read_indices(const Cursor& at, std::span<const Position> vertices) {
  if (const auto ok = at.array("an array of indices"); !ok) return tl::unexpected(ok.error());
  if (at.size() == 0 || at.size() % 3 != 0) return at.fault("indices; it takes three for each triangle");
  std::vector<Triangle> triangles;
  triangles.reserve(at.size() / 3);
  for (std::size_t i = 0; i < at.size(); i += 3) {
    Triangle triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto index = at[i + corner].integer(0, static_cast<std::int64_t>(vertices.size()) - 1);
      if (!index) return tl::unexpected(index.error());
      triangle[corner] = vertices[static_cast<std::size_t>(*index)];
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

tl::expected<std::vector<Mesh>, Error> read_watertight(const Cursor& at, std::span<const Triangle> triangles) {
  std::vector<Mesh> meshes;
  if (at.node().kind == JsonNode::Kind::boolean) {
    if (at.node().boolean) meshes.push_back({0, triangles.size()});
  } else {
    if (const auto ok = at.array("true, false or an array of ranges [first, count]"); !ok)
      return tl::unexpected(ok.error());
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto mesh = read_mesh(at[i], triangles.size());
      if (!mesh) return tl::unexpected(mesh.error());
      meshes.push_back(*mesh);
    }
  }
  for (const Mesh& mesh : meshes) {
    if (const auto ok = check_mesh(at, mesh, triangles); !ok) return tl::unexpected(ok.error());
  }
  return meshes;
}

}  // namespace edgecase::conformance
