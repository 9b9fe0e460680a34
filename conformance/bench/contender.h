// Contender: a rasterizer that is timed, and whose error is counted, on a workload.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// The baseline of every ratio: edge functions stepped from pixel to pixel over the bounding box, a byte per pixel.
inline constexpr std::string_view kPlain = "plain";

class Contender {
 public:
  virtual ~Contender() = default;

  /// As on the command line: `plain`, `edgecase:NAME`, `inexact:NAME`, or the name of a subject.
  virtual std::string name() const = 0;
  /// The instruction set that it was compiled for or has chosen, in lower case; empty if that is not ours to know.
  virtual std::string isa() const = 0;
  /// Whether the time that counts is that of the calling thread; otherwise it is the time that passes.
  virtual bool in_this_thread() const { return true; }
  /// The most triangles that it can be given at once.
  virtual std::size_t most_triangles() const { return static_cast<std::size_t>(-1); }

  /// Takes the triangles over in the form it draws from; not timed. An error if it cannot draw them.
  virtual tl::expected<void, Error> prepare(const Scene& scene) = 0;
  /// Makes ready for the next draw(); not timed.
  virtual void clear() = 0;
  /// Draws all triangles: this is what is timed.
  virtual tl::expected<void, Error> draw() = 0;
  /// Adds the coverage of triangle i alone to a mask of the scene's layout; not timed. Preceded by a draw().
  virtual void cover(std::size_t i, MutableMaskView mask) = 0;
};

/// Everything that needs no driver: plain, the family, the inexact arithmetics.
std::vector<std::unique_ptr<Contender>> built_in_contenders();

/// A subject as a contender. It draws a mask per triangle, and the time is that of all its work, clearing included:
/// comparable with other subjects', an upper bound beside the rasterizers that share one mask.
std::unique_ptr<Contender> make_subject_contender(std::unique_ptr<Subject> subject);

}  // namespace edgecase::conformance
