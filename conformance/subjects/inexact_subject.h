// Subjects whose arithmetic is tempting and not exact: what each saves, and what it costs, stands in the same tables
// and pictures as every other rasterizer.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

struct InexactInfo {
  std::string_view name;              ///< NAME of the subject `inexact:NAME`
  std::string_view description;       ///< the arithmetic, one line
  std::string_view expected_failure;  ///< where it departs from the rules, one line
};

std::span<const InexactInfo> inexact_subjects();

/// The subject `inexact:NAME` for the NAME of one of inexact_subjects(); null for any other.
///
/// All of them claim what D3D11 demands, 16.8 snapped to nearest even with one sample in the pixel's centre, and are
/// measured against that; coordinates up to one subpixel below 32768 px of either sign.
std::unique_ptr<Subject> make_inexact_subject(std::string_view name);

/// The triangles of a scene, brought into the form that one of these arithmetics works on: drawing them is then all
/// there is to time.
class InexactList {
 public:
  virtual ~InexactList() = default;
  /// Adds triangle i, or every triangle, to a mask of the scene's layout.
  virtual void cover(std::size_t i, MutableMaskView mask) const = 0;
  virtual void cover_all(MutableMaskView mask) const = 0;
};

/// For the name of one of inexact_subjects() and a scene that its subject does not refuse; null for any other name.
std::unique_ptr<InexactList> prepare_inexact(std::string_view name, const Scene& scene);

}  // namespace edgecase::conformance
