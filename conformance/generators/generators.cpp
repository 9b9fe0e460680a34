#include <array>

#include "conformance/generators/families.h"
#include "conformance/generators/generator.h"
#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

constexpr std::string_view kSampleTies = "triangles on the lattice of the sample locations, and slivers through them";
constexpr std::string_view kFarCorner =
    "triangles that end within 64 px, or just beyond, and reach thousands of pixels to the left and above";
constexpr std::string_view kNearCorner =
    "triangles that end within 16 px, but for a side of the scissor or the target, and reach 70 to 114 px to the left "
    "and "
    "above";
constexpr std::string_view kStraddle =
    "boxes of 4, 8, 16, 32, 64 and 128 px, up to a pixel more or less, on their grids";
constexpr std::string_view kNeedle =
    "needles 16,000 px long, a subpixel or two wide, within a subpixel of the centres of a whole row or column";
constexpr std::string_view kInside =
    "triangles in clip space that stay inside this viewport, ties of the snap among them";
constexpr std::string_view kClippedFar =
    "triangles in clip space of a viewport that reaches thousands of pixels to the left and above";
constexpr std::string_view kClippedFan = "closed fans in clip space across one or more planes, w = 1 or varying";
constexpr std::string_view kClippedGrid =
    "grids in clip space across one or more planes, w = 1 or varying (NVlabs/nvdiffrast#225: cracks)";
constexpr std::string_view kTurnedAcross = "slivers that snapping turns over, across a border of the target, culled";
constexpr std::string_view kTurnedBeside =
    "slivers that snapping turns over, culled, and now and then one that has to be clipped among them";
constexpr std::string_view kClipped =
    "triangles in clip space across one or more planes: w = 1, w > 0 varying, w of either sign";

Setting multisampled(int samples) {
  Setting setting;
  const auto locations = standard_sample_locations(samples);
  setting.sample_locations.assign(locations.begin(), locations.end());
  return setting;
}

Setting culled(CullMode cull, FrontFace front, int samples = 1) {
  Setting setting = multisampled(samples);
  setting.cull = cull;
  setting.front_face = front;
  return setting;
}

Setting sized(const Extent& target, int samples = 1) {
  Setting setting = multisampled(samples);
  setting.target = target;
  return setting;
}

Setting within(const Extent& target, const Rect& scissor, int samples) {
  Setting setting = sized(target, samples);
  setting.scissor = scissor;
  return setting;
}

Setting scissored(const Rect& scissor) {
  Setting setting;
  setting.scissor = scissor;
  return setting;
}

}  // namespace

std::span<const Generator> generators() {
  static const std::array all{
      Generator{"fan",
                "fan",
                "closed fans of 3 to 64 spokes; centre and spokes on sample points, pixel corners, anywhere",
                {},
                families::fan},
      Generator{
          "grid", "shared_edge", "regular grids jittered on the subpixel lattice, either diagonal", {}, families::grid},
      Generator{"triangulation",
                "shared_edge",
                "random triangulations: points inserted, edges flipped",
                {},
                families::triangulation},
      Generator{"strip", "shared_edge", "long thin strips, down to one subpixel wide", {}, families::strip},
      Generator{"refinement",
                "shared_edge",
                "meshes refined at edge midpoints without T-junctions",
                {},
                families::refinement},
      Generator{"random",
                "random",
                "triangles with uniformly random vertices in and around the target",
                {},
                families::uniform},
      Generator{"ties",
                "ties",
                "triangles on the half-pixel lattice: edges and vertices on pixel centres",
                {},
                families::ties},
      Generator{
          "range", "range", "triangles whose vertices lie up to 8,000 px outside the target", {}, families::range},
      Generator{"far_corner", "range", kFarCorner, {}, families::far_corner},
      Generator{"far_corner_wide", "range", kFarCorner, sized({75, 70}), families::far_corner},
      Generator{"far_corner_scissor", "range", kFarCorner, scissored({3, 18, 21, 9}), families::far_corner},
      Generator{"far_corner_samples4", "range", kFarCorner, multisampled(4), families::far_corner},
      Generator{"near_corner_scissor", "range", kNearCorner, scissored({0, 2, 32, 32}), families::near_corner},
      Generator{"near_corner_small", "range", kNearCorner, sized({13, 20}), families::near_corner},
      Generator{"sliver",
                "sliver",
                "needles up to a few subpixels wide, most of them passing close to pixel centres",
                {},
                families::sliver},
      Generator{"tiny",
                "tiny",
                "triangles under a pixel, most of them around a pixel centre",
                {},
                families::tiny,
                {},
                families::tiny_each},
      Generator{"samples2", "samples", kSampleTies, multisampled(2), families::sample_ties},
      Generator{"samples4", "samples", kSampleTies, multisampled(4), families::sample_ties},
      Generator{"samples8", "samples", kSampleTies, multisampled(8), families::sample_ties},
      Generator{"samples16", "samples", kSampleTies, multisampled(16), families::sample_ties},
      Generator{"samples16_tiny", "samples", "triangles of a few grid units around each of 16 samples",
                multisampled(16), families::around_samples},
      Generator{"scissor_inside", "scissor", "random triangles, a scissor inside the target", scissored({5, 7, 19, 13}),
                families::uniform},
      Generator{"scissor_across", "scissor", "random triangles, a scissor across two borders of the target",
                scissored({-6, 10, 20, 40}), families::uniform},
      Generator{"scissor_pixel", "scissor", "triangles on the half-pixel lattice, a scissor of one pixel",
                scissored({16, 15, 1, 1}), families::ties},
      Generator{"scissor_empty", "scissor", "random triangles, a scissor that holds no pixel", scissored({9, 9, 0, 4}),
                families::uniform},
      Generator{"scissor_samples4", "settings", "random triangles, 4 samples a pixel, a scissor inside the target",
                within({32, 32}, {5, 7, 19, 13}, 4), families::uniform},
      Generator{
          "scissor_tiles_samples4", "settings",
          "random triangles, 4 samples a pixel, a scissor that begins with a tile of 64 px, and a pixel after one",
          within({90, 100}, {64, 65, 20, 30}, 4), families::uniform},
      Generator{"cull_back", "cull", "triangles on the half-pixel lattice, backs culled",
                culled(CullMode::back, FrontFace::clockwise), families::ties},
      Generator{"cull_front", "cull", "random triangles, counter-clockwise fronts culled",
                culled(CullMode::front, FrontFace::counter_clockwise), families::uniform},
      Generator{"strips", "topology", "indexed strips with restarts, backs culled",
                culled(CullMode::back, FrontFace::clockwise), families::strips},
      Generator{"fans", "topology", "indexed fans with restarts", {}, families::fans},
      Generator{"floats", "float", "random triangles, all 24 bits of each coordinate in use", {}, families::floats},
      Generator{"float_ties",
                "float",
                "coordinates half way between two grid points, and the least that binary32 can tell beside",
                {},
                families::float_ties},
      Generator{"far_rectangle", "hard",
                "rectangles of two triangles, thousands of pixels large, of which only the lower right corner is seen",
                sized({30, 23}), families::far_rectangle},
      Generator{"straddle_wide", "hard", kStraddle, sized({144, 24}), families::straddle},
      Generator{"straddle_tall", "hard", kStraddle, sized({24, 144}), families::straddle},
      Generator{"needle_row", "hard", kNeedle, sized({2048, 2}), families::needle},
      Generator{"needle_column", "hard", kNeedle, sized({2, 2048}), families::needle},
      Generator{"spokes", "hard", "closed fans of 1,000 to 4,096 spokes", {}, families::spokes},
      Generator{"range_ends",
                "hard",
                "coordinates at both ends of 16 integer bits, and near the target",
                {},
                families::range_ends},
      Generator{"viewport_ends",
                "hard",
                "the same at -8,192 and 8,192 px, between which a viewport of 16,384 px lies",
                {},
                families::viewport_ends},
      Generator{"border16", "hard", "triangles that end at a sample on or next to its pixel's border",
                sized({8, 8}, 16), families::border_samples},
  };
  return all;
}

std::span<const Generator> clip_generators() {
  static const std::array all{
      Generator{"viewport_target", "viewport", kInside, {}, families::inside, Viewport{0, 0, 32, 32}},
      Generator{"viewport_offset", "viewport", kInside, {}, families::inside, Viewport{7, 3, 23, 17}},
      Generator{"viewport_fractional", "viewport", kInside, {}, families::inside, Viewport{0.3F, -1.7F, 33.1F, 27.9F}},
      Generator{"viewport_larger", "viewport", kInside, {}, families::inside, Viewport{-40, -30, 100, 75}},
      Generator{"viewport_flipped", "viewport", kInside, {}, families::inside, Viewport{3.3F, 30.1F, 27.3F, -37.7F}},
      Generator{"viewport_flipped_ties",
                "viewport",
                "triangles in clip space on half pixels of a flipped viewport, half of them with a horizontal edge",
                {},
                families::centres,
                Viewport{0, 32, 32, -32}},
      Generator{"cull_turned", "cull", "slivers in clip space that snapping turns over, backs culled",
                culled(CullMode::back, FrontFace::clockwise), families::turned, Viewport{0, 0, 32, 32}},
      Generator{"cull_across", "cull", kTurnedAcross, culled(CullMode::back, FrontFace::clockwise),
                families::turned_across, Viewport{0.3F, -1.7F, 33.1F, 27.9F}},
      Generator{"cull_across_samples4", "cull", kTurnedAcross, culled(CullMode::front, FrontFace::clockwise, 4),
                families::turned_across, Viewport{0, 0, 32, 32}},
      Generator{"cull_beside_clipped", "cull", kTurnedBeside, culled(CullMode::back, FrontFace::clockwise),
                families::turned_beside_across, Viewport{0, 0, 32, 32}},
      Generator{"cull_beside_clipped_samples4", "cull", kTurnedBeside,
                culled(CullMode::front, FrontFace::counter_clockwise, 4), families::turned_beside_across,
                Viewport{-0.7F, 33.1F, 34.3F, -34.7F}},
      Generator{"clip_behind",
                "clip",
                "triangles in clip space inside the view volume, and mirrored through the eye",
                {},
                families::behind,
                Viewport{0, 0, 32, 32}},
      Generator{"clip_fans", "clip_mesh", kClippedFan, {}, families::clip_fan, Viewport{0, 0, 32, 32}},
      Generator{"clip_grids", "clip_mesh", kClippedGrid, {}, families::clip_grid, Viewport{0, 0, 32, 32}},
      Generator{"clip_grids_fractional",
                "clip_mesh",
                kClippedGrid,
                {},
                families::clip_grid,
                Viewport{0.3F, -1.7F, 33.1F, 27.9F}},
      Generator{"clip_grids_samples4", "clip_mesh", kClippedGrid, multisampled(4), families::clip_grid,
                Viewport{0, 0, 32, 32}},
      Generator{"clip", "clip", kClipped, {}, families::clip, Viewport{0, 0, 32, 32}},
      Generator{"clip_fractional", "clip", kClipped, {}, families::clip, Viewport{0.3F, -1.7F, 33.1F, 27.9F}},
      Generator{"clip_flipped", "clip", kClipped, {}, families::clip, Viewport{3.3F, 30.1F, 27.3F, -37.7F}},
      Generator{"clip_larger", "clip", kClipped, {}, families::clip, Viewport{-40, -30, 100, 75}},
      Generator{"clip_far", "clip", kClippedFar, {}, families::clip_far, Viewport{-7950, -6960, 8000, 7000}},
      Generator{"clip_far_samples4", "clip", kClippedFar, multisampled(4), families::clip_far,
                Viewport{-7940.5F, -6960.25F, 8000.25F, 7000.75F}},
      Generator{"clip_far_scissor4", "clip", kClippedFar, within({30, 27}, {3, 2, 20, 21}, 4), families::clip_far,
                Viewport{-7940.5F, -6960.25F, 7966.25F, 6985.75F}},
      Generator{"clip_samples4", "clip", kClipped, multisampled(4), families::clip,
                Viewport{2.5005F, 1.5015F, 20.25F, 26.75F}},
  };
  return all;
}

const Generator* find_generator(std::string_view name) {
  for (const Generator& generator : generators()) {
    if (generator.name == name) return &generator;
  }
  for (const Generator& generator : clip_generators()) {
    if (generator.name == name) return &generator;
  }
  return nullptr;
}

void SceneStream::append(std::uint64_t index, Scene& scene) const {
  const Lattice lattice(scene.setting.target, scene.rules.subpixel_bits);
  Random random = random_.item(index);
  if (generator_.viewport && !scene.clip) scene.clip = ClipGeometry{*generator_.viewport, {}};
  generator_.append(lattice, random, scene);
}

void SceneStream::append_each(std::uint64_t first, std::size_t count, Scene& scene) const {
  const Lattice lattice(scene.setting.target, scene.rules.subpixel_bits);
  generator_.append_each(lattice, random_, first, count, scene);
}

void append_scene(const Generator& generator, std::uint64_t seed, std::uint64_t index, Scene& scene) {
  SceneStream(generator, seed).append(index, scene);
}

}  // namespace edgecase::conformance
