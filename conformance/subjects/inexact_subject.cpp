#include "conformance/subjects/inexact_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/inexact_arithmetic.h"

namespace edgecase::conformance {
namespace {

using inexact::EdgeFunctions;
using inexact::FixedPoint;
using inexact::Floating;
using inexact::SlopeStepping;
using inexact::Stepping;

template <class Arithmetic>
class List : public InexactList {
 public:
  explicit List(const Scene& scene) : target_(scene.setting.target), row_words_(MaskLayout(scene.setting).row_words()) {
    prepared_.reserve(scene.triangles.size());
    for (const Triangle& triangle : scene.triangles) prepared_.push_back(Arithmetic::prepare(triangle));
  }
  void cover(std::size_t i, MutableMaskView mask) const override {
    Arithmetic::cover(prepared_[i], {target_, row_words_, mask});
  }
  void cover_all(MutableMaskView mask) const override {
    const inexact::Canvas canvas{target_, row_words_, mask};
    for (const auto& vertices : prepared_) Arithmetic::cover(vertices, canvas);
  }

 private:
  Extent target_;
  std::size_t row_words_;
  std::vector<typename Arithmetic::Vertices> prepared_;
};

template <class Arithmetic>
std::unique_ptr<InexactList> prepare(const Scene& scene) {
  return std::make_unique<List<Arithmetic>>(scene);
}

struct Entry {
  InexactInfo info;
  std::unique_ptr<InexactList> (*prepare)(const Scene&);
};

template <int Bits>
using FewerBits = EdgeFunctions<FixedPoint<std::int64_t, Bits>>;

constexpr std::string_view kOffCoarseGrid = "any vertex between two points of the coarser grid";

constexpr Entry kEntries[] = {
    {{"float", "edge functions in binary32, evaluated anew at each pixel; vertices not snapped",
      "edges closer to a sample than the products' rounding, seen from 32 px on; vertices off the grid"},
     prepare<EdgeFunctions<Floating<float>>>},
    {{"float-stepped", "edge functions in binary32, one addition per pixel; vertices not snapped",
      "the same; each step rounds once more, and the errors add up along a row"},
     prepare<EdgeFunctions<Floating<float>, Stepping::accumulated>>},
    {{"double", "edge functions in binary64; vertices not snapped",
      "vertices off the grid only: on it, 16.8 products fit 53 bits and nothing is rounded"},
     prepare<EdgeFunctions<Floating<double>>>},
    {{"int32", "8 subpixel bits with every sum and product in 32 bits",
      "triangles whose edge functions reach 2^31, an extent of 128 by 256 px or more"},
     prepare<EdgeFunctions<FixedPoint<inexact::Wrapping32, 8>>>},
    {{"bits0", "vertices snapped to whole pixels", kOffCoarseGrid}, prepare<FewerBits<0>>},
    {{"bits2", "vertices snapped to 2 subpixel bits", kOffCoarseGrid}, prepare<FewerBits<2>>},
    {{"bits4", "vertices snapped to 4 subpixel bits", kOffCoarseGrid}, prepare<FewerBits<4>>},
    {{"bits6", "vertices snapped to 6 subpixel bits", kOffCoarseGrid}, prepare<FewerBits<6>>},
    {{"dda", "slopes and columns in binary32, one addition per row; vertices not snapped",
      "edges through or near samples; the rounded slope adds up along tall edges"},
     prepare<SlopeStepping<inexact::FloatSlope>>},
    {{"dda-fixed", "slopes and columns in 16.16 fixed point, truncated",
      "edges through samples whose slope is no 65536th"},
     prepare<SlopeStepping<inexact::FixedSlope>>},
    {{"dda-snapped-ends", "ends rounded to whole pixels, slopes of the edges as they were",
      "any vertex between two pixels: the edge arrives beside its end"},
     prepare<SlopeStepping<inexact::SnappedEndsSlope>>},
};

const Entry* find_entry(std::string_view name) {
  const auto found = std::ranges::find(kEntries, name, [](const Entry& entry) { return entry.info.name; });
  return found == std::end(kEntries) ? nullptr : found;
}

class InexactSubject : public Subject {
 public:
  explicit InexactSubject(const Entry& entry) : entry_(entry) {
    info_.name = fmt::format("inexact:{}", entry.info.name);
    // Its snap is not to be found out by drawing, because nothing that it draws need be right: it is held against the
    // rules that it claims, and refuses scenes that ask for others.
    info_.follows_scene_rules = true;
    info_.max_coordinate = 32768.0 - 1.0 / 256;
  }

  const SubjectInfo& info() const override { return info_; }

  std::optional<std::string> refusal(const Scene& scene) const override {
    if (scene.rules != info_.rules) return "measured against 8 subpixel bits, snapped to nearest even, only";
    if (auto reason = Subject::refusal(scene)) return reason;
    if (!has_standard_samples(scene.setting)) return "a sample off the pixel's centre";
    return std::nullopt;
  }

  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    masks.reset(MaskLayout(scene.setting), scene.triangles.size());
    std::fill(masks.data().begin(), masks.data().end(), std::uint64_t{0});
    const auto list = entry_.prepare(scene);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) list->cover(i, masks[i]);
    return {};
  }

 private:
  const Entry& entry_;
  SubjectInfo info_;
};

constexpr auto kInfos = [] {
  std::array<InexactInfo, std::size(kEntries)> infos;
  std::ranges::transform(kEntries, infos.begin(), &Entry::info);
  return infos;
}();

}  // namespace

std::span<const InexactInfo> inexact_subjects() { return kInfos; }

std::unique_ptr<Subject> make_inexact_subject(std::string_view name) {
  const Entry* entry = find_entry(name);
  if (entry == nullptr) return nullptr;
  return std::make_unique<InexactSubject>(*entry);
}

std::unique_ptr<InexactList> prepare_inexact(std::string_view name, const Scene& scene) {
  const Entry* entry = find_entry(name);
  return entry == nullptr ? nullptr : entry->prepare(scene);
}

}  // namespace edgecase::conformance
