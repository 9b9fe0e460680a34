#include "conformance/metamorphic/metamorphosis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "conformance/generators/generator.h"

namespace edgecase::conformance {
namespace {

// Same setting and rules as the base scene, no triangles yet.
Scene& add_variant(Experiment& experiment) {
  Scene scene;
  scene.setting = experiment.base.setting;
  scene.rules = experiment.base.rules;
  return experiment.variants.emplace_back(std::move(scene));
}

// A variant whose triangle i is change(triangle i of the base).
template <class Change>
void add_changed(Experiment& experiment, const Change& change) {
  Scene& variant = add_variant(experiment);
  for (const Triangle& triangle : experiment.base.triangles) {
    experiment.pieces.push_back({variant.triangles.size(), experiment.variants.size() - 1, variant.triangles.size()});
    variant.triangles.push_back(change(triangle));
  }
}

// Whole pixels and lattice points of these sizes add up exactly in binary32.
Triangle shifted(const Triangle& triangle, int dx, int dy) {
  Triangle result = triangle;
  for (Position& p : result) p = {p.x + static_cast<float>(dx), p.y + static_cast<float>(dy)};
  return result;
}

void translation(const Lattice&, Random& random, Experiment& experiment) {
  const auto dx = static_cast<int>(random.between(-12, 12));
  const auto dy = static_cast<int>(random.between(-12, 12));
  add_changed(experiment, [&](const Triangle& triangle) { return shifted(triangle, dx, dy); });
  for (Piece& piece : experiment.pieces) {
    piece.dx = -dx;
    piece.dy = -dy;
  }
}

void rotation(const Lattice&, Random& random, Experiment& experiment) {
  const bool twice = random.one_in(2);
  add_changed(experiment, [&](const Triangle& t) {
    return twice ? Triangle{t[2], t[0], t[1]} : Triangle{t[1], t[2], t[0]};
  });
}

void winding(const Lattice&, Random&, Experiment& experiment) {
  add_changed(experiment, [](const Triangle& t) { return Triangle{t[0], t[2], t[1]}; });
}

void order(const Lattice&, Random&, Experiment& experiment) {
  add_changed(experiment, [](const Triangle& t) { return t; });
  std::ranges::reverse(experiment.variants.back().triangles);
  for (Piece& piece : experiment.pieces) piece.triangle = experiment.base.triangles.size() - 1 - piece.triangle;
}

// The target cut into four by a random column and a random row.
std::array<Rect, 4> quarters(const Extent& target, Random& random) {
  const auto x = static_cast<int>(random.between(1, target.width - 1));
  const auto y = static_cast<int>(random.between(1, target.height - 1));
  return {Rect{0, 0, x, y}, Rect{x, 0, target.width - x, y}, Rect{0, y, x, target.height - y},
          Rect{x, y, target.width - x, target.height - y}};
}

void order_pieces(Experiment& experiment) { std::ranges::stable_sort(experiment.pieces, {}, &Piece::base); }

void tiles(const Lattice&, Random& random, Experiment& experiment) {
  for (const Rect& tile : quarters(experiment.base.setting.target, random)) {
    const std::size_t first = experiment.pieces.size();
    add_changed(experiment, [&](const Triangle& triangle) { return shifted(triangle, -tile.x, -tile.y); });
    experiment.variants.back().setting.target = {tile.width, tile.height};
    for (Piece& piece : std::span(experiment.pieces).subspan(first)) {
      piece.dx = tile.x;
      piece.dy = tile.y;
    }
  }
  order_pieces(experiment);
}

void scissor(const Lattice&, Random& random, Experiment& experiment) {
  for (const Rect& tile : quarters(experiment.base.setting.target, random)) {
    add_changed(experiment, [](const Triangle& triangle) { return triangle; });
    experiment.variants.back().setting.scissor = tile;
  }
  order_pieces(experiment);
}

// The middle of an edge is a lattice point if its ends agree in the parity of both coordinates: the second and third
// vertices are moved by at most one unit to agree with the first. New vertices then lie exactly on the old edges.
void refinement(const Lattice& lattice, Random& random, Experiment& experiment) {
  const int bits = experiment.base.rules.subpixel_bits;
  const auto point = [&](const Position& p) {
    return LatticePoint{std::llround(std::ldexp(p.x, bits)), std::llround(std::ldexp(p.y, bits))};
  };
  const auto middle = [](const LatticePoint& p, const LatticePoint& q) {
    return LatticePoint{(p.x + q.x) / 2, (p.y + q.y) / 2};
  };
  Scene& variant = add_variant(experiment);
  for (std::size_t i = 0; i < experiment.base.triangles.size(); ++i) {
    Triangle& whole = experiment.base.triangles[i];
    const LatticePoint a = point(whole[0]);
    LatticePoint b = point(whole[1]);
    LatticePoint c = point(whole[2]);
    for (LatticePoint* p : {&b, &c}) {
      p->x += (p->x ^ a.x) & 1;
      p->y += (p->y ^ a.y) & 1;
    }
    whole = lattice.triangle(a, b, c);
    const LatticePoint ab = middle(a, b);
    const LatticePoint bc = middle(b, c);
    const LatticePoint ca = middle(c, a);
    const auto part = [&](const LatticePoint& p, const LatticePoint& q, const LatticePoint& r) {
      experiment.pieces.push_back({i, 0, variant.triangles.size()});
      variant.triangles.push_back(lattice.triangle(p, q, r));
    };
    if (random.one_in(2)) {
      part(a, ab, c);
      part(ab, b, c);
    } else {
      part(a, ab, ca);
      part(ab, b, bc);
      part(bc, c, ca);
      part(ab, bc, ca);
    }
  }
}

}  // namespace

std::span<const Metamorphosis> metamorphoses() {
  static constexpr std::array all{
      Metamorphosis{"translation", "moved by whole pixels: the mask moves along", translation},
      Metamorphosis{"vertex_rotation", "drawn from another vertex on: the same mask", rotation},
      Metamorphosis{"winding_reversal", "wound the other way: the same mask", winding},
      Metamorphosis{"drawing_order", "drawn last to first: the same masks", order},
      Metamorphosis{"tiles", "the target cut into four smaller ones: together the same mask", tiles},
      Metamorphosis{"scissor_tiles", "the target cut into four scissor rectangles: together the same mask", scissor},
      Metamorphosis{"edge_refinement", "cut at the middles of edges: together the same mask, no sample twice",
                    refinement},
  };
  return all;
}

const Metamorphosis* find_metamorphosis(std::string_view name) {
  const auto found = std::ranges::find(metamorphoses(), name, &Metamorphosis::name);
  return found == metamorphoses().end() ? nullptr : &*found;
}

Experiment make_experiment(const Metamorphosis& metamorphosis, const Rules& rules, std::uint64_t seed,
                           std::uint64_t index, std::size_t triangles) {
  static constexpr std::array<std::string_view, 6> kSources{"fan", "random", "ties", "sliver", "tiny", "grid"};
  Random random = Random::stream(seed, metamorphosis.name, index);
  Experiment experiment;
  experiment.base.rules = rules;
  while (experiment.base.triangles.size() < triangles) {
    const Generator* source =
        find_generator(kSources[static_cast<std::size_t>(random.between(0, kSources.size() - 1))]);
    experiment.base.setting = source->setting;
    append_scene(*source, random.next(), 0, experiment.base);
  }
  experiment.base.meshes.clear();
  const Lattice lattice(experiment.base.setting.target, rules.subpixel_bits);
  metamorphosis.pose(lattice, random, experiment);
  return experiment;
}

}  // namespace edgecase::conformance
