// The triangles of a case file, from each of the forms they may be written in.
#pragma once

#include <span>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/casefile/cursor.h"
#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// [[x, y], ...]: at least `least` of them.
tl::expected<std::vector<Position>, Error> read_positions(const Cursor& at, std::size_t least);

/// [[[x, y], [x, y], [x, y]], ...].
tl::expected<std::vector<Triangle>, Error> read_triangles(const Cursor& at);

/// Centre, then rim: triangle i is (v0, v[i+1], v[i+2]). A closed fan repeats its first rim vertex at the end.
tl::expected<std::vector<Triangle>, Error> read_fan(const Cursor& at);

/// Triangle i is (v[i], v[i+1], v[i+2]), every odd one with its last two swapped so that all are wound the same way.
tl::expected<std::vector<Triangle>, Error> read_strip(const Cursor& at);

/// [a, b, c, a, b, c, ...] into `vertices`.
tl::expected<std::vector<Triangle>, Error> read_indices(const Cursor& at, std::span<const Position> vertices);

/// true: all of the `count` triangles are one mesh; [[first, count], ...]: these are.
tl::expected<std::vector<Mesh>, Error> read_watertight(const Cursor& at, std::span<const Triangle> triangles);

}  // namespace edgecase::conformance
