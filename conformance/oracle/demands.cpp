#include "conformance/oracle/demands.h"

#include "conformance/oracle/allowed.h"
#include "conformance/oracle/oracle.h"

namespace edgecase::conformance::oracle {

Demands demands(const Scene& scene, const RuleSet& rule_set, Method method) {
  const auto cover = method == Method::by_definition ? cover_by_definition : cover_by_shift;
  const auto allow = method == Method::by_definition ? allow_by_definition : allow_by_shift;
  const MaskLayout layout(scene.setting);
  const std::vector<std::uint64_t> all(layout.words(), ~std::uint64_t{0});
  Demands result;
  result.must.reset(layout, scene.triangles.size());
  if (!rule_set.exact()) result.may.reset(layout, scene.triangles.size());
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (rule_set.exact()) {
      cover(scene.setting, scene.rules, scene.triangles[i], result.must[i]);
    } else {
      allow(scene.setting, scene.rules, rule_set, scene.triangles[i], all, result.must[i], result.may[i]);
    }
  }
  return result;
}

std::vector<SampleDemand> sample_demands(const Setting& setting, const Demands& demands) {
  const MaskLayout layout(setting);
  std::vector<SampleDemand> result;
  result.reserve(layout.sample_count());
  for (int y = 0; y < layout.target.height; ++y) {
    for (int x = 0; x < layout.target.width; ++x) {
      for (int s = 0; s < layout.samples; ++s) {
        const std::size_t bit = layout.bit(x, y, s);
        SampleDemand& demand = result.emplace_back();
        for (std::size_t i = 0; i < demands.must.size(); ++i) demand.triangles += covered(demands.must[i], bit) ? 1 : 0;
        for (std::size_t i = 0; i < demands.may.size(); ++i) demand.open = demand.open || covered(demands.may[i], bit);
      }
    }
  }
  return result;
}

}  // namespace edgecase::conformance::oracle
