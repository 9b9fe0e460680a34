// The append functions of the generators; see their files for what each makes and why.
#pragma once

#include <cstddef>
#include <cstdint>

#include "conformance/generators/lattice.h"
#include "conformance/generators/random.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance::families {

using Append = void(const Lattice& lattice, Random& random, Scene& scene);

Append fan;
Append grid;
Append triangulation;
Append strip;
Append refinement;
Append uniform;
Append ties;
Append range;
Append far_corner;
Append near_corner;
Append sliver;
Append tiny;
Append sample_ties;
Append around_samples;
Append floats;
Append float_ties;
Append inside;
Append clip;
Append clip_far;
Append far_rectangle;
Append straddle;
Append needle;
Append spokes;
Append range_ends;
Append viewport_ends;
Append border_samples;
Append centres;
Append behind;
Append clip_fan;
Append clip_grid;
Append turned;
Append turned_across;
Append turned_beside_across;
Append strips;
Append fans;

/// As Generator::append_each.
using AppendEach = void(const Lattice& lattice, const Random& family, std::uint64_t first, std::size_t count,
                        Scene& scene);

AppendEach tiny_each;

}  // namespace edgecase::conformance::families
