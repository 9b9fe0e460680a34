#include "conformance/subjects/edgecase_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "conformance/scene/coordinates.h"
#include "conformance/scene/grid.h"
#include "conformance/subjects/family_subject.h"
#include "rasterizer/fast/fast.h"
#include "rasterizer/rasterizer.h"

namespace edgecase::conformance {
namespace {

constexpr int kIntegerBits = 16;
/// Masks that are compared at once: half of what the usual second-level cache holds at least.
constexpr std::size_t kPartBytes = std::size_t{1} << 17;
constexpr std::size_t kFormats = 17;  // subpixel bits 0 to 16

rasterizer::Triangle to_rasterizer(const Triangle& triangle) {
  const auto& [v0, v1, v2] = triangle;
  return {{{v0.x, v0.y}, {v1.x, v1.y}, {v2.x, v2.y}}};
}

/// The same memory: both are six numbers, which snap_on_grid() reads as vectors.
std::span<const rasterizer::Triangle> in_place(std::span<const Triangle> triangles) {
  static_assert(sizeof(Triangle) == sizeof(rasterizer::Triangle));
  return {reinterpret_cast<const rasterizer::Triangle*>(triangles.data()), triangles.size()};
}

using Failure = std::optional<rasterizer::InputError>;

template <class F>
Failure check_range(const Scene& scene) {
  // In whatever format of 16 integer bits, none of these rounds to a number outside of it.
  static_assert(kIntegerBits == 16);
  if (all_within(scene.triangles, 32767)) return std::nullopt;
  rasterizer::FixedTriangle<F> snapped;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (const auto error = rasterizer::snap<F>(to_rasterizer(scene.triangles[i]), snapped, i)) return error;
  }
  return std::nullopt;
}

/// The scene's samples; nothing if the rasterizer cannot take them.
std::optional<rasterizer::SamplePattern> sample_pattern(const Setting& setting) {
  std::vector<rasterizer::SampleLocation> locations;
  for (const SampleLocation& location : setting.sample_locations) locations.push_back({location.x, location.y});
  return rasterizer::SamplePattern::make(locations);
}

/// Whether the setting drops the way that `triangle` faces. That of a degenerate one does not matter.
template <class F>
bool is_culled(const Setting& setting, const rasterizer::FixedTriangle<F>& triangle) {
  if (setting.cull == CullMode::none) return false;
  const bool clockwise = rasterizer::doubled_area<F>(triangle) > rasterizer::constant<0>;
  const bool front = clockwise == (setting.front_face == FrontFace::clockwise);
  return front == (setting.cull == CullMode::front);
}

template <class F, class View>
Failure draw_into(const View& view, const Scene& scene, MaskBatch& masks) {
  rasterizer::FixedTriangle<F> snapped;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (const auto error = rasterizer::snap<F>(to_rasterizer(scene.triangles[i]), snapped, i)) return error;
    if (is_culled<F>(scene.setting, snapped)) continue;
    const auto mask = rasterizer::Mask::over(view.target, masks[i], view.samples.count());
    rasterizer::cover_scalar<F>(snapped, view, [&](int y, int word, std::uint64_t bits) { mask->add(y, word, bits); });
  }
  return std::nullopt;
}

/// Calls draw(view) with the view that asks for what `setting` asks for and no more.
template <class Draw>
auto with_view(const Setting& setting, const rasterizer::Target& target, const Draw& draw) {
  using rasterizer::CentreSample, rasterizer::SamplePattern, rasterizer::Scissor, rasterizer::View;
  const bool centre = setting.samples() == 1 && setting.sample_locations[0] == SampleLocation{};
  const auto samples = *sample_pattern(setting);
  if (!setting.scissor) return centre ? draw(View<>{target}) : draw(View<SamplePattern>{target, samples});
  const Scissor scissor{setting.scissor->x, setting.scissor->y, setting.scissor->width, setting.scissor->height};
  return centre ? draw(View<CentreSample, Scissor>{target, {}, scissor})
                : draw(View<SamplePattern, Scissor>{target, samples, scissor});
}

template <class F>
Failure draw_all(const Scene& scene, const rasterizer::Target& target, MaskBatch& masks) {
  std::fill(masks.data().begin(), masks.data().end(), std::uint64_t{0});
  return with_view(scene.setting, target, [&](const auto& view) { return draw_into<F>(view, scene, masks); });
}

using Fixed = rasterizer::Format16_8;
using FixedTriangle = rasterizer::FixedTriangle<Fixed>;

/// The fast rasterizer, and the triangles of its last list: the memory is used again from list to list.
struct Fast {
  rasterizer::FastRasterizer rasterizer;
  std::vector<rasterizer::Triangle> triangles{};
  std::vector<FixedTriangle> snapped{};
  std::vector<std::uint64_t> masks{};
  MaskBatch whole{};
};

/// The same in vectors. Vertices on a grid coarser than that of 16.8 lie on that one, too.
template <class F>
Failure draw_fast(Fast& fast, const Scene& scene, const rasterizer::Target& target, MaskBatch& masks) {
  if constexpr (F::kSubpixelBits > rasterizer::Format16_8::kSubpixelBits) {
    return draw_all<F>(scene, target, masks);
  } else {
    constexpr int kFiner = rasterizer::Format16_8::kSubpixelBits - F::kSubpixelBits;
    fast.triangles.resize(scene.triangles.size());
    fast.snapped.resize(scene.triangles.size());
    std::ranges::transform(scene.triangles, fast.triangles.begin(), to_rasterizer);
    if constexpr (kFiner == 0) {
      if (const auto error = rasterizer::snap_list<F>(fast.triangles, fast.snapped)) return error;
    } else {
      std::vector<rasterizer::FixedTriangle<F>> coarse(fast.triangles.size());
      if (const auto error = rasterizer::snap_list<F>(fast.triangles, coarse)) return error;
      for (std::size_t i = 0; i < coarse.size(); ++i) {
        for (std::size_t v = 0; v < 3; ++v) {
          fast.snapped[i][v] = {coarse[i][v].x.template shifted_left<kFiner>(),
                                coarse[i][v].y.template shifted_left<kFiner>()};
        }
      }
    }
    if (scene.setting.cull != CullMode::none) {
      for (auto& triangle : fast.snapped) {
        if (is_culled<rasterizer::Format16_8>(scene.setting, triangle)) triangle = {};  // without area
      }
    }
    return with_view(scene.setting, target, [&](const auto& view) -> Failure {
      fast.rasterizer.cover_each(fast.snapped, view, masks.data());
      return std::nullopt;
    });
  }
}

/// Whether masks `first` and following of `observed` are those of `triangles`.
template <class View>
bool draws_just(Fast& fast, std::span<const FixedTriangle> triangles, const View& view, const DrawnMasks& observed,
                std::size_t first) {
  const auto compare = [&](const auto& masks) {
    return fast.rasterizer.first_difference(triangles, view.target, masks) == triangles.size();
  };
  constexpr bool kIsPlain = std::is_same_v<View, rasterizer::View<>>;
  if (kIsPlain && observed.have_short_rows()) return compare(observed.short_rows(first, triangles.size()));
  const auto masks = observed.whole(first, triangles.size(), fast.whole).data();
  if (kIsPlain) return compare(masks);
  fast.masks.resize(masks.size());
  fast.rasterizer.cover_each(triangles, view, fast.masks);
  return std::ranges::equal(fast.masks, masks);
}

struct FormatEntry {
  Failure (*check_range)(const Scene&);
  Failure (*draw_all)(const Scene&, const rasterizer::Target&, MaskBatch&);
  Failure (*draw_fast)(Fast&, const Scene&, const rasterizer::Target&, MaskBatch&);
};

template <std::size_t... Bits>
constexpr std::array<FormatEntry, sizeof...(Bits)> make_formats(std::index_sequence<Bits...>) {
  return {FormatEntry{&check_range<rasterizer::Format<kIntegerBits, static_cast<int>(Bits)>>,
                      &draw_all<rasterizer::Format<kIntegerBits, static_cast<int>(Bits)>>,
                      &draw_fast<rasterizer::Format<kIntegerBits, static_cast<int>(Bits)>>}...};
}

/// Indexed by the subpixel bits.
constexpr auto kFormatTable = make_formats(std::make_index_sequence<kFormats>());

class EdgecaseSubject : public Subject {
 public:
  EdgecaseSubject(std::string name, std::optional<rasterizer::FastRasterizer> fast) {
    if (fast) fast_ = Fast{*fast};
    info_.name = std::move(name);
    info_.sample_counts.resize(rasterizer::kMaxSamples);
    std::iota(info_.sample_counts.begin(), info_.sample_counts.end(), 1);
    info_.max_target = rasterizer::kMaxExtent;
    info_.follows_scene_rules = true;
    info_.scissor = true;
    info_.cull = true;
    info_.assembly = true;
    info_.max_coordinate = 32768.0 - 1.0 / 256;
  }

  const SubjectInfo& info() const override { return info_; }

  std::optional<std::string> refusal(const Scene& scene) const override {
    if (auto refused = refusal_but_for_snap(scene)) return refused;
    if (scene.rules.rounding != SnapRounding::nearest_even || scene.rules.half_pixel_first) {
      return "snaps to nearest even only";
    }
    const int bits = scene.rules.subpixel_bits;
    if (bits < 0 || static_cast<std::size_t>(bits) >= kFormats) return fmt::format("{} subpixel bits", bits);
    if (const auto error = kFormatTable[static_cast<std::size_t>(bits)].check_range(scene)) {
      return rasterizer::describe(*error);
    }
    return std::nullopt;
  }

  // Part by part, so that what is made of each stays in the cache. Without subpixel bits half a pixel is no grid unit,
  // and subtracting it first makes a tie of a grid point.
  std::optional<bool> draws(const Scene& scene, const DrawnMasks& observed) override {
    static_assert(rasterizer::FastRasterizer::kGridReach * (1 << Fixed::kSubpixelBits) <= kGridReach);
    const int bits = scene.rules.subpixel_bits;
    if (!fast_ || bits < 1 || bits > Fixed::kSubpixelBits || scene.setting.cull != CullMode::none) return std::nullopt;
    if (refusal_but_for_snap(scene)) return std::nullopt;
    const auto target = rasterizer::Target::make(scene.setting.target.width, scene.setting.target.height);
    const std::size_t mask_bytes = MaskLayout(scene.setting).words() * sizeof(std::uint64_t);
    const std::size_t most = std::max<std::size_t>(1, kPartBytes / mask_bytes);
    fast_->snapped.resize(std::min(most, scene.triangles.size()));
    for (std::size_t first = 0; first < scene.triangles.size(); first += most) {
      const auto part = std::span(scene.triangles).subspan(first, std::min(most, scene.triangles.size() - first));
      const auto snapped = std::span(fast_->snapped).first(part.size());
      if (bits < Fixed::kSubpixelBits && !all_on_grid(part, std::ldexp(1.0F, bits))) return std::nullopt;
      if (!fast_->rasterizer.snap_on_grid(in_place(part), snapped)) return std::nullopt;
      const bool equal = with_view(
          scene.setting, *target, [&](const auto& view) { return draws_just(*fast_, snapped, view, observed, first); });
      if (!equal) return false;
    }
    return true;
  }

  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    masks.reset(MaskLayout(scene.setting), scene.triangles.size());
    const auto target = rasterizer::Target::make(scene.setting.target.width, scene.setting.target.height);
    const auto bits = static_cast<std::size_t>(scene.rules.subpixel_bits);
    const FormatEntry& format = kFormatTable[bits];
    if (const auto error =
            fast_ ? format.draw_fast(*fast_, scene, *target, masks) : format.draw_all(scene, *target, masks)) {
      return tl::unexpected(Error{ErrorKind::subject, info_.name + ": " + rasterizer::describe(*error)});
    }
    return {};
  }

 private:
  std::optional<std::string> refusal_but_for_snap(const Scene& scene) const {
    const Setting& setting = scene.setting;
    if (!rasterizer::Target::make(setting.target.width, setting.target.height)) {
      return fmt::format("target {}x{} is not from 1 to {} pixels a side", setting.target.width, setting.target.height,
                         info_.max_target);
    }
    if (setting.samples() < 1 || setting.samples() > rasterizer::kMaxSamples) {
      return fmt::format("{} samples a pixel", setting.samples());
    }
    if (scene.clip) return "clip space";
    if (!sample_pattern(setting)) return "a sample off the sixteenths of a pixel";
    return std::nullopt;
  }

  SubjectInfo info_;
  std::optional<Fast> fast_;
};

std::string_view instructions_of(rasterizer::Isa isa) {
  switch (isa) {
    case rasterizer::Isa::portable:
      return "scalar code";
    case rasterizer::Isa::sse4:
      return "SSE4.2";
    case rasterizer::Isa::avx2:
      return "AVX2, FMA and BMI2";
    case rasterizer::Isa::avx3:
      return "AVX-512";
  }
  return {};
}

}  // namespace

std::vector<InstructionSetVariant> instruction_set_variants() {
  std::vector<InstructionSetVariant> variants;
  for (const rasterizer::Isa isa : rasterizer::kAllIsas) {
    const bool available = std::ranges::count(rasterizer::available_isas(), isa) != 0;
    variants.push_back({rasterizer::name_of(isa), instructions_of(isa), available});
  }
  return variants;
}

std::unique_ptr<Subject> make_edgecase_subject(const std::string& variant) {
  using rasterizer::FastRasterizer;
  if (variant.empty()) return std::make_unique<EdgecaseSubject>("edgecase", FastRasterizer());
  if (variant == "scalar") return std::make_unique<EdgecaseSubject>("edgecase:scalar", std::nullopt);
  for (const rasterizer::Isa isa : rasterizer::available_isas()) {
    if (variant == rasterizer::name_of(isa)) {
      return std::make_unique<EdgecaseSubject>("edgecase:" + variant, FastRasterizer::make(isa));
    }
  }
  return make_family_subject(variant);
}

}  // namespace edgecase::conformance
