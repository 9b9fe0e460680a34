#include "conformance/compare/exhibit.h"

#include <algorithm>

#include "conformance/compare/row_bits.h"

namespace edgecase::conformance {
namespace {

int layers(const MaskBatch& masks, std::size_t bit) {
  int sum = 0;
  for (std::size_t i = 0; i < masks.size(); ++i) sum += covered(masks[i], bit) ? 1 : 0;
  return sum;
}

/// A growing rectangle of pixels, last row and column included.
struct Box {
  int x0, y0, x1, y1;
  void add(int x, int y) {
    x0 = std::min(x0, x);
    y0 = std::min(y0, y);
    x1 = std::max(x1, x);
    y1 = std::max(y1, y);
  }
};

constexpr int kMargin = 1;

struct Size {
  int width;
  int height;
};

/// The largest window that is shown because everything fits into it, and the smaller one that is cut out otherwise, so
/// that its pixels stay large.
struct Limits {
  Size whole;
  Size cut;
};

Limits window_limits(int samples) {
  if (samples == 1) return {{48, 32}, {30, 25}};
  return samples <= 4 ? Limits{{24, 16}, {18, 15}} : Limits{{14, 10}, {12, 10}};
}

/// Adds every sample that some mask of one batch covers and the other does not.
void add_differences(const Exhibit& exhibit, Box& box) {
  const MaskLayout layout(exhibit.scene.setting);
  for (std::size_t i = 0; i < exhibit.observed.size(); ++i) {
    for (std::size_t word = 0; word < layout.words(); ++word) {
      const std::uint64_t open = exhibit.may.size() == 0 ? 0 : exhibit.may[i][word] & ~exhibit.must[i][word];
      std::uint64_t wrong =
          (exhibit.must[i][word] ^ exhibit.observed[i][word]) & ~open & sample_bits(layout, word % layout.row_words());
      for (; wrong != 0; wrong &= wrong - 1) {
        const SampleIndex at = sample_index(layout, word * 64 + static_cast<std::size_t>(std::countr_zero(wrong)));
        box.add(at.x, at.y);
      }
    }
  }
}

/// Moves a stretch of `length` cells so that it is centred on `centre` as far as 0 .. limit - 1 allows.
int centred(int centre, int length, int limit) { return std::clamp(centre - length / 2, 0, limit - length); }

}  // namespace

SampleState sample_state(const Exhibit& exhibit, int x, int y, int sample) {
  const std::size_t bit = MaskLayout(exhibit.scene.setting).bit(x, y, sample);
  const int must = layers(exhibit.must, bit);
  int open = 0;
  for (std::size_t i = 0; i < exhibit.may.size(); ++i) {
    open += covered(exhibit.may[i], bit) && !covered(exhibit.must[i], bit) ? 1 : 0;
  }
  const int observed = exhibit.observed.size() == 0 ? must : layers(exhibit.observed, bit);
  const auto mark = [&] {
    if (observed < must) return Mark::missing;
    // On a shared edge that the rules leave open, either triangle may cover a sample, but not both.
    const int allowed = must == 0 && open > 0 ? 1 : must;
    if (observed > allowed) return allowed == 0 ? Mark::unexpected : Mark::doubled;
    if (must == 0 && open > 0) return observed == 0 ? Mark::open_empty : Mark::open_covered;
    return must == 0 ? Mark::empty : Mark::covered;
  };
  return {mark(), observed};
}

Window choose_window(const Exhibit& exhibit) {
  const Extent& target = exhibit.scene.setting.target;
  const auto pixel = [&](std::int64_t coordinate, int limit) {
    const std::int64_t floor = coordinate >> exhibit.scene.rules.subpixel_bits;
    return static_cast<int>(std::clamp<std::int64_t>(floor, 0, limit - 1));
  };
  Box box{target.width, target.height, -1, -1};
  for (const GridTriangle& triangle : exhibit.snapped) {
    for (const GridPoint& p : triangle) box.add(pixel(p.x, target.width), pixel(p.y, target.height));
  }
  add_differences(exhibit, box);
  if (exhibit.wrong) box.add(exhibit.wrong->x, exhibit.wrong->y);
  if (box.x1 < 0) box.add(target.width / 2, target.height / 2);

  const auto [whole, cut] = window_limits(exhibit.scene.setting.samples());
  const int focus_x = exhibit.wrong ? exhibit.wrong->x : (box.x0 + box.x1) / 2;
  const int focus_y = exhibit.wrong ? exhibit.wrong->y : (box.y0 + box.y1) / 2;
  struct Stretch {
    int begin;
    int length;
  };
  const auto stretch = [](int low, int high, int focus, int limit, int smallest, int greatest,
                          int otherwise) -> Stretch {
    const int wanted = high - low + 1 + 2 * kMargin;
    // Most of a small target is shown as all of it.
    if (limit <= greatest && 3 * wanted >= 2 * limit) return {0, limit};
    const bool fits = wanted <= greatest;
    const int length = std::min(fits ? std::max(wanted, smallest) : otherwise, limit);
    return {centred(fits ? (low + high + 1) / 2 : focus, length, limit), length};
  };
  const Stretch columns = stretch(box.x0, box.x1, focus_x, target.width, 12, whole.width, cut.width);
  const Stretch rows = stretch(box.y0, box.y1, focus_y, target.height, 8, whole.height, cut.height);
  return {columns.begin, rows.begin, columns.length, rows.length};
}

std::array<int, kMarks> count_marks(const Exhibit& exhibit, const Window& window) {
  std::array<int, kMarks> counts{};
  for (int y = window.y; y < window.y + window.height; ++y) {
    for (int x = window.x; x < window.x + window.width; ++x) {
      for (int s = 0; s < exhibit.scene.setting.samples(); ++s) {
        ++counts[static_cast<std::size_t>(sample_state(exhibit, x, y, s).mark)];
      }
    }
  }
  return counts;
}

}  // namespace edgecase::conformance
