#include "conformance/runner/transform_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "conformance/runner/prediction.h"
#include "conformance/runner/transform_probe.h"

namespace edgecase::conformance {
namespace {

constexpr int kSeveralSamples = 4;

struct Drawn {
  std::vector<Scene> scenes;
  std::vector<MaskBatch> masks;
};

tl::expected<Drawn, Error> draw_probe(std::span<const TransformModel> candidates, int samples, Subject& subject) {
  Drawn drawn{transform_probe(candidates, samples, subject).scenes, {}};
  if (drawn.scenes.empty()) {
    return tl::unexpected(
        Error{ErrorKind::subject, fmt::format("{}: cannot draw the probe of its snap", subject.info().name)});
  }
  for (const Scene& scene : drawn.scenes) {
    if (auto done = subject.draw(scene, drawn.masks.emplace_back()); !done) return tl::unexpected(done.error());
  }
  return drawn;
}

bool explains(const TransformModel& model, const Drawn& drawn) {
  for (std::size_t i = 0; i < drawn.scenes.size(); ++i) {
    const Agreement agreement = compare_with_prediction(model, drawn.scenes[i], drawn.masks[i]);
    if (agreement.wrong + agreement.unpredicted != 0) return false;
  }
  return true;
}

Error nothing_fits(const Subject& subject, int samples) {
  return {ErrorKind::subject,
          fmt::format("{}: no known way of transforming and snapping vertices explains what it covers near ties, {} "
                      "sample{} a pixel, at the {} subpixel bits that it reports or any other from 4 to 8",
                      subject.info().name, samples, samples == 1 ? "" : "s", subject.info().rules.subpixel_bits)};
}

bool has_samples(const SubjectInfo& info, int samples) {
  return std::ranges::find(info.sample_counts, samples) != info.sample_counts.end();
}

}  // namespace

tl::expected<TransformModel, Error> find_transform(Subject& subject) {
  const SubjectInfo& info = subject.info();
  const std::vector<TransformModel> candidates = transform_candidates(info.rules.subpixel_bits, info.clip);
  const auto once = draw_probe(candidates, 1, subject);
  if (!once) return tl::unexpected(once.error());
  const auto found =
      std::ranges::find_if(candidates, [&](const TransformModel& model) { return explains(model, *once); });
  if (found == candidates.end()) return tl::unexpected(nothing_fits(subject, 1));
  if (!has_samples(info, kSeveralSamples)) return *found;

  const auto several = draw_probe(candidates, kSeveralSamples, subject);
  if (!several) return tl::unexpected(several.error());
  TransformModel result = *found;
  for (const HalfPixelShift shift :
       {found->shift, HalfPixelShift::none, HalfPixelShift::before_scaling, HalfPixelShift::within_viewport}) {
    result.multisample_shift = shift;
    if (explains(result, *several)) return result;
  }
  return tl::unexpected(nothing_fits(subject, kSeveralSamples));
}

Rules window_rules(const TransformModel& transform, int samples) {
  Rules rules = transform.rules;
  rules.half_pixel_first = (samples > 1 ? transform.multisample_shift : transform.shift) != HalfPixelShift::none;
  return rules;
}

std::string describe_snap(const Rules& rules) {
  const char* rounding = "";
  switch (rules.rounding) {
    case SnapRounding::nearest_even:
      rounding = "to nearest even";
      break;
    case SnapRounding::half_up:
      rounding = "to nearest, half up";
      break;
    case SnapRounding::half_away:
      rounding = "to nearest, half away from zero";
      break;
    case SnapRounding::truncate:
      rounding = "towards zero";
      break;
  }
  return fmt::format("{} subpixel bits, {}{}", rules.subpixel_bits, rounding,
                     rules.half_pixel_first ? ", half a pixel subtracted first" : "");
}

std::string describe_transform(const TransformModel& transform) {
  const auto shift = [](HalfPixelShift how) {
    switch (how) {
      case HalfPixelShift::none:
        return "no half pixel subtracted";
      case HalfPixelShift::before_scaling:
        return "half a pixel subtracted first";
      case HalfPixelShift::within_viewport:
        return "half a pixel subtracted within a viewport in subpixels";
    }
    return "";
  };
  const std::string of_several = transform.multisample_shift == transform.shift
                                     ? std::string()
                                     : fmt::format(" ({} with several samples)", shift(transform.multisample_shift));
  return fmt::format("{}, {}{}, multiply-add {}", describe_snap(transform.rules), shift(transform.shift), of_several,
                     transform.multiply_add == MultiplyAdd::fused ? "fused" : "in two roundings");
}

}  // namespace edgecase::conformance
