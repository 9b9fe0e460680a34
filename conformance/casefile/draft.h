// A case while its fields are read one by one, and the readers of groups of fields.
#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/casefile/casefile.h"
#include "conformance/casefile/cursor.h"

namespace edgecase::conformance {

struct Draft {
  Case result;
  /// Whether `samples` was given.
  bool counted_samples = false;
  /// Whether the case has `indices`: `vertices` then wait for them.
  bool indexed = false;
  std::optional<Topology> topology;
  std::vector<Position> vertices;
  std::optional<Viewport> viewport;
};

using FieldResult = tl::expected<void, Error>;

// Fields of Setting and Rules.
FieldResult read_target(const Cursor& at, Draft& draft);
FieldResult read_samples(const Cursor& at, Draft& draft);
FieldResult read_sample_positions(const Cursor& at, Draft& draft);
FieldResult read_scissor(const Cursor& at, Draft& draft);
FieldResult read_cull(const Cursor& at, Draft& draft);
FieldResult read_front_face(const Cursor& at, Draft& draft);
FieldResult read_rules(const Cursor& at, Draft& draft);
FieldResult read_subpixel_bits(const Cursor& at, Draft& draft);
FieldResult read_rounding(const Cursor& at, Draft& draft);
FieldResult read_half_pixel_first(const Cursor& at, Draft& draft);

/// Needs setting and geometry.
FieldResult read_expect(const Cursor& at, Draft& draft);

}  // namespace edgecase::conformance
