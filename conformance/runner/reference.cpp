#include "conformance/runner/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "conformance/oracle/oracle.h"
#include "conformance/scene/grid.h"

namespace edgecase::conformance {
namespace {

// Exact: a grid coordinate has at most 24 bits.
Position snapped(const Rules& rules, const Position& position) {
  const GridPoint p = oracle::snap(rules, position);
  return {std::ldexp(static_cast<float>(p.x), -rules.subpixel_bits),
          std::ldexp(static_cast<float>(p.y), -rules.subpixel_bits)};
}

// Half of what the usual second-level cache holds at least.
constexpr std::size_t kPartBytes = std::size_t{1} << 17;

}  // namespace

std::string coordinates(const Triangle& triangle) {
  return fmt::format("({:a}, {:a}) ({:a}, {:a}) ({:a}, {:a})", triangle[0].x, triangle[0].y, triangle[1].x,
                     triangle[1].y, triangle[2].x, triangle[2].y);
}

void Reference::take_up(const Scene& scene) {
  scene_ = &scene;
  window_.reset();
  if (scene.clip) window_.emplace(window_scene(model_ ? *model_ : exact_model(scene.rules), scene));
}

tl::expected<void, Error> Reference::expect(std::uint64_t first_index, MaskBatch& must) {
  if (!window_) return expect_window(*scene_, first_index, must);
  if (auto parts = expect_window(window_->scene, first_index, parts_); !parts) return parts;
  must.reset(MaskLayout(scene_->setting), triangle_count(*scene_));
  unite(*window_, parts_, must);
  return {};
}

const Scene* Reference::one_for_each() {
  if (!window_) return scene_;
  const WindowScene& w = *window_;
  if (!w.unpredicted.empty() || !w.region.is_whole()) return nullptr;
  one_for_each_.setting = w.scene.setting;
  one_for_each_.rules = w.scene.rules;
  one_for_each_.triangles.assign(w.size(), Triangle{});  // without area
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (w.parts_of(i) == 0) continue;
    if (w.parts_of(i) > 1 || w.takes_away[w.first[i]]) return nullptr;
    one_for_each_.triangles[i] = w.scene.triangles[w.first[i]];
  }
  return &one_for_each_;
}

tl::expected<bool, Error> Reference::expects(std::uint64_t first_index, const DrawnMasks& observed) {
  const Scene* const whole = one_for_each();
  if (whole == nullptr) return false;
  const Scene& scene = *whole;
  if (const auto same = fast_ ? fast_->draws(scene, observed) : std::nullopt) {
    if (!*same) return false;
    if (auto confirmed = confirm_share(scene, first_index, observed); !confirmed) {
      return tl::unexpected(confirmed.error());
    }
    return true;
  }
  const MaskLayout layout(scene.setting);
  const std::size_t most = std::max<std::size_t>(1, kPartBytes / (layout.words() * sizeof(std::uint64_t)));
  part_.setting = scene.setting;
  part_.rules = scene.rules;
  for (std::size_t first = 0; first < scene.triangles.size(); first += most) {
    const auto triangles = std::span(scene.triangles).subspan(first, std::min(most, scene.triangles.size() - first));
    part_.triangles.assign(triangles.begin(), triangles.end());
    if (auto drawn = expect_window(part_, first_index + first, parts_); !drawn) return tl::unexpected(drawn.error());
    if (!std::ranges::equal(std::as_const(parts_).data(), observed.whole(first, triangles.size(), whole_).data())) {
      return false;
    }
  }
  return true;
}

tl::expected<void, Error> Reference::expect_window(const Scene& scene, std::uint64_t first_index, MaskBatch& must) {
  // The fast rasterizer snaps in one way only. For other rules it is given vertices that are snapped already, and the
  // oracle that shares no code with that snap sees to it being right.
  const bool other_snap = scene.rules != Rules{scene.rules.subpixel_bits};
  if (fast_ && other_snap) snap_all(scene);
  const Scene& drawn_scene = other_snap ? snapped_ : scene;
  if (fast_ && !fast_->refusal(drawn_scene)) {
    if (auto drawn = fast_->draw(drawn_scene, must); !drawn) return drawn;
  } else {
    must.reset(MaskLayout(scene.setting), scene.triangles.size());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      oracle::cover_by_definition(scene.setting, scene.rules, scene.triangles[i], must[i]);
    }
  }
  return confirm_share(scene, first_index, MaskBatchView(must));
}

tl::expected<void, Error> Reference::confirm_share(const Scene& scene, std::uint64_t first_index,
                                                   const DrawnMasks& masks) {
  for (std::size_t i = (kOracleShare - first_index % kOracleShare) % kOracleShare; i < scene.triangles.size();
       i += kOracleShare) {
    if (auto confirmed = confirm_window(scene, i, masks.whole(i, 1, whole_)[0]); !confirmed) return confirmed;
  }
  return {};
}

void Reference::snap_all(const Scene& scene) {
  snapped_.setting = scene.setting;
  snapped_.rules = Rules{scene.rules.subpixel_bits};
  snapped_.triangles = scene.triangles;
  const float scale = std::ldexp(1.0f, scene.rules.subpixel_bits);
  if (all_on_grid(scene.triangles, scale)) return;
  for (Triangle& triangle : snapped_.triangles) {
    for (Position& position : triangle) position = snapped(scene.rules, position);
  }
}

tl::expected<void, Error> Reference::confirm(const Scene& scene, std::size_t index, MaskView must) {
  if (!scene.clip) return confirm_window(scene, index, must);
  for (std::size_t part = window_->first[index]; part < window_->first[index + 1]; ++part) {
    if (auto confirmed = confirm_window(window_->scene, part, parts_[part]); !confirmed) return confirmed;
  }
  return {};
}

tl::expected<void, Error> Reference::confirm_window(const Scene& scene, std::size_t index, MaskView must) {
  const Triangle& triangle = scene.triangles[index];
  scratch_.resize(must.size());
  ++confirmed_;
  oracle::cover_by_definition(scene.setting, scene.rules, triangle, scratch_);
  if (!std::ranges::equal(scratch_, must)) {
    return tl::unexpected(
        Error{ErrorKind::subject,
              fmt::format("the fast answer and the oracle by definition differ on {}", coordinates(triangle))});
  }
  oracle::cover_by_shift(scene.setting, scene.rules, triangle, scratch_);
  if (!std::ranges::equal(scratch_, must)) {
    return tl::unexpected(
        Error{ErrorKind::subject, fmt::format("the oracles differ from each other on {}", coordinates(triangle))});
  }
  return {};
}

}  // namespace edgecase::conformance
