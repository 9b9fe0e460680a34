#include "conformance/bench/contender.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "conformance/bench/plain.h"
#include "conformance/subjects/inexact_subject.h"
#include "rasterizer/family/family.h"
#include "rasterizer/rasterizer.h"

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

/// The workloads' triangles as rasterizer/ takes them. They lie on the grid: snapping moves nothing.
tl::expected<std::vector<FixedTriangle>, Error> snap_all(const Scene& scene) {
  std::vector<FixedTriangle> snapped(scene.triangles.size());
  for (std::size_t i = 0; i < snapped.size(); ++i) {
    const auto& [v0, v1, v2] = scene.triangles[i];
    const rasterizer::Triangle triangle{{{v0.x, v0.y}, {v1.x, v1.y}, {v2.x, v2.y}}};
    if (const auto error = rasterizer::snap<Format>(triangle, snapped[i], i)) {
      return tl::unexpected(Error{ErrorKind::bad_input, rasterizer::describe(*error)});
    }
  }
  return snapped;
}

rasterizer::Target target_of(const Scene& scene) {
  return *rasterizer::Target::make(scene.setting.target.width, scene.setting.target.height);
}

class Plain : public Contender {
 public:
  std::string name() const override { return std::string(kPlain); }
  std::string isa() const override { return plain_isa(); }

  tl::expected<void, Error> prepare(const Scene& scene) override {
    auto snapped = snap_all(scene);
    if (!snapped) return tl::unexpected(snapped.error());
    triangles_ = std::move(*snapped);
    setting_ = scene.setting;
    pixels_.resize(MaskLayout(setting_).sample_count());
    return {};
  }
  void clear() override { std::fill(pixels_.begin(), pixels_.end(), std::uint8_t{0}); }
  tl::expected<void, Error> draw() override {
    for (const FixedTriangle& triangle : triangles_) draw(triangle);
    return {};
  }
  void cover(std::size_t i, MutableMaskView mask) override {
    const auto target = *rasterizer::Target::make(setting_.target.width, setting_.target.height);
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
    draw(triangles_[i]);
    for_each_pixel([&](int x, int y, std::uint8_t& pixel) {
      if (pixel != 0) conformance::cover(mask, layout.bit(x, y, 0));
    });
  }

 private:
  std::uint8_t* byte(int x, int y) {
    return pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(setting_.target.width) + x;
  }

  void draw(const FixedTriangle& triangle) {
    cover_plain(triangle, *rasterizer::Target::make(setting_.target.width, setting_.target.height), pixels_.data());
  }

  Setting setting_;
  std::vector<FixedTriangle> triangles_;
  std::vector<std::uint8_t> pixels_;
};

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
    auto snapped = snap_all(scene);
    if (!snapped) return tl::unexpected(snapped.error());
    triangles_ = std::move(*snapped);
    target_ = target_of(scene);
    resize(scene);
    return {};
  }
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
    list_ = prepare_inexact(info_.name, scene);
    resize(scene);
    return {};
  }
  tl::expected<void, Error> draw() override {
    list_->cover_all(words());
    return {};
  }
  void cover(std::size_t i, MutableMaskView mask) override { list_->cover(i, mask); }

 private:
  const InexactInfo& info_;
  std::unique_ptr<InexactList> list_;
};

class SubjectContender : public Contender {
 public:
  explicit SubjectContender(std::unique_ptr<Subject> subject) : subject_(std::move(subject)) {}

  std::string name() const override { return subject_->info().name; }
  std::string isa() const override { return {}; }
  bool in_this_thread() const override { return false; }
  /// A mask of the screen is 259 KB.
  std::size_t most_triangles() const override { return 256; }

  tl::expected<void, Error> prepare(const Scene& scene) override {
    if (const auto reason = subject_->refusal(scene)) {
      return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{}: cannot draw it: {}", name(), *reason)});
    }
    scene_ = scene;
    return {};
  }
  void clear() override {}
  tl::expected<void, Error> draw() override { return subject_->draw(scene_, masks_); }
  void cover(std::size_t i, MutableMaskView mask) override {
    const MaskView own = std::as_const(masks_)[i];
    std::transform(own.begin(), own.end(), mask.begin(), mask.begin(), std::bit_or());
  }

 private:
  std::unique_ptr<Subject> subject_;
  Scene scene_;
  MaskBatch masks_;
};

}  // namespace

std::vector<std::unique_ptr<Contender>> built_in_contenders() {
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.push_back(std::make_unique<Plain>());
  for (const auto& member : rasterizer::family_members())
    contenders.push_back(std::make_unique<FamilyContender>(member));
  for (const auto& info : inexact_subjects()) contenders.push_back(std::make_unique<InexactContender>(info));
  return contenders;
}

std::unique_ptr<Contender> make_subject_contender(std::unique_ptr<Subject> subject) {
  return std::make_unique<SubjectContender>(std::move(subject));
}

}  // namespace edgecase::conformance
