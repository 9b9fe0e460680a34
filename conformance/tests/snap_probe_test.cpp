#include "conformance/runner/snap_probe.h"

#include <gtest/gtest.h>

#include "conformance/oracle/oracle.h"
#include "conformance/subjects/fault_subject.h"
#include "conformance/subjects/registry.h"

namespace edgecase::conformance {
namespace {

// A subject that snaps in one of the ways there are: by the oracle, so that nothing but the probe is tested.
class Snapping : public Subject {
 public:
  explicit Snapping(const Rules& rules) : rules_(rules) { info_.rules.subpixel_bits = rules.subpixel_bits; }
  const SubjectInfo& info() const override { return info_; }
  std::optional<std::string> refusal(const Scene&) const override { return std::nullopt; }
  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    masks.reset(MaskLayout(scene.setting), scene.triangles.size());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      oracle::cover_by_definition(scene.setting, rules_, scene.triangles[i], masks[i]);
    }
    return {};
  }

 private:
  Rules rules_;
  SubjectInfo info_;
};

TEST(SnapProbe, TellsEveryTwoCandidatesApart) {
  for (const int bits : {4, 8}) {
    for (const Rules& rules : snap_candidates(bits)) {
      Snapping subject(rules);
      const auto found = find_snap(subject);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(*found, rules) << describe_snap(rules) << " taken for " << describe_snap(*found);
    }
  }
}

TEST(SnapProbe, FailsIfNothingFits) {
  const auto floor = make_fault_subject("snap-floor");
  EXPECT_FALSE(find_snap(*floor));
}

// llvmpipe subtracts the half pixel in binary32 before it scales and rounds: the last bits of a coordinate near zero go
// with it, and what was just past a tie becomes the tie.
TEST(SnapProbe, FindsHowLlvmpipeSnaps) {
  for (const char* name : {"lavapipe", "osmesa-llvmpipe"}) {
    const auto subject = make_subject(name);
    ASSERT_TRUE(subject) << subject.error().message;
    const auto found = find_snap(**subject);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(*found, (Rules{8, SnapRounding::nearest_even, true}));
  }
}

}  // namespace
}  // namespace edgecase::conformance
