#include "conformance/subjects/family_subject.h"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/scene/standard_samples.h"
#include "rasterizer/family/family.h"
#include "rasterizer/snap.h"

namespace edgecase::conformance {
namespace {

using rasterizer::Format16_8;

class FamilySubject : public Subject {
 public:
  explicit FamilySubject(const rasterizer::FamilyMember& member) : member_(member) {
    info_.name = fmt::format("edgecase:{}", member.name);
    info_.max_target = rasterizer::kMaxExtent;
    info_.max_coordinate = 32768.0 - 1.0 / 256;
  }

  const SubjectInfo& info() const override { return info_; }

  std::optional<std::string> refusal(const Scene& scene) const override {
    if (scene.rules != info_.rules) return "rasterizes 8 subpixel bits, snapped to nearest even, only";
    if (auto reason = Subject::refusal(scene)) return reason;
    if (!has_standard_samples(scene.setting)) return "a sample off the pixel's centre";
    return std::nullopt;
  }

  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override {
    masks.reset(MaskLayout(scene.setting), scene.triangles.size());
    std::fill(masks.data().begin(), masks.data().end(), std::uint64_t{0});
    const auto target = rasterizer::Target::make(scene.setting.target.width, scene.setting.target.height);
    rasterizer::FixedTriangle<Format16_8> snapped;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      const auto& [v0, v1, v2] = scene.triangles[i];
      const rasterizer::Triangle triangle{{{v0.x, v0.y}, {v1.x, v1.y}, {v2.x, v2.y}}};
      if (const auto error = rasterizer::snap<Format16_8>(triangle, snapped, i)) {
        return tl::unexpected(Error{ErrorKind::subject, info_.name + ": " + rasterizer::describe(*error)});
      }
      member_.cover(snapped, *rasterizer::Mask::over(*target, masks[i]));
    }
    return {};
  }

 private:
  const rasterizer::FamilyMember& member_;
  SubjectInfo info_;
};

}  // namespace

std::vector<FamilySubjectName> family_subjects() {
  std::vector<FamilySubjectName> names;
  for (const auto& member : rasterizer::family_members()) names.push_back({member.name, member.about});
  return names;
}

std::unique_ptr<Subject> make_family_subject(std::string_view name) {
  const auto* member = rasterizer::find_family_member(name);
  if (member == nullptr) return nullptr;
  return std::make_unique<FamilySubject>(*member);
}

}  // namespace edgecase::conformance
