#include "conformance/runner/subject_model.h"

#include "conformance/runner/clipper_search.h"
#include "conformance/runner/transform_search.h"

namespace edgecase::conformance {

SubjectModel SubjectModel::declared(const Subject& subject) {
  SubjectModel model;
  model.declared_ = subject.info().rules;
  return model;
}

tl::expected<SubjectModel, Error> SubjectModel::find(Subject& subject, bool clip_space) {
  SubjectModel model = declared(subject);
  if (subject.info().device.empty()) return model;
  auto transform = find_transform(subject);
  if (!transform) return tl::unexpected(transform.error());
  model.transform_ = *transform;
  if (!clip_space || !subject.info().clip) return model;
  auto clipper = find_clipper(subject, *transform);
  if (clipper) {
    model.clipper_ = *clipper;
  } else {
    model.unjudged_ = clipper.error();
  }
  return model;
}

Rules SubjectModel::rules(int samples) const { return transform_ ? window_rules(*transform_, samples) : declared_; }

std::string SubjectModel::description() const {
  return transform_ ? describe_transform(*transform_) : describe_snap(declared_);
}

}  // namespace edgecase::conformance
