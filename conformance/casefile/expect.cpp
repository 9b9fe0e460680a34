#include <fmt/format.h>

#include <optional>
#include <utility>

#include "conformance/casefile/draft.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/window_position.h"

namespace edgecase::conformance {
namespace {

/// The count that a character stands for; nothing if it stands for none.
std::optional<int> count_of(char c) {
  if (c == '.') return 0;
  if (c == '#') return 1;
  if (c == '?') return Expectation::kMay;
  if (c >= '0' && c <= '9') return c - '0';
  return std::nullopt;
}

/// Reads the rows of one sample. `triangles` of the scene are the most that a sample may ask for.
FieldResult read_rows(const Cursor& at, const MaskLayout& layout, int sample, std::size_t triangles,
                      Expectation& expect) {
  const auto height = static_cast<std::size_t>(layout.target.height);
  const auto width = static_cast<std::size_t>(layout.target.width);
  if (const auto ok = at.array("an array of strings, one for each row of the target"); !ok) return ok;
  if (at.size() != height) return at.remark(fmt::format("{} rows; the target is {} high", at.size(), height));
  for (std::size_t y = 0; y < height; ++y) {
    const auto row = at[y].string();
    if (!row) return tl::unexpected(row.error());
    if (row->size() != width)
      return at[y].fault(fmt::format("has {} characters; the target is {} wide", row->size(), width));
    for (std::size_t x = 0; x < width; ++x) {
      const char c = (*row)[x];
      const auto count = count_of(c);
      if (!count)
        return at[y].fault(
            fmt::format("has '{}' in column {}; it takes '.', '#', '?' or a digit", printable({&c, 1}), x));
      if (*count > 0 && static_cast<std::size_t>(*count) > triangles)
        return at[y].fault(fmt::format("asks for {} triangles in column {}; the scene has {}", *count, x, triangles));
      const std::size_t pixel = y * width + x;
      expect.counts[pixel * static_cast<std::size_t>(layout.samples) + static_cast<std::size_t>(sample)] =
          static_cast<std::int8_t>(*count);
    }
  }
  return {};
}

/// Which samples a clipped triangle covers depends on how the clipper rounds.
FieldResult check_not_clipped(const Cursor& at, const ClipGeometry& clip) {
  for (std::size_t i = 0; i < clip.triangles.size(); ++i) {
    if (behind_the_eye(clip.triangles[i])) continue;
    for (std::size_t v = 0; v < 3; ++v) {
      if (exact_window_position(clip.viewport, clip.triangles[i][v])) continue;
      return at.remark(
          fmt::format("clip[{}][{}] has no exact window position (inside the view volume, w a power of two, no "
                      "rounding; or every w below 0), and without that nothing can be expected",
                      i, v));
    }
  }
  return {};
}

}  // namespace

FieldResult read_expect(const Cursor& at, Draft& draft) {
  const Scene& scene = draft.result.scene;
  if (scene.clip) {
    if (const auto ok = check_not_clipped(at, *scene.clip); !ok) return ok;
  }
  const std::size_t triangles = scene.clip ? scene.clip->triangles.size() : scene.triangles.size();
  const MaskLayout layout(scene.setting);
  Expectation expect;
  expect.counts.resize(layout.sample_count());
  if (layout.samples == 1) {
    if (const auto ok = read_rows(at, layout, 0, triangles, expect); !ok) return ok;
  } else {
    if (const auto ok = at.array("an array with the rows of each sample"); !ok) return ok;
    if (at.size() != static_cast<std::size_t>(layout.samples))
      return at.remark(fmt::format("the rows of {} samples; the case has {}", at.size(), layout.samples));
    for (int sample = 0; sample < layout.samples; ++sample) {
      const auto ok = read_rows(at[static_cast<std::size_t>(sample)], layout, sample, triangles, expect);
      if (!ok) return ok;
    }
  }
  draft.result.expect = std::move(expect);
  return {};
}

}  // namespace edgecase::conformance
