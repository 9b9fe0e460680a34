// The geometry of a case file, from each of the forms it may be written in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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

/// [[x, y], ...]: the triangles that they make as a strip or a fan, see scene.h.
tl::expected<std::vector<Triangle>, Error> read_strip(const Cursor& at);
tl::expected<std::vector<Triangle>, Error> read_fan(const Cursor& at);

/// [a, b, c, ...] of `vertices` positions; where `restarts`, "restart" among them is kRestartIndex.
tl::expected<std::vector<std::uint32_t>, Error> read_indices(const Cursor& at, std::size_t vertices, bool restarts);

/// What `assembly` makes: at least one triangle, and of a list no vertex left over. `at` is where its vertices, or if
/// it has any its indices, were read.
tl::expected<std::vector<Triangle>, Error> read_assembled(const Cursor& at, const Assembly& assembly);

/// [x, y, width, height].
tl::expected<Viewport, Error> read_viewport(const Cursor& at);

/// [[[x, y, z, w], [x, y, z, w], [x, y, z, w]], ...].
tl::expected<std::vector<ClipTriangle>, Error> read_clip_triangles(const Cursor& at);

/// true: all triangles of `scene` are one mesh; [[first, count], ...]: these are.
tl::expected<std::vector<Mesh>, Error> read_watertight(const Cursor& at, const Scene& scene);

}  // namespace edgecase::conformance
