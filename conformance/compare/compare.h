// Comparison of observed masks with expected ones, bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/scene/mask.h"

namespace edgecase::conformance {

/// One sample that a subject got wrong.
struct WrongSample {
  enum class Kind {
    missing,     ///< the rules cover it, the subject did not
    unexpected,  ///< the subject covered it, the rules do not
    doubled,     ///< inside a mesh, covered by more than one of its triangles
  };
  Kind kind = Kind::missing;
  /// Index of the triangle at fault. For a sample missing from a mesh as a whole: the mesh's first triangle.
  std::size_t triangle = 0;
  /// Pixel column and row from the target's top-left pixel, and the sample's index within the pixel.
  int x = 0;
  int y = 0;
  int sample = 0;
  friend bool operator==(const WrongSample&, const WrongSample&) = default;
};

/// `missing`, `unexpected` or `doubled`.
const char* name_of(WrongSample::Kind kind);

/// One line for a person: "missing: pixel (12, 7), sample 0, triangle 5".
std::string describe(const WrongSample& wrong);

/// Running totals over any number of batches.
struct Comparison {
  std::uint64_t triangles = 0;
  /// Samples that the rules decide: what they leave open was not compared and is not counted.
  std::uint64_t samples_compared = 0;
  std::uint64_t missing = 0;
  std::uint64_t unexpected = 0;
  /// Only a mesh can have doubled samples; comparing triangles one by one never adds any.
  std::uint64_t doubled = 0;
  std::uint64_t wrong_triangles = 0;
  /// The first in the order of comparison: by triangle, then row, column and sample.
  std::optional<WrongSample> first;

  bool all_right() const { return missing == 0 && unexpected == 0 && doubled == 0; }
  std::uint64_t wrong_samples() const { return missing + unexpected + doubled; }
  /// Adds the totals of work that comes after this one's, so that `first` stays the first.
  void add(const Comparison& later);
};

/// Compares the masks of a batch with what the rules say and adds the outcome to `total`.
///
/// Each span holds whole masks in `layout`, one after the other, as MaskBatch::data() gives them; `must` and `observed`
/// are equally long, and `may` as well unless it is empty. A sample in `must` has to be covered. One in `may` but not
/// in `must` is left open, and any other has to stay uncovered. Padding bits are no samples: whatever they hold is
/// ignored. `first_triangle` is the index that the first mask's triangle has in the report. `firsts`, if given, gets
/// the first wrong sample of each wrong triangle appended.
void compare_masks(const MaskLayout& layout, std::span<const std::uint64_t> must, std::span<const std::uint64_t> may,
                   std::span<const std::uint64_t> observed, std::size_t first_triangle, Comparison& total,
                   std::vector<WrongSample>* firsts = nullptr);

}  // namespace edgecase::conformance
