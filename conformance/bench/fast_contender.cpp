#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>

#include "conformance/bench/contenders.h"
#include "rasterizer/threads/threads.h"

namespace edgecase::conformance {
namespace {

using Format = rasterizer::Format16_8;
using FixedTriangle = rasterizer::FixedTriangle<Format>;
using rasterizer::StripMask;

class Fast : public Contender {
 public:
  Fast(std::string_view name, const rasterizer::FastRasterizer& fast) : name_(name), fast_(fast) {}
  std::string name() const override { return name_; }
  std::string isa() const override { return std::string(rasterizer::name_of(fast_.isa())); }

  tl::expected<void, Error> prepare(const Scene& scene) override {
    auto snapped = snap_all<Format>(scene);
    if (!snapped) return tl::unexpected(snapped.error());
    triangles_ = std::move(*snapped);
    layout_ = MaskLayout(scene.setting);
    united_ = StripMask(target_of(scene.setting));
    single_ = StripMask(target_of(scene.setting));
    return {};
  }
  void clear() override { united_.clear(); }
  void shuffle(std::mt19937_64& random) override { shuffle_if_short(triangles_, random); }
  tl::expected<void, Error> draw() override {
    fast_.cover_union(triangles_, united_);
    return {};
  }
  /// Moves what is in the rows that the triangle reaches, and one on either side; what it put elsewhere moves with the
  /// last triangle.
  void cover(std::size_t i, MutableMaskView mask) override {
    fast_.cover_union(std::span(triangles_).subspan(i, 1), single_);
    const auto [v0, v1, v2] = triangles_[i];
    const auto [high, low] = std::minmax({v0.y.value(), v1.y.value(), v2.y.value()});
    const int height = layout_.target.height;
    const bool last = i + 1 == triangles_.size();
    const int top = last ? 0 : std::clamp((high >> Format::kSubpixelBits) - 1, 0, height);
    const int bottom = last ? height : std::clamp((low >> Format::kSubpixelBits) + 2, 0, height);
    const rasterizer::Strips strips = single_.strips();
    for (int strip = 0; strip < strips.count; ++strip) {
      const int width = std::min(layout_.target.width - strip * rasterizer::kStripWidth, rasterizer::kStripWidth);
      const std::uint32_t pixels = ~std::uint32_t{0} >> (rasterizer::kStripWidth - width);
      for (int y = top; y < bottom; ++y) {
        std::uint32_t& word =
            strips.words[static_cast<std::size_t>(strip) * strips.stride + static_cast<std::size_t>(y)];
        const std::size_t first = layout_.bit(strip * rasterizer::kStripWidth, y, 0);
        mask[first / 64] |= std::uint64_t{word & pixels} << (first % 64);
        word = 0;
      }
    }
  }

 protected:
  std::span<const FixedTriangle> triangles() const { return triangles_; }
  StripMask& united() { return united_; }

 private:
  std::string name_;
  rasterizer::FastRasterizer fast_;
  std::vector<FixedTriangle> triangles_;
  MaskLayout layout_{Setting{}};
  StripMask united_{target_of(Setting{})};
  StripMask single_{target_of(Setting{})};
};

class Threads : public Fast {
 public:
  Threads()
      : Fast("edgecase:threads", rasterizer::FastRasterizer()),
        threaded_({}, std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}
  Clock clock() const override { return Clock::wall; }
  tl::expected<void, Error> draw() override {
    threaded_.cover_union(triangles(), united());
    return {};
  }

 private:
  rasterizer::ThreadedRasterizer threaded_;
};

}  // namespace

std::unique_ptr<Contender> make_threads_contender() { return std::make_unique<Threads>(); }

std::unique_ptr<Contender> make_fast_contender(std::string_view name, const rasterizer::FastRasterizer& fast) {
  return std::make_unique<Fast>(name, fast);
}

}  // namespace edgecase::conformance
