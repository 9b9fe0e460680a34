// Contender: a rasterizer that is timed, and whose error is counted, on a workload.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// The baseline of every ratio: edge functions stepped from pixel to pixel over the bounding box, a byte per pixel; in
/// scalar code, as the articles write it.
inline constexpr std::string_view kPlain = "plain";
/// The same source as the compiler vectorizes it, for the widest instruction set that the machine has.
inline constexpr std::string_view kPlainVectorized = "plain:vectorized";

/// The subpixel bits of which speed and error are compared.
inline constexpr std::array kSubpixelBits{0, 2, 4, 6, 8, 10, 12, 16};

/// The vectorized plain loop in the format 16.`bits`: `plain:vectorized` for 8, else `plain:bitsN`.
std::string plain_name(int bits);

/// Whose time counts: that of the calling thread, which leaves out what other processes took of the processor; the time
/// that passes; or what the driver itself took, from submission to the last sample (Subject::driver_seconds).
enum class Clock { thread, wall, driver };

class Contender {
 public:
  virtual ~Contender() = default;

  /// As on the command line: `plain`, `edgecase:NAME`, `inexact:NAME`, or the name of a subject.
  virtual std::string name() const = 0;
  /// The instruction set that it was compiled for or has chosen, in lower case; empty if that is not ours to know.
  virtual std::string isa() const = 0;
  /// Known after the first draw.
  virtual Clock clock() const { return Clock::thread; }
  /// Of all draws so far, for Clock::driver.
  virtual double driver_seconds() const { return 0; }
  /// How many of a scene's triangles, from the first on, it can be given at once.
  virtual std::size_t most_triangles(const Scene& scene) const { return scene.triangles.size(); }
  /// What it draws on, if that is not the scene's target.
  virtual std::optional<Extent> target() const { return std::nullopt; }

  /// Takes the triangles over in the form it draws from; not timed. An error if it cannot draw them.
  virtual tl::expected<void, Error> prepare(const Scene& scene) = 0;
  /// Makes ready for the next draw(); not timed.
  virtual void clear() = 0;
  /// Puts a short list into another order, in which it is drawn from now on; not timed. cover() numbers the triangles
  /// as before only until then.
  virtual void shuffle(std::mt19937_64&) {}
  /// Draws all triangles: this is what is timed.
  virtual tl::expected<void, Error> draw() = 0;
  /// Adds the coverage of triangle i alone to a mask of the scene's layout; not timed. Preceded by a draw().
  virtual void cover(std::size_t i, MutableMaskView mask) = 0;
};

/// Everything that needs no driver: plain, scalar and vectorized, the fast path, best and by instruction set, the
/// family, the inexact arithmetics, and vectorized plain in other formats.
std::vector<std::unique_ptr<Contender>> built_in_contenders();

/// A subject as a contender. It draws every triangle into a mask of its own, on the smallest target that each triangle
/// of the scene fits on, to which it is moved by whole pixels: on the whole screen, making and reading the masks would
/// be all the time. What is timed is the driver, where it has a clock of its own, and else all of the subject's work.
/// Either way that is another job than a union in one mask: such times are comparable with each other, and beside
/// the rasterizers' an upper bound.
std::unique_ptr<Contender> make_subject_contender(std::unique_ptr<Subject> subject);

}  // namespace edgecase::conformance
