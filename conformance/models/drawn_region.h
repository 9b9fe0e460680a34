// Which samples a driver lets through at the border of the scissor.
#pragma once

#include <cstdint>
#include <vector>

#include "conformance/models/transform_model.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// The pixels in which a driver draws.
class ScissorReach {
 public:
  /// Of `setting`, drawn through `viewport` if there is one; otherwise through an enclosing one, which hides nothing.
  ScissorReach(const TransformModel& model, const Setting& setting, const Viewport* viewport);

  /// Those that the driver is told to draw: in the scissor, the target and, if it heeds it, the viewport.
  const Rect& told() const { return told_; }
  /// Those in which samples may be covered: one column and one row more at most, to the left and above.
  const Rect& all() const { return all_; }
  /// Whether the driver draws the triangle at all: its bounding box, in pixels, has to meet told().
  bool meets(const Triangle& triangle) const;
  /// Whether a sample is let through that lies at `location` of a pixel of all().
  bool lets_through(int column, int row, const SampleLocation& location) const {
    return (column >= told_.x || location.x > kPixelCentre) && (row >= told_.y || location.y > kPixelCentre);
  }

 private:
  static constexpr int kPixelCentre = 8;  // in sixteenths of a pixel

  Rect told_;
  Rect all_;
  bool test_boxes_;
};

/// The same, for many masks.
class DrawnRegion {
 public:
  DrawnRegion(const TransformModel& model, const Setting& setting, const Viewport* viewport);

  const ScissorReach& reach() const { return reach_; }
  /// Whether filter() does nothing.
  bool is_whole() const { return passed_.empty(); }
  /// Takes the samples out of `mask` that lie in reach().all() but are not let through.
  void filter(MutableMaskView mask) const;

 private:
  ScissorReach reach_;
  std::vector<std::uint64_t> passed_;  ///< as a mask; empty if everything is let through
};

}  // namespace edgecase::conformance
