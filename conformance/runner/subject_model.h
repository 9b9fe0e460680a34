// What a run has to know of a subject before it can judge it: how it gets from vertices to the subpixel grid.
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "conformance/models/transform_model.h"
#include "conformance/scene/error.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

class SubjectModel {
 public:
  /// Ours snap as the scene asks or as they declare; drivers are found out, by drawing, and so are their clippers if
  /// `clip_space` is to be judged. An error is a driver that no model of the transform explains.
  static tl::expected<SubjectModel, Error> find(Subject& subject, bool clip_space);
  /// Takes the subject at its word: for those of whom everything is predicted that they cover.
  static SubjectModel declared(const Subject& subject);

  /// What window positions are judged by, with so many samples a pixel.
  Rules rules(int samples) const;
  std::string description() const;
  /// Clipper and transform; null if nothing in clip space can be judged, for the reason unjudged().
  const TransformModel* clipper() const { return clipper_ ? &*clipper_ : nullptr; }
  const std::string& unjudged() const { return unjudged_; }

 private:
  Rules declared_;
  std::optional<TransformModel> transform_;
  std::optional<TransformModel> clipper_;
  std::string unjudged_ = "no model of its clipper and transform is known";
};

}  // namespace edgecase::conformance
