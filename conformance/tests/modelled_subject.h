// A subject that covers what a model predicts, by the oracle: so that nothing but the search for the model is tested.
#pragma once

#include "conformance/runner/prediction.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

class ModelledSubject : public Subject {
 public:
  explicit ModelledSubject(const TransformModel& model, int reported_bits) : model_(model) {
    info_.name = "modelled";
    info_.device = "a device that nobody has met";
    info_.rules.subpixel_bits = reported_bits;
    info_.sample_counts = {1, 4};
    info_.max_coordinate = 16384;
    info_.scissor = info_.cull = info_.clip = info_.flipped_viewport = true;
    info_.max_viewport = info_.viewport_bound = 16384;
  }

  SubjectInfo& info() { return info_; }
  const SubjectInfo& info() const override { return info_; }

  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    predict(model_, scene, masks);
    return {};
  }

 private:
  TransformModel model_;
  SubjectInfo info_;
};

}  // namespace edgecase::conformance
