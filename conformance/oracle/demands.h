// What a rule set demands of every sample of a scene.
#pragma once

#include <vector>

#include "conformance/scene/mask.h"
#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance::oracle {

/// Which of the two oracles answers.
enum class Method { by_definition, by_shift };

/// A mask of each for every triangle.
struct Demands {
  MaskBatch must;
  MaskBatch may;  ///< left open, by sets that leave something open; without masks by those that do not
};

/// `scene` is in window positions; its rules give the grid, and how to snap to it if the set leaves that open.
Demands demands(const Scene& scene, const RuleSet& rule_set, Method method = Method::by_definition);

struct SampleDemand {
  int triangles = 0;  ///< that must cover the sample
  bool open = false;  ///< whether any other may
};

/// Of every sample: rows top to bottom, in them pixels left to right, in them the samples.
std::vector<SampleDemand> sample_demands(const Setting& setting, const Demands& demands);

}  // namespace edgecase::conformance::oracle
