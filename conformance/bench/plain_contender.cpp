#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "conformance/bench/contenders.h"
#include "conformance/bench/plain.h"

namespace edgecase::conformance {
namespace {

template <int Bits>
class Plain : public Contender {
 public:
  using Format = rasterizer::Format<16, Bits>;

  explicit Plain(PlainLoop loop) : loop_(loop) {}
  std::string name() const override { return loop_ == PlainLoop::scalar ? std::string(kPlain) : plain_name(Bits); }
  std::string isa() const override { return plain_isa(loop_); }

  tl::expected<void, Error> prepare(const Scene& scene) override {
    auto snapped = snap_all<Format>(scene);
    if (!snapped) return tl::unexpected(snapped.error());
    triangles_ = std::move(*snapped);
    setting_ = scene.setting;
    pixels_.resize(MaskLayout(setting_).sample_count());
    return {};
  }
  void clear() override { std::fill(pixels_.begin(), pixels_.end(), std::uint8_t{0}); }
  void shuffle(std::mt19937_64& random) override { shuffle_if_short(triangles_, random); }
  tl::expected<void, Error> draw() override {
    const rasterizer::Target target = target_of(setting_);
    for (const auto& triangle : triangles_) cover_plain(loop_, triangle, target, pixels_.data());
    return {};
  }
  void cover(std::size_t i, MutableMaskView mask) override {
    const rasterizer::Target target = target_of(setting_);
    const auto box = rasterizer::pixel_box<Format>(triangles_[i], rasterizer::View<>{target});
    if (!box) return;
    // Of the bytes, only those in the box can have been written.
    const MaskLayout layout(setting_);
    const auto for_each_pixel = [&](auto visit) {
      for (int y = box->top.value(); y < box->bottom.value(); ++y) {
        for (int x = box->left.value(); x < box->right.value(); ++x) visit(x, y, *byte(x, y));
      }
    };
    for_each_pixel([](int, int, std::uint8_t& pixel) { pixel = 0; });
    cover_plain(loop_, triangles_[i], target, pixels_.data());
    for_each_pixel([&](int x, int y, std::uint8_t& pixel) {
      if (pixel != 0) conformance::cover(mask, layout.bit(x, y, 0));
    });
  }

 private:
  std::uint8_t* byte(int x, int y) {
    return pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(setting_.target.width) + x;
  }

  PlainLoop loop_;
  Setting setting_;
  std::vector<rasterizer::FixedTriangle<Format>> triangles_;
  std::vector<std::uint8_t> pixels_;
};

template <std::size_t... I>
std::unique_ptr<Contender> make(int bits, std::index_sequence<I...>) {
  std::unique_ptr<Contender> made;
  static_cast<void>(
      ((kSubpixelBits[I] == bits && (made = std::make_unique<Plain<kSubpixelBits[I]>>(PlainLoop::vectorized), true)) ||
       ...));
  return made;
}

}  // namespace

std::string plain_name(int bits) {
  return bits == 8 ? std::string(kPlainVectorized) : fmt::format("{}:bits{}", kPlain, bits);
}

std::unique_ptr<Contender> make_plain_contender() { return std::make_unique<Plain<8>>(PlainLoop::scalar); }

std::unique_ptr<Contender> make_vectorized_contender(int bits) {
  return make(bits, std::make_index_sequence<kSubpixelBits.size()>());
}

}  // namespace edgecase::conformance
