// Which samples a driver lets through at the border of the scissor.
#pragma once

#include <cstdint>
#include <vector>

#include "conformance/models/transform_model.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

class DrawnRegion {
 public:
  /// Of `setting`, drawn through `viewport` if there is one; otherwise through an enclosing one, which hides nothing.
  DrawnRegion(const TransformModel& model, const Setting& setting, const Viewport* viewport);

  /// Whether the driver draws the triangle at all: its bounding box, in pixels, has to meet the scissor.
  bool meets(const Triangle& triangle) const;
  /// The pixels that the driver is told to draw: those of the scissor in the target and, if it heeds it, the viewport.
  const Rect& scissor() const { return scissor_; }
  /// Every pixel in which samples may be covered.
  const Rect& reach() const { return reach_; }
  /// Takes the samples out of `mask` that lie in reach() but are not let through.
  void filter(MutableMaskView mask) const;

 private:
  Rect scissor_;
  Rect reach_;
  bool test_boxes_;
  std::vector<std::uint64_t> passed_;  ///< as a mask; empty if everything in reach() is let through
};

}  // namespace edgecase::conformance
