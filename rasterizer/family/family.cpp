#include "rasterizer/family/family.h"

#include <algorithm>
#include <iterator>

#include "rasterizer/family/coarse_fine.h"
#include "rasterizer/family/lanes4.h"
#include "rasterizer/family/larrabee.h"
#include "rasterizer/family/orient2d.h"
#include "rasterizer/family/quads.h"
#include "rasterizer/family/stamp.h"
#include "rasterizer/family/trapezoid.h"
#include "rasterizer/scalar.h"

namespace edgecase::rasterizer {
namespace {

using F = Format16_8;

/// `Cover` is called as Cover(triangle, target, sink).
template <auto Cover>
void cover_one(const FixedTriangle<F>& triangle, const Mask& mask) {
  Cover(triangle, mask.target(), [&](int y, int word, std::uint64_t bits) { mask.add(y, word, bits); });
}

template <auto Cover>
void cover_all(std::span<const FixedTriangle<F>> triangles, const Mask& mask) {
  for (const FixedTriangle<F>& triangle : triangles) cover_one<Cover>(triangle, mask);
}

template <auto Cover>
constexpr FamilyMember member(std::string_view name, std::string_view about, std::string_view source) {
  return {name, about, source, &cover_one<Cover>, &cover_all<Cover>};
}

constexpr FamilyMember kFamily[] = {
    member<[](auto&&... arguments) { family::cover_orient2d<F>(arguments...); }>(
        "orient2d", "orient2d for each edge and each pixel of the bounding box",
        "Giesen, Triangle rasterization in practice, 2013"),
    member<[](const FixedTriangle<F>& triangle, const Target& target, auto&& sink) {
      cover_scalar<F>(triangle, View<>{target}, sink);
    }>("scalar", "edge functions stepped incrementally: three adds and one or per pixel",
       "Giesen, Optimizing the basic rasterizer, 2013"),
    member<[](auto&&... arguments) { family::cover_lanes4<F>(arguments...); }>(
        "lanes4", "four pixels of a row at a time", "Giesen, Optimizing the basic rasterizer, 2013"),
    member<[](auto&&... arguments) { family::cover_quads<F>(arguments...); }>(
        "quads", "two by two pixels at a time", "Giesen, A trip through the graphics pipeline 2011, parts 6 and 8"),
    member<[](auto&&... arguments) { family::cover_coarse_fine<F>(arguments...); }>(
        "coarse_fine", "8x8 blocks by the edge functions' bounds at corners, then their pixels",
        "Giesen, A trip through the graphics pipeline 2011, part 6"),
    member<[](auto&&... arguments) { family::cover_larrabee<F>(arguments...); }>(
        "larrabee", "descent from 64x64 to 16x16 to 4x4 pixels, 16 children at a time, in 32 bits",
        "Abrash, Rasterization on Larrabee, 2009"),
    member<[](auto&&... arguments) { family::cover_stamp<F>(arguments...); }>(
        "stamp", "a stamp of 4x4 pixels swept row by row over the triangle",
        "Pineda, A parallel algorithm for polygon rasterization, 1988"),
    member<[](auto&&... arguments) { family::cover_trapezoid<F>(arguments...); }>(
        "trapezoid", "scan lines between edges stepped by integer quotient and remainder",
        "Abrash, Graphics Programming Black Book, 1997, chapters 38 and 39"),
};

}  // namespace

std::span<const FamilyMember> family_members() { return kFamily; }

const FamilyMember* find_family_member(std::string_view name) {
  const auto found = std::ranges::find(kFamily, name, &FamilyMember::name);
  return found == std::end(kFamily) ? nullptr : found;
}

}  // namespace edgecase::rasterizer
