// Known deviations: subjects that are wrong in a way we can predict, sample by sample.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

struct DeviationModel {
  /// Turns the mask that the rules ask for into the one that the subject is predicted to draw; where it does not
  /// deviate, they are the same.
  void (*predict)(const Setting& setting, const Triangle& triangle, MutableMaskView mask) = nullptr;
  /// Whether it may concern the triangle, as far as that can be told at a glance; null always does.
  bool (*concerns)(const Setting& setting, const Triangle& triangle) = nullptr;
  /// Whether it may concern any of them, at less than a glance each; null always does.
  bool (*concerns_any)(const Setting& setting, std::span<const Triangle> triangles) = nullptr;

  bool may_concern(const Setting& setting, const Triangle& triangle) const {
    return concerns == nullptr || concerns(setting, triangle);
  }
  bool may_concern_any(const Setting& setting, std::span<const Triangle> triangles) const {
    return concerns_any == nullptr || concerns_any(setting, triangles);
  }
};

/// A deviation is excused by nothing but a model that predicts every sample of the subject's masks, right and wrong
/// ones. Where the subject follows the model it is known; where it does not, in either direction, it fails: so that an
/// entry for a subject that has been put right cannot stay.
struct KnownDeviation {
  std::string subject;
  /// If not empty, it concerns every `vulkan:...` subject of which the device's name has this in it, too.
  std::string device;
  std::string cause;
  DeviationModel in_window{};  ///< of triangles in window positions
  /// Of what clipping left of a triangle, within the scissor that the driver itself is given; the rest is said by the
  /// TransformModel.
  DeviationModel of_part{};

  bool replaces_rules() const { return in_window.concerns == nullptr; }
  bool concerns_most(const Setting& setting) const {
    return replaces_rules() || (is_frequent != nullptr && is_frequent(setting));
  }
  /// Whether it concerns so many triangles in window positions that few batches are as the rules say; null: never.
  bool (*is_frequent)(const Setting& setting) = nullptr;
};

/// Reads the list, a JSON array of {"subject", "device" (optional), "model", "cause"}; errors name file, entry and
/// value.
tl::expected<std::vector<KnownDeviation>, Error> load_known_deviations(const std::filesystem::path& file);

/// The entry for that subject, or null. `device` is what the subject reports.
const KnownDeviation* find_known_deviation(const std::vector<KnownDeviation>& all, std::string_view subject,
                                           std::string_view device);

}  // namespace edgecase::conformance
