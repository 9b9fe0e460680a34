#include "conformance/runner/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "conformance/compare/watertight.h"
#include "conformance/generators/generator.h"
#include "conformance/oracle/oracle.h"
#include "conformance/runner/run.h"
#include "conformance/subjects/inexact_subject.h"

namespace edgecase::conformance {
namespace {

constexpr std::size_t kSceneTriangles = 256;
constexpr std::size_t kLimitTriangles = 2000;
constexpr int kBigTarget = 512;

Family from_generator(std::string_view name, std::string_view about, Extent target) {
  return {std::string(name), std::string(about), std::nullopt, [name, target](std::uint64_t seed, std::uint64_t index) {
            const std::string_view generator = name.starts_with("big_") ? name.substr(4) : name;
            Scene scene;
            scene.setting.target = target;
            const Lattice lattice(target, scene.rules.subpixel_bits);
            Random random = Random::stream(seed, name, index);
            while (scene.triangles.empty()) find_generator(generator)->append(lattice, random, scene);
            return scene;
          }};
}

// Vertices anywhere between the points of the grid, as a transform leaves them: 16 more fraction bits.
Scene off_grid(std::uint64_t seed, std::uint64_t index) {
  constexpr int kFiner = 16;
  Scene scene;
  Random random = Random::stream(seed, "off_grid", index);
  const auto coordinate = [&] {
    return std::ldexp(static_cast<float>(random.between(-(8 << kFiner), 40 << kFiner)), -kFiner);
  };
  scene.triangles.push_back({Position{coordinate(), coordinate()}, Position{coordinate(), coordinate()},
                             Position{coordinate(), coordinate()}});
  return scene;
}

Family at_extent(int pixels) {
  return {fmt::format("range_{}", pixels), fmt::format("vertices up to {} px from the origin", pixels), pixels,
          [pixels](std::uint64_t seed, std::uint64_t index) {
            return extent_scene({}, std::int64_t{pixels} * 256, seed + index, kSceneTriangles);
          }};
}

void check_meshes(const Scene& scene, const MaskBatch& observed, StabilityRow& row) {
  WatertightChecker checker(scene.setting, scene.rules.subpixel_bits);
  std::vector<GridTriangle> snapped;
  for (const Mesh& mesh : scene.meshes) {
    snapped.clear();
    for (const Triangle& t : std::span(scene.triangles).subspan(mesh.first, mesh.count)) {
      snapped.push_back(
          {oracle::snap(scene.rules, t[0]), oracle::snap(scene.rules, t[1]), oracle::snap(scene.rules, t[2])});
    }
    const std::size_t words = observed[0].size();
    Watertightness found;
    checker.check(snapped, observed.data().subspan(mesh.first * words, mesh.count * words), 0, found);
    row.meshes += found.meshes;
    row.inside += found.samples_inside;
    row.gaps += found.missing;
    row.doubles += found.doubled;
  }
}

tl::expected<StabilityRow, Error> measure_row(const Family& family, Subject& subject, Reference& reference,
                                              std::uint64_t seed, std::uint64_t count) {
  StabilityRow row;
  row.subject = subject.info().name;
  row.family = family.name;
  row.extent = family.extent;
  MaskBatch observed;
  for (std::uint64_t index = 0; row.triangles < count; ++index) {
    const Scene scene = family.scene(seed, index);
    auto measured = measure_scene(scene, subject, reference, observed);
    if (!measured) return tl::unexpected(measured.error());
    row.refused = measured->refused;
    if (row.refused) break;
    row.triangles += measured->comparison.triangles;
    row.to_cover += measured->to_cover;
    row.wrong += measured->comparison.wrong_samples();
    check_meshes(scene, observed, row);
  }
  return row;
}

}  // namespace

double StabilityRow::wrong_per_million() const {
  return to_cover == 0 ? 0 : 1e6 * static_cast<double>(wrong) / static_cast<double>(to_cover);
}

std::vector<Family> families() {
  const Extent small{32, 32};
  const Extent big{kBigTarget, kBigTarget};
  std::vector<Family> all{
      from_generator("ties", "edges and vertices on pixel centres", small),
      from_generator("sliver", "needles up to a few subpixels wide", small),
      from_generator("tiny", "triangles under a pixel", small),
      {"off_grid", "vertices between the points of the grid", std::nullopt, off_grid},
      from_generator("fan", "closed fans", small),
      from_generator("refinement", "meshes with vertices on the middles of edges", small),
      from_generator("big_fan", "closed fans over 512x512 pixels", big),
      from_generator("big_triangulation", "triangulations over 512x512 pixels", big),
  };
  for (int pixels = 16; pixels <= 16384; pixels *= 2) all.push_back(at_extent(pixels));
  return all;
}

std::vector<std::string> stability_subjects() {
  std::vector<std::string> names{"edgecase"};
  for (const InexactInfo& inexact : inexact_subjects()) names.push_back(fmt::format("inexact:{}", inexact.name));
  return names;
}

tl::expected<Stability, Error> measure_stability(std::span<const std::string> subjects, std::uint64_t seed,
                                                 std::uint64_t count,
                                                 const std::function<void(std::uint64_t)>& on_progress) {
  Stability result;
  for (const std::string& name : subjects) {
    auto subject = make_subject(name);
    if (!subject) return tl::unexpected(subject.error());
    auto reference = reference_for(name);
    if (!reference) return tl::unexpected(reference.error());
    for (const Family& family : families()) {
      auto row = measure_row(family, **subject, *reference, seed, count);
      if (!row) return tl::unexpected(row.error());
      result.rows.push_back(std::move(*row));
      on_progress(count);
    }
    auto limit = find_limit(**subject, (*subject)->info().rules, *reference, nullptr, seed, kLimitTriangles);
    if (!limit) return tl::unexpected(limit.error());
    result.limits.push_back({name, std::move(*limit)});
  }
  return result;
}

}  // namespace edgecase::conformance
