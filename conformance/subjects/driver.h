// Driver: a rasterizer behind a graphics interface, as the worker process sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <tl/expected.hpp>

#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// One instance lives in one worker process, and is used from one thread.
class Driver {
 public:
  virtual ~Driver() = default;

  /// `max_coordinate` is the half extent of the EnclosingViewport that draw() uses.
  virtual const SubjectInfo& info() const = 0;

  /// The most mask bytes that one draw may ask for; at least one triangle's at usual targets.
  virtual std::size_t max_mask_bytes() const = 0;

  /// Draws each triangle into its own mask: `masks` holds triangles.size() masks of MaskLayout(setting), at most
  /// max_mask_bytes(), and every word of it is written. `setting` has standard sample locations, a sample count and a
  /// target that info() allows. Returns the seconds that the driver took from submission to the end of the draw.
  virtual tl::expected<double, Error> draw(const Setting& setting, std::span<const Triangle> triangles,
                                           std::span<std::uint64_t> masks) = 0;
};

}  // namespace edgecase::conformance
