#include <fmt/format.h>

#include <limits>
#include <utility>

#include "conformance/casefile/draft.h"
#include "conformance/casefile/names.h"
#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

/// Stores an integer from `least` to `greatest`.
FieldResult store(const Cursor& at, std::int64_t least, std::int64_t greatest, int& to) {
  const auto value = at.integer(least, greatest);
  if (!value) return tl::unexpected(value.error());
  to = static_cast<int>(*value);
  return {};
}

template <class Choice, std::size_t N>
FieldResult store(const Cursor& at, const std::array<Named<Choice>, N>& names, Choice& to) {
  const auto choice = at.choice(names);
  if (!choice) return tl::unexpected(choice.error());
  to = *choice;
  return {};
}

}  // namespace

FieldResult read_target(const Cursor& at, Draft& draft) {
  if (const auto ok = at.array("[width, height]", 2); !ok) return ok;
  Extent& target = draft.result.scene.setting.target;
  if (const auto ok = store(at[0], 1, kMaxTargetExtent, target.width); !ok) return ok;
  return store(at[1], 1, kMaxTargetExtent, target.height);
}

FieldResult read_samples(const Cursor& at, Draft& draft) {
  const JsonNode& node = at.node();
  const bool small = node.kind == JsonNode::Kind::integer && node.integer >= 1 && node.integer <= 16;
  const auto locations = standard_sample_locations(small ? static_cast<int>(node.integer) : 0);
  if (locations.empty()) return at.fault("is not a standard sample count: 1, 2, 4, 8 or 16");
  draft.result.scene.setting.sample_locations.assign(locations.begin(), locations.end());
  draft.counted_samples = true;
  return {};
}

FieldResult read_sample_positions(const Cursor& at, Draft& draft) {
  if (const auto ok = at.array("an array of positions [x, y] in sixteenths of a pixel"); !ok) return ok;
  if (at.size() < 1 || at.size() > 16) return at.fault("positions; it takes 1 to 16");
  auto& locations = draft.result.scene.setting.sample_locations;
  if (draft.counted_samples && locations.size() != at.size())
    return at.fault(fmt::format("positions; samples says {}", locations.size()));
  locations.assign(at.size(), {});
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at[i];
    if (const auto ok = item.array("a position [x, y] in sixteenths of a pixel", 2); !ok) return ok;
    if (const auto ok = store(item[0], 0, 15, locations[i].x); !ok) return ok;
    if (const auto ok = store(item[1], 0, 15, locations[i].y); !ok) return ok;
  }
  return {};
}

FieldResult read_scissor(const Cursor& at, Draft& draft) {
  using Int = std::numeric_limits<int>;
  if (const auto ok = at.array("[x, y, width, height]", 4); !ok) return ok;
  Rect& scissor = draft.result.scene.setting.scissor.emplace();
  if (const auto ok = store(at[0], Int::min(), Int::max(), scissor.x); !ok) return ok;
  if (const auto ok = store(at[1], Int::min(), Int::max(), scissor.y); !ok) return ok;
  if (const auto ok = store(at[2], 0, Int::max(), scissor.width); !ok) return ok;
  return store(at[3], 0, Int::max(), scissor.height);
}

FieldResult read_cull(const Cursor& at, Draft& draft) { return store(at, kCullNames, draft.result.scene.setting.cull); }

FieldResult read_front_face(const Cursor& at, Draft& draft) {
  return store(at, kFrontFaceNames, draft.result.scene.setting.front_face);
}

FieldResult read_rules(const Cursor& at, Draft& draft) { return store(at, kRuleSetNames, draft.result.rule_set); }

FieldResult read_subpixel_bits(const Cursor& at, Draft& draft) {
  const RuleSet& set = *draft.result.rule_set;
  return store(at, set.least_subpixel_bits, set.most_subpixel_bits, draft.result.scene.rules.subpixel_bits);
}

FieldResult read_rounding(const Cursor& at, Draft& draft) {
  if (!draft.result.rule_set->exact()) return at.remark("the field takes no rules beside it that leave the snap open");
  return store(at, kRoundingNames, draft.result.scene.rules.rounding);
}

FieldResult read_half_pixel_first(const Cursor& at, Draft& draft) {
  if (!draft.result.rule_set->exact()) return at.remark("the field takes no rules beside it that leave the snap open");
  const auto half_first = at.boolean();
  if (!half_first) return tl::unexpected(half_first.error());
  // Half a pixel is on the grid only if that has a bit for it.
  if (*half_first && draft.result.scene.rules.subpixel_bits == 0) return at.fault("takes at least 1 subpixel bit");
  draft.result.scene.rules.half_pixel_first = *half_first;
  return {};
}

}  // namespace edgecase::conformance
