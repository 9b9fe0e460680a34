#include "conformance/runner/clipper_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "conformance/runner/run.h"
#include "conformance/runner/transform_search.h"
#include "conformance/subjects/registry.h"
#include "conformance/tests/modelled_subject.h"

namespace edgecase::conformance {
namespace {

bool same_clipper(const TransformModel& a, const TransformModel& b) {
  return a.depth == b.depth && a.shrink == b.shrink && a.multisample_shrink == b.multisample_shrink &&
         a.planes == b.planes && a.interpolation == b.interpolation && a.viewport_scissor == b.viewport_scissor &&
         a.loose_multisample_scissor == b.loose_multisample_scissor && a.winding == b.winding && a.fill == b.fill &&
         a.also_culls == b.also_culls && (a.also_culls == 0 || a.fan_ends_with_first == b.fan_ends_with_first);
}

std::string described(const TransformModel& m) {
  std::ostringstream text;
  text << "depth " << static_cast<int>(m.depth) << ", shrink " << m.shrink << " and " << m.multisample_shrink
       << ", planes";
  for (const ClipPlane plane : m.planes) text << ' ' << static_cast<int>(plane);
  text << ", interpolation " << static_cast<int>(m.interpolation) << ", scissors " << m.viewport_scissor << ' '
       << m.loose_multisample_scissor << ", winding " << static_cast<int>(m.winding) << ", fill "
       << static_cast<int>(m.fill) << ", also culls " << m.also_culls << " together";
  return text.str();
}

void expect_found(const TransformModel& model, const char* what) {
  ModelledSubject subject(model, model.rules.subpixel_bits);
  const auto found = find_clipper(subject, model);
  ASSERT_TRUE(found) << what << ": " << found.error();
  EXPECT_TRUE(same_clipper(*found, model)) << what << ": " << described(*found) << " for " << described(model);
}

TEST(ClipperSearch, FindsTheKnownOnesWithoutTheirNames) {
  for (const TransformModel* model :
       {&lavapipe_model(), &osmesa_llvmpipe_model(), &lavapipe_bgra8_model(), &swiftshader_model()}) {
    expect_found(*model, std::string(model->name).c_str());
  }
}

template <class Change>
void expect_found_changed(const TransformModel& base, const char* what, Change change) {
  TransformModel model = base;
  change(model);
  expect_found(model, what);
}

TEST(ClipperSearch, FindsSomeThatNobodyHas) {
  using enum ClipPlane;
  expect_found_changed(lavapipe_model(), "guard band with samples, another interpolation", [](TransformModel& m) {
    m.multisample_shrink = 0.5F;
    m.interpolation = Interpolation::crosswise;
  });
  expect_found_changed(lavapipe_model(), "culls once", [](TransformModel& m) { m.also_culls = 0; });
  expect_found_changed(swiftshader_model(), "order, depth", [](TransformModel& m) {
    m.planes = {top, far, left, near, bottom, right};
    m.depth = DepthRange::minus_w_to_w;
  });
}

// Each axis by itself, from either end.
TEST(LongClipperSearch, FindsOnesThatNobodyHas) {
  using enum ClipPlane;
  for (const TransformModel* base : {&lavapipe_model(), &swiftshader_model()}) {
    const auto expect_changed = [&](const char* what, auto change) { expect_found_changed(*base, what, change); };
    expect_changed("depth", [](TransformModel& m) { m.depth = DepthRange::minus_w_to_w; });
    expect_changed("guard band", [](TransformModel& m) { m.shrink = 0.5F; });
    expect_changed("guard band with samples", [](TransformModel& m) { m.multisample_shrink = 0.5F; });
    expect_changed("viewport scissor", [](TransformModel& m) { m.viewport_scissor = !m.viewport_scissor; });
    expect_changed("loose scissor",
                   [](TransformModel& m) { m.loose_multisample_scissor = !m.loose_multisample_scissor; });
    if (base->winding == Winding::exact) {
      expect_changed("culls once", [](TransformModel& m) { m.also_culls = 0; });
      expect_changed("culls each by itself again", [](TransformModel& m) { m.also_culls = 1; });
      expect_changed("culls all again", [](TransformModel& m) { m.also_culls = kWholeDraw; });
    }
    expect_changed("order", [](TransformModel& m) { m.planes = {top, far, left, near, bottom, right}; });
    expect_changed("reverse order", [](TransformModel& m) { std::ranges::reverse(m.planes); });
    expect_changed("interpolation", [](TransformModel& m) {
      m.interpolation =
          m.interpolation == Interpolation::crosswise ? Interpolation::from_nearer_end : Interpolation::crosswise;
    });
  }
  expect_found_changed(swiftshader_model(), "winding", [](TransformModel& m) {
    m.winding = Winding::exact;
    m.fill = Fill::each;
  });
}

// It drops whatever a plane would cut.
class Uncut : public ModelledSubject {
 public:
  using ModelledSubject::ModelledSubject;
  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    Scene whole = scene;
    for (std::size_t i = 0; scene.clip && i < scene.clip->triangles.size(); ++i) {
      if (std::ranges::any_of(scene.clip->triangles[i], [](const ClipPosition& p) {
            return std::abs(p.x) > p.w || std::abs(p.y) > p.w || p.z < 0 || p.z > p.w;
          })) {
        whole.clip->triangles[i] = {};
        whole.clip->triangles[i].fill({0, 0, 0, 1});
      }
    }
    return ModelledSubject::draw(whole, masks);
  }
};

TEST(ClipperSearch, SaysHowFarTheBestCameIfNoneFits) {
  Uncut subject(lavapipe_model(), 8);
  const auto found = find_clipper(subject, lavapipe_model());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().find("no known clipper explains it: the best explains "), 0u) << found.error();
}

TEST(ClipperSearch, SkipsClipSpaceWithThatReason) {
  Uncut other(lavapipe_model(), 8);
  const auto model = SubjectModel::find(other, true);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->clipper(), nullptr);
  EXPECT_EQ(model->rules(1), window_rules(lavapipe_model(), 1));
  auto reference = reference_for("modelled", &*model);
  ASSERT_TRUE(reference) << reference.error().message;
  Scene scene;
  scene.clip = ClipGeometry{{0, 0, 32, 32}, {{{{0, 0, 0, 1}, {2, 0, 0, 1}, {0, 1, 0, 1}}}}};
  const auto refusal = Judge(other, *reference, nullptr).refusal(scene);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->find("no known clipper explains it: "), 0u) << *refusal;
}

TEST(ClipperSearch, FindsThoseOfDrivers) {
  for (const auto& [name, model] :
       {std::pair{"lavapipe", &lavapipe_model()}, std::pair{"lavapipe:bgra8", &lavapipe_bgra8_model()},
        std::pair{"osmesa-llvmpipe", &osmesa_llvmpipe_model()}, std::pair{"swiftshader", &swiftshader_model()}}) {
    auto subject = make_subject(name);
    if (!subject && subject.error().kind == ErrorKind::absent && std::string(name) == "swiftshader") continue;
    ASSERT_TRUE(subject) << subject.error().message;
    const auto found = find_clipper(**subject, *model);
    ASSERT_TRUE(found) << name << ": " << found.error();
    EXPECT_TRUE(same_clipper(*found, *model)) << name;
  }
}

}  // namespace
}  // namespace edgecase::conformance
