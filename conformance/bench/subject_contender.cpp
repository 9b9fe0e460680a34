#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "conformance/bench/contender.h"

namespace edgecase::conformance {
namespace {

constexpr std::size_t kMostTriangles = 20'000;
/// Of the masks of one draw.
constexpr std::size_t kMostBytes = std::size_t{64} << 20;

struct Offset {
  int x = 0;
  int y = 0;
};

struct Span {
  int first;
  int end;
};

/// The whole pixels of [0, extent) that the three coordinates lie in.
Span pixels_between(float a, float b, float c, int extent) {
  const auto [low, high] = std::minmax({a, b, c});
  const int first = std::clamp(static_cast<int>(std::floor(low)), 0, extent - 1);
  return {first, std::clamp(static_cast<int>(std::ceil(high)), first + 1, extent)};
}

/// The size of a target that each of the triangles fits on.
Extent common_extent(const Scene& scene) {
  constexpr int kLeast = 16;
  const Extent& screen = scene.setting.target;
  Extent extent{std::min(kLeast, screen.width), std::min(kLeast, screen.height)};
  for (const auto& [v0, v1, v2] : scene.triangles) {
    const Span columns = pixels_between(v0.x, v1.x, v2.x, screen.width);
    const Span rows = pixels_between(v0.y, v1.y, v2.y, screen.height);
    extent.width = std::max(extent.width, columns.end - columns.first);
    extent.height = std::max(extent.height, rows.end - rows.first);
  }
  return extent;
}

class SubjectContender : public Contender {
 public:
  explicit SubjectContender(std::unique_ptr<Subject> subject) : subject_(std::move(subject)) {}

  std::string name() const override { return subject_->info().name; }
  std::string isa() const override { return {}; }
  Clock clock() const override { return subject_->driver_seconds() > 0 ? Clock::driver : Clock::wall; }
  double driver_seconds() const override { return subject_->driver_seconds(); }
  std::optional<Extent> target() const override { return scene_.setting.target; }

  std::size_t most_triangles(const Scene& scene) const override {
    Setting setting = scene.setting;
    setting.target = common_extent(scene);
    return std::min(kMostTriangles, kMostBytes / (MaskLayout(setting).words() * sizeof(std::uint64_t)));
  }

  tl::expected<void, Error> prepare(const Scene& scene) override {
    scene_ = scene;
    scene_.meshes.clear();
    screen_ = MaskLayout(scene.setting);
    const Extent extent = scene_.setting.target = common_extent(scene);
    offsets_.clear();
    for (Triangle& triangle : scene_.triangles) {
      auto& [v0, v1, v2] = triangle;
      // The target moves over the screen, and never beyond it.
      const Offset offset{
          std::min(pixels_between(v0.x, v1.x, v2.x, screen_.target.width).first, screen_.target.width - extent.width),
          std::min(pixels_between(v0.y, v1.y, v2.y, screen_.target.height).first,
                   screen_.target.height - extent.height)};
      // Exact, as a coordinate only comes nearer to zero: whole pixels, of which a sample is still as far from an edge.
      for (Position& v : triangle) v = {v.x - static_cast<float>(offset.x), v.y - static_cast<float>(offset.y)};
      offsets_.push_back(offset);
    }
    if (const auto reason = subject_->refusal(scene_)) {
      return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{}: cannot draw it: {}", name(), *reason)});
    }
    return {};
  }
  void clear() override {}
  tl::expected<void, Error> draw() override { return subject_->draw(scene_, masks_); }
  void cover(std::size_t i, MutableMaskView mask) override {
    const MaskView own = std::as_const(masks_)[i];
    const std::size_t row_words = MaskLayout(scene_.setting).row_words();
    for (std::size_t k = 0; k < own.size(); ++k) {
      for (std::uint64_t bits = own[k]; bits != 0; bits &= bits - 1) {
        const int x = static_cast<int>(k % row_words * 64) + std::countr_zero(bits) + offsets_[i].x;
        conformance::cover(mask, screen_.bit(x, static_cast<int>(k / row_words) + offsets_[i].y, 0));
      }
    }
  }

 private:
  std::unique_ptr<Subject> subject_;
  Scene scene_;
  MaskLayout screen_{Setting{}};
  std::vector<Offset> offsets_;
  MaskBatch masks_;
};

}  // namespace

std::unique_ptr<Contender> make_subject_contender(std::unique_ptr<Subject> subject) {
  return std::make_unique<SubjectContender>(std::move(subject));
}

}  // namespace edgecase::conformance
