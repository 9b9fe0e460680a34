// Watertightness: a check of whole meshes that needs neither an oracle nor the fill rule.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "conformance/compare/compare.h"
#include "conformance/compare/outline.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/setting.h"

namespace edgecase::conformance {

/// Running totals over any number of meshes.
struct Watertightness {
  std::uint64_t meshes = 0;
  /// Meshes that were not judged because their snapped triangles do not cover the outline's inside exactly once: the
  /// grid is so coarse for them that snapping turned a triangle over, or the generator is wrong. See mesh_fault().
  std::uint64_t folded_meshes = 0;
  std::uint64_t wrong_meshes = 0;
  std::uint64_t samples_inside = 0;  ///< strictly inside an outline: these have to be covered exactly once
  std::uint64_t missing = 0;         ///< inside, and covered by no triangle: holes
  std::uint64_t doubled = 0;         ///< inside or on the outline, and covered by more than one triangle
  std::uint64_t unexpected = 0;      ///< strictly outside, and covered
  std::optional<WrongSample> first_missing;
  std::optional<WrongSample> first_doubled;     ///< its triangle is the second one that covers the sample
  std::optional<WrongSample> first_unexpected;  ///< its triangle is the first one that covers the sample

  bool watertight() const { return missing == 0 && doubled == 0 && unexpected == 0; }
  /// Adds the totals of meshes that come after this one's.
  void add(const Watertightness& later);
};

/// Checks meshes in one setting. Samples strictly inside a mesh's outline have to be covered exactly once, those
/// strictly outside never, and those on the outline at most once, whatever the fill rule. Inside is where the outline's
/// winding number, computed in exact integers, is 1, and the scissor, if there is one, leaves the pixel. Culling is not
/// regarded: a culled mesh has to be left out. Holds only memory that is used again from mesh to mesh.
class WatertightChecker {
 public:
  /// `subpixel_bits` of the grid that the meshes are snapped to, 0 to 16.
  WatertightChecker(const Setting& setting, int subpixel_bits);

  /// Whether another one made with these would do the same.
  bool is_for(const Setting& setting, int subpixel_bits) const {
    return setting_ == setting && subpixel_bits_ == subpixel_bits;
  }

  /// Checks one mesh and adds the outcome to `total`. `masks` holds the observed mask of each triangle, in order, as
  /// MaskBatch::data() has them. `first_triangle` is the index that the first triangle has in the report. Samples in
  /// `open`, a mask, may lie inside or outside; none do if it is empty. They count as those on the outline do.
  void check(std::span<const GridTriangle> mesh, std::span<const std::uint64_t> masks, std::size_t first_triangle,
             Watertightness& total, MaskView open = {});

 private:
  /// Fills inside_ and outline_; returns false if the outline winds neither 0 nor 1 times around some sample.
  template <typename Int>
  bool classify(std::span<const OutlineEdge> outline, int turn);
  template <typename Int>
  void scan_edge(const OutlineEdge& edge, int turn, const SampleLocation& location, std::size_t sample);
  /// Sets all winding numbers to 0, with room for what the edges may add.
  void reset_windings(std::span<const OutlineEdge> outline);
  /// Adds `winding`, at least -2 and at most 2, to the samples in `pattern` from `first_bit` of a row on: to those
  /// right of an edge of the outline, or on it.
  void add_winding(std::size_t row, std::size_t first_bit, int winding, const std::uint64_t* pattern);
  /// Fills inside_; returns false if a winding number is neither 0 nor 1.
  bool fill_inside();
  void count_layers(std::span<const std::uint64_t> masks);
  WrongSample locate(WrongSample::Kind kind, std::size_t word, std::uint64_t bits, std::span<const std::uint64_t> masks,
                     std::size_t first_triangle) const;

  Setting setting_;
  MaskLayout layout_;
  int subpixel_bits_;
  int scale_bits_;  ///< fraction bits of the grid that holds vertices and sample locations both
  OutlineBuilder builder_;
  std::vector<std::uint64_t> sample_words_;  ///< for each sample, one row with the bits of that sample set
  std::vector<std::uint64_t> drawn_;         ///< those that the scissor leaves
  /// Each sample's winding number, in binary: digit p of all of them is mask p, a plane. Planes that are rarely used
  /// are zero between meshes.
  std::vector<std::uint64_t> windings_;
  std::size_t planes_ = 0;              ///< of the present mesh
  std::size_t touched_planes_ = 0;      ///< of these, those that may differ from what reset_windings left
  std::vector<std::uint64_t> inside_;   ///< winding number 1; says nothing where outline_ is set
  std::vector<std::uint64_t> outline_;  ///< exactly on the outline
  std::vector<std::uint64_t> once_;     ///< covered by one triangle or more
  std::vector<std::uint64_t> twice_;    ///< covered by two triangles or more
};

}  // namespace edgecase::conformance
