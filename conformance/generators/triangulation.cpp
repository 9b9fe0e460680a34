#include "conformance/generators/triangulation.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace edgecase::conformance {

Triangulation::Triangulation(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d)
    : points_{a, b, c, d}, faces_{{{0, 1, 2}, {kRim, kRim, 1}}, {{0, 2, 3}, {0, kRim, kRim}}} {
  assert(orientation(a, b, c) > 0 && orientation(a, c, d) > 0);
}

std::uint32_t Triangulation::add_point(const LatticePoint& p) {
  points_.push_back(p);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

std::uint32_t Triangulation::add_face(const Face& face) {
  faces_.push_back(face);
  return static_cast<std::uint32_t>(faces_.size() - 1);
}

void Triangulation::relink(std::uint32_t face, std::uint32_t old_neighbour, std::uint32_t new_neighbour) {
  if (face == kRim) return;
  std::replace(faces_[face].neighbours.begin(), faces_[face].neighbours.end(), old_neighbour, new_neighbour);
}

std::size_t Triangulation::edge_towards(std::uint32_t face, std::uint32_t neighbour) const {
  const auto& all = faces_[face].neighbours;
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), neighbour) - all.begin());
}

bool Triangulation::split_face(std::size_t index, Random& random) {
  const auto id = static_cast<std::uint32_t>(index);
  const Face face = faces_[index];
  const LatticePoint& a = point(face, 0);
  const LatticePoint& b = point(face, 1);
  const LatticePoint& c = point(face, 2);
  std::int64_t u = random.between(1, 1023);
  std::int64_t v = random.between(1, 1023);
  if (u + v >= 1024) {
    u = 1024 - u;
    v = 1024 - v;
  }
  const LatticePoint p{a.x + ((b.x - a.x) * u + (c.x - a.x) * v) / 1024,
                       a.y + ((b.y - a.y) * u + (c.y - a.y) * v) / 1024};
  if (orientation(a, b, p) <= 0 || orientation(b, c, p) <= 0 || orientation(c, a, p) <= 0) return false;

  const std::uint32_t q = add_point(p);
  const std::uint32_t second = add_face({{face.vertices[1], face.vertices[2], q}, {}});
  const std::uint32_t third = add_face({{face.vertices[2], face.vertices[0], q}, {}});
  faces_[id] = {{face.vertices[0], face.vertices[1], q}, {face.neighbours[0], second, third}};
  faces_[second].neighbours = {face.neighbours[1], third, id};
  faces_[third].neighbours = {face.neighbours[2], id, second};
  relink(face.neighbours[1], id, second);
  relink(face.neighbours[2], id, third);
  return true;
}

bool Triangulation::split_edge(std::size_t index, std::size_t edge) {
  const auto id = static_cast<std::uint32_t>(index);
  const Face face = faces_[index];
  const LatticePoint sum{point(face, edge).x + point(face, edge + 1).x, point(face, edge).y + point(face, edge + 1).y};
  if (sum.x % 2 != 0 || sum.y % 2 != 0) return false;
  const std::uint32_t middle = add_point({sum.x / 2, sum.y / 2});

  // This face a, b, c with the edge a-b becomes a, m, c and m, b, c; the face beyond, b, a, d, likewise b, m, d and m,
  // a, d.
  const auto halve = [&](std::uint32_t f, std::size_t e) {
    const Face old = faces_[f];
    const std::uint32_t a = old.vertices[e];
    const std::uint32_t b = old.vertices[(e + 1) % 3];
    const std::uint32_t c = old.vertices[(e + 2) % 3];
    const std::uint32_t beyond_bc = old.neighbours[(e + 1) % 3];
    const std::uint32_t beyond_ca = old.neighbours[(e + 2) % 3];
    const std::uint32_t fresh = add_face({{middle, b, c}, {kRim, beyond_bc, f}});
    faces_[f] = {{a, middle, c}, {kRim, fresh, beyond_ca}};
    relink(beyond_bc, f, fresh);
    return fresh;
  };
  const std::uint32_t beyond = face.neighbours[edge];
  const std::size_t edge_beyond = beyond == kRim ? 0 : edge_towards(beyond, id);
  const std::uint32_t fresh = halve(id, edge);
  if (beyond == kRim) return true;
  const std::uint32_t fresh_beyond = halve(beyond, edge_beyond);
  // a-m is now edge 0 of this face and of the fresh face beyond, m-b edge 0 of the other two.
  faces_[id].neighbours[0] = fresh_beyond;
  faces_[fresh_beyond].neighbours[0] = id;
  faces_[fresh].neighbours[0] = beyond;
  faces_[beyond].neighbours[0] = fresh;
  return true;
}

bool Triangulation::flip_edge(std::size_t index, std::size_t edge) {
  const auto id = static_cast<std::uint32_t>(index);
  const Face face = faces_[index];
  const std::uint32_t other_id = face.neighbours[edge];
  if (other_id == kRim) return false;
  const Face other = faces_[other_id];
  const std::size_t other_edge = edge_towards(other_id, id);

  // a-b is shared: a, b, c on this side, b, a, d beyond. Afterwards: a, d, c and d, b, c.
  const std::uint32_t a = face.vertices[edge];
  const std::uint32_t b = face.vertices[(edge + 1) % 3];
  const std::uint32_t c = face.vertices[(edge + 2) % 3];
  const std::uint32_t d = other.vertices[(other_edge + 2) % 3];
  if (orientation(points_[a], points_[d], points_[c]) <= 0 || orientation(points_[d], points_[b], points_[c]) <= 0) {
    return false;
  }
  const std::uint32_t beyond_bc = face.neighbours[(edge + 1) % 3];
  const std::uint32_t beyond_ca = face.neighbours[(edge + 2) % 3];
  const std::uint32_t beyond_ad = other.neighbours[(other_edge + 1) % 3];
  const std::uint32_t beyond_db = other.neighbours[(other_edge + 2) % 3];
  faces_[id] = {{a, d, c}, {beyond_ad, other_id, beyond_ca}};
  faces_[other_id] = {{d, b, c}, {beyond_db, beyond_bc, id}};
  relink(beyond_ad, other_id, id);
  relink(beyond_bc, id, other_id);
  return true;
}

void Triangulation::append_to(Scene& scene, const Lattice& lattice, Random& random) const {
  const std::size_t first = scene.triangles.size();
  for (const Face& face : faces_) {
    const auto turn = static_cast<std::size_t>(random.between(0, 2));
    scene.triangles.push_back(lattice.triangle(point(face, turn), point(face, turn + 1), point(face, turn + 2)));
  }
  for (std::size_t i = faces_.size() - 1; i > 0; --i) {
    std::swap(scene.triangles[first + i],
              scene.triangles[first + static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(i)))]);
  }
  scene.meshes.push_back({first, faces_.size()});
}

}  // namespace edgecase::conformance
