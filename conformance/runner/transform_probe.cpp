#include "conformance/runner/transform_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "conformance/generators/random.h"
#include "conformance/models/clip_model.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/standard_samples.h"

namespace edgecase::conformance {
namespace {

constexpr Extent kTarget{16, 16};
// Of each scene: first tries, and triangles kept although they part none that were together.
constexpr int kFirstTries = 60;
constexpr int kExtra = 30;
// Further tries in all, if some candidates have not been parted by then.
constexpr int kFurtherTries = 40'000;

// All around the target, so that no driver's viewport hides a pixel of it: a power of two, no power of two, fractional,
// large, upside down. The middle of the third lies just above powers of two. Near the middle, ndc is small and has many
// bits; and x - 1/2 has one bit more than x, so that it matters which of the two is rounded.
constexpr std::array kViewports{Viewport{-24, -24, 64, 64},       Viewport{-40, -30, 100, 75},
                                Viewport{-24, -28, 64.3F, 64.6F}, Viewport{-17.3F, -21.7F, 47.1F, 53.9F},
                                Viewport{-150, -90, 300, 200},    Viewport{-20.7F, 40.1F, 57.3F, -61.7F}};

struct Axis {
  double origin = 0;
  double extent = 0;
};

Axis axis_of(const Viewport& viewport, bool vertical) {
  if (vertical) return {static_cast<double>(viewport.y), static_cast<double>(viewport.height)};
  return {static_cast<double>(viewport.x), static_cast<double>(viewport.width)};
}

class Prober {
 public:
  Prober(std::span<const TransformModel> candidates, int samples, const Subject& subject)
      : candidates_(candidates), subject_(subject), random_(Random::stream(1, "transform", 0)) {
    for (const TransformModel& candidate : candidates) {
      const int bits = candidate.rules.subpixel_bits;
      if (std::ranges::find(bits_, bits) == bits_.end()) bits_.push_back(bits);
    }
    setting_.target = kTarget;
    const auto locations = standard_sample_locations(samples);
    setting_.sample_locations.assign(locations.begin(), locations.end());
    probe_.group.resize(candidates.size());
  }

  TransformProbe make() {
    add_scene(nullptr);
    for (const Viewport& viewport : kViewports) add_scene(&viewport);
    if (probe_.scenes.empty()) return {};
    std::vector<std::size_t> everybody(candidates_.size());
    std::iota(everybody.begin(), everybody.end(), std::size_t{0});
    for (std::size_t scene = 0; scene < probe_.scenes.size(); ++scene) {
      int extra = kExtra;
      for (int i = 0; i < kFirstTries; ++i) attempt(scene, any_of(bits_), everybody, extra);
    }
    std::vector<std::size_t> together = not_alone();
    for (int i = 0; i < kFurtherTries && !together.empty(); ++i) {
      int extra = 0;
      const auto scene = any_below(probe_.scenes.size());
      const int bits = candidates_[together[any_below(together.size())]].rules.subpixel_bits;
      if (attempt(scene, bits, together, extra)) together = not_alone();
    }
    std::erase_if(probe_.scenes, [](const Scene& scene) { return triangle_count(scene) == 0; });
    return std::move(probe_);
  }

 private:
  std::size_t any_below(std::size_t size) {
    return static_cast<std::size_t>(random_.between(0, static_cast<std::int64_t>(size) - 1));
  }
  int any_of(const std::vector<int>& values) { return values[any_below(values.size())]; }

  void add_scene(const Viewport* viewport) {
    Scene scene;
    scene.setting = setting_;
    scene.rules = candidates_.front().rules;
    if (viewport != nullptr) scene.clip = ClipGeometry{*viewport, {}};
    if (!subject_.refusal(scene)) probe_.scenes.push_back(std::move(scene));
  }

  // Candidates that share their group with another.
  std::vector<std::size_t> not_alone() const {
    std::map<std::size_t, std::size_t> members;
    for (const std::size_t group : probe_.group) ++members[group];
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < probe_.group.size(); ++i) {
      if (members[probe_.group[i]] > 1) result.push_back(i);
    }
    return result;
  }

  // Makes a triangle at random, and keeps it if it parts some of `asked`, or, while `extra` lasts, if it tells any two
  // of them apart. True if it parts some.
  bool attempt(std::size_t index, int bits, const std::vector<std::size_t>& asked, int& extra) {
    Scene& scene = probe_.scenes[index];
    Scene one;
    one.setting = setting_;
    one.rules = scene.rules;
    if (scene.clip) one.clip = ClipGeometry{scene.clip->viewport, {}};
    append(one, bits);
    const std::vector<std::size_t> parted = part(one, asked);
    if (std::ranges::max(parted) == 0 || subject_.refusal(one)) return false;
    const bool refines = refine(parted, asked);
    if (!refines && extra == 0) return false;
    if (!refines) --extra;
    if (scene.clip) {
      scene.clip->triangles.push_back(one.clip->triangles.front());
    } else {
      scene.triangles.push_back(one.triangles.front());
    }
    return refines;
  }

  // A coordinate p near a tie is snapped to one of two grid points, t or t + 1 units. With q the mirror image in a
  // sample of one of them, the edge from p to q passes through the sample or beside it. Where q and the other
  // coordinates go no candidate doubts: they lie a little above a grid point of the finest grid, and above half a
  // pixel, so that even truncation leads there.
  void append(Scene& scene, int bits) {
    const double unit = std::ldexp(1.0, -bits);
    const double above = std::ldexp(0.25, -std::ranges::max(bits_));
    const SampleLocation& location = setting_.sample_locations[any_below(setting_.sample_locations.size())];
    const bool vertical = random_.one_in(2);
    const auto whole = [&] { return static_cast<double>(random_.between(7, 8)); };
    const double along = whole() + (vertical ? location.y : location.x) / 16.0;
    const double across = whole() + (vertical ? location.x : location.y) / 16.0;
    const double p = grid_point(bits) + beside(unit);
    const double q = 2 * along - (std::floor(p / unit) + static_cast<double>(random_.between(0, 1))) * unit;
    const double half = static_cast<double>(random_.between(2, 5));
    const double far = random_.one_in(2) ? p + 9 : p - 9;
    const std::array<std::array<double, 2>, 3> corners{
        {{p, across - half + above}, {q + above, across + half + above}, {far, across - half + above}}};
    const float w = random_.one_in(3) ? static_cast<float>(random_.between(3, 40)) / 8 : 1;
    Triangle window;
    ClipTriangle clip;
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = vertical ? corners[i][1] : corners[i][0];
      const double y = vertical ? corners[i][0] : corners[i][1];
      window[i] = {static_cast<float>(x), static_cast<float>(y)};
      if (!scene.clip) continue;
      const auto to_clip = [&](double at, bool is_y) {
        const Axis axis = axis_of(scene.clip->viewport, is_y);
        return static_cast<float>((at - axis.origin) / axis.extent * 2 - 1) * w;
      };
      clip[i] = {to_clip(x, false), to_clip(y, true), 0.5F * w, w};
    }
    if (!scene.clip) {
      float& near_tie = vertical ? window[0].y : window[0].x;
      near_tie = nudged(near_tie);
      scene.triangles.push_back(window);
    } else {
      float& near_tie = vertical ? clip[0].y : clip[0].x;
      near_tie = nudged(near_tie);
      scene.clip->triangles.push_back(clip);
    }
  }

  // Anywhere; around 0, where binary32 has the most bits below the grid; or just above a power of two.
  double grid_point(int bits) {
    const auto units = [&](std::int64_t low, std::int64_t high) {
      return std::ldexp(static_cast<double>(random_.between(low, high)), -bits);
    };
    if (random_.one_in(3)) return units(-3, 3);
    if (random_.one_in(2)) return std::ldexp(1.0, static_cast<int>(random_.between(0, 3))) + units(0, (1 << bits) / 2);
    return units(-4 * (1 << bits), 20 * (1 << bits));
  }

  // Where the nearest point changes, or where the one towards zero does, and a very little beside it; or where the two
  // differ.
  double beside(double unit) {
    if (random_.one_in(6)) return 0.75 * unit;
    const double change = random_.one_in(3) ? 0 : 0.5 * unit;
    if (random_.one_in(3)) return change;
    const double little = std::ldexp(1.0, static_cast<int>(-random_.between(17, 27)));
    return change + (random_.one_in(2) ? little : -little);
  }

  float nudged(float value) {
    const std::int64_t steps = random_.between(-2, 2);
    for (std::int64_t i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, steps < 0 ? -1e9F : 1e9F);
    return value;
  }

  // A number for each of the candidates `asked`, from 0 up: the same for those that predict the same mask of the
  // scene's only triangle.
  std::vector<std::size_t> part(const Scene& scene, const std::vector<std::size_t>& asked) {
    std::map<std::array<float, 6>, std::size_t> known;
    std::map<std::vector<std::uint64_t>, std::size_t> numbers;
    std::vector<std::size_t> result;
    for (const std::size_t i : asked) {
      const TransformModel& candidate = candidates_[i];
      const Triangle t = in_window(candidate, scene);
      const auto [entry, is_new] = known.try_emplace({t[0].x, t[0].y, t[1].x, t[1].y, t[2].x, t[2].y});
      if (is_new) {
        std::vector<std::uint64_t> mask(MaskLayout(setting_).words());
        oracle::cover_by_definition(setting_, {candidate.rules.subpixel_bits}, t, mask);
        entry->second = numbers.try_emplace(mask, numbers.size()).first->second;
      }
      result.push_back(entry->second);
    }
    return result;
  }

  // Where the candidate has the scene's only triangle; without area, if it predicts nothing.
  Triangle in_window(const TransformModel& candidate, const Scene& scene) {
    Triangle result{};
    if (scene.clip) {
      in_window_.clear();
      append_window_triangles(candidate, setting_, scene.clip->viewport, scene.clip->triangles.front(), in_window_);
      return in_window_.empty() ? result : in_window_.front().triangle;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = snapped(candidate, setting_, scene.triangles.front()[i]);
      if (!at) return {};
      result[i] = *at;
    }
    return result;
  }

  // Gives those of a group that `parted` tells from its first one new groups; false if there are none.
  bool refine(const std::vector<std::size_t>& parted, const std::vector<std::size_t>& asked) {
    std::map<std::size_t, std::size_t> first;                            // of each group
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> numbers;  // of what parts from it
    const std::size_t before = groups_;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      std::size_t& group = probe_.group[asked[i]];
      if (first.try_emplace(group, parted[i]).first->second == parted[i]) continue;
      const auto [entry, is_new] = numbers.try_emplace({group, parted[i]}, groups_);
      if (is_new) ++groups_;
      group = entry->second;
    }
    return groups_ != before;
  }

  std::span<const TransformModel> candidates_;
  const Subject& subject_;
  Random random_;
  std::vector<int> bits_;
  Setting setting_;
  TransformProbe probe_;
  std::size_t groups_ = 1;
  std::vector<WindowTriangle> in_window_;
};

}  // namespace

std::vector<TransformModel> transform_candidates(int reported_bits, bool clip_space) {
  std::vector<int> bits{reported_bits};
  for (const int other : {reported_bits - 1, reported_bits + 1, reported_bits + 2, 8, 7, 6, 5, 4}) {
    if (other >= 1 && std::ranges::find(bits, other) == bits.end()) bits.push_back(other);
  }
  std::vector<TransformModel> all;
  for (const int subpixel_bits : bits) {
    for (const SnapRounding rounding :
         {SnapRounding::nearest_even, SnapRounding::half_up, SnapRounding::half_away, SnapRounding::truncate}) {
      for (const HalfPixelShift shift :
           {HalfPixelShift::none, HalfPixelShift::before_scaling, HalfPixelShift::within_viewport}) {
        for (const MultiplyAdd multiply_add : {MultiplyAdd::separate, MultiplyAdd::fused}) {
          const bool distinct = shift != HalfPixelShift::within_viewport && multiply_add == MultiplyAdd::separate;
          if (!clip_space && !distinct) continue;
          TransformModel model;
          model.rules = {subpixel_bits, rounding};
          model.multiply_add = multiply_add;
          model.shift = model.multisample_shift = shift;
          all.push_back(model);
        }
      }
    }
  }
  return all;
}

TransformProbe transform_probe(std::span<const TransformModel> candidates, int samples, const Subject& subject) {
  return Prober(candidates, samples, subject).make();
}

}  // namespace edgecase::conformance
