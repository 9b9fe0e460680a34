#include "conformance/bench/contender.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "conformance/bench/contenders.h"
#include "conformance/subjects/inexact_subject.h"
#include "rasterizer/family/family.h"

namespace edgecase::conformance {
namespace {

using Format = rasterizer::Format16_8;
using FixedTriangle = rasterizer::FixedTriangle<Format>;

/// What the compiler was allowed to use throughout this program.
std::string compiled_isa() {
#if defined(__AVX512F__)
  return "avx512";
#elif defined(__AVX2__)
  return "avx2";
#elif defined(__SSE4_1__)
  return "sse4";
#elif defined(__x86_64__)
  return "sse2";
#else
  return "portable";
#endif
}

/// Draws into one mask.
class MaskContender : public Contender {
 public:
  std::string isa() const override { return compiled_isa(); }
  void clear() override { std::fill(words_.begin(), words_.end(), std::uint64_t{0}); }

 protected:
  void resize(const Scene& scene) { words_.resize(MaskLayout(scene.setting).words()); }
  std::span<std::uint64_t> words() { return words_; }

 private:
  std::vector<std::uint64_t> words_;
};

class FamilyContender : public MaskContender {
 public:
  explicit FamilyContender(const rasterizer::FamilyMember& member) : member_(member) {}
  std::string name() const override { return fmt::format("edgecase:{}", member_.name); }

  tl::expected<void, Error> prepare(const Scene& scene) override {
    auto snapped = snap_all<Format>(scene);
    if (!snapped) return tl::unexpected(snapped.error());
    triangles_ = std::move(*snapped);
    target_ = target_of(scene.setting);
    resize(scene);
    return {};
  }
  void shuffle(std::mt19937_64& random) override { shuffle_if_short(triangles_, random); }
  tl::expected<void, Error> draw() override {
    member_.cover_list(triangles_, *rasterizer::Mask::over(target_, words()));
    return {};
  }
  void cover(std::size_t i, MutableMaskView mask) override {
    member_.cover(triangles_[i], *rasterizer::Mask::over(target_, mask));
  }

 private:
  const rasterizer::FamilyMember& member_;
  rasterizer::Target target_ = *rasterizer::Target::make(1, 1);
  std::vector<FixedTriangle> triangles_;
};

class InexactContender : public MaskContender {
 public:
  explicit InexactContender(const InexactInfo& info) : info_(info) {}
  std::string name() const override { return fmt::format("inexact:{}", info_.name); }

  tl::expected<void, Error> prepare(const Scene& scene) override {
    short_scene_.reset();
    if (scene.triangles.size() <= kShortList) short_scene_ = scene;
    list_ = prepare_inexact(info_.name, scene);
    resize(scene);
    return {};
  }
  void shuffle(std::mt19937_64& random) override {
    if (!short_scene_) return;
    shuffle_if_short(short_scene_->triangles, random);
    list_ = prepare_inexact(info_.name, *short_scene_);
  }
  tl::expected<void, Error> draw() override {
    list_->cover_all(words());
    return {};
  }
  void cover(std::size_t i, MutableMaskView mask) override { list_->cover(i, mask); }

 private:
  const InexactInfo& info_;
  std::optional<Scene> short_scene_;
  std::unique_ptr<InexactList> list_;
};

}  // namespace

std::vector<std::unique_ptr<Contender>> built_in_contenders() {
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.push_back(make_plain_contender());
  contenders.push_back(make_vectorized_contender(8));
  contenders.push_back(make_fast_contender("edgecase", rasterizer::FastRasterizer()));
  for (const rasterizer::Isa isa : rasterizer::available_isas()) {
    contenders.push_back(make_fast_contender(fmt::format("edgecase:{}", rasterizer::name_of(isa)),
                                             *rasterizer::FastRasterizer::make(isa)));
  }
  contenders.push_back(make_threads_contender());
  for (const auto& member : rasterizer::family_members())
    contenders.push_back(std::make_unique<FamilyContender>(member));
  for (const auto& info : inexact_subjects()) contenders.push_back(std::make_unique<InexactContender>(info));
  for (const int bits : kSubpixelBits) {
    if (bits != 8) contenders.push_back(make_vectorized_contender(bits));
  }
  return contenders;
}

}  // namespace edgecase::conformance
