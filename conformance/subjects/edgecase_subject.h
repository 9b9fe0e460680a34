// Our own rasterizer as a subject.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// `edgecase` for the variant "", the fast path for the best instruction set of this machine; `edgecase:portable`,
/// `edgecase:sse4`, `edgecase:avx2` and `edgecase:avx3`, the fast path for that one; `edgecase:scalar`, the incremental
/// reference; the member of the family for its name (family_subject.h). Null for any other variant, and for an
/// instruction set that is not available. The fast path takes every setting, and up to 8 subpixel bits; where a scene
/// has more of these, the scalar one stands in.
///
/// The first two follow the scene's subpixel bits, all of 0 to 16, with 16 integer bits: coordinates that round to a
/// number from -32768 px to one subpixel below 32768 px. SubjectInfo::max_coordinate is for 8 bits, and for both signs.
/// Snaps to nearest even only. 1 to 16 samples anywhere on the sixteenths of a pixel, and any scissor.
std::unique_ptr<Subject> make_edgecase_subject(const std::string& variant);

/// A variant that is the fast path for one instruction set.
struct InstructionSetVariant {
  std::string_view name;
  std::string_view instructions;
  bool available;  ///< on this machine, in this build
};
std::vector<InstructionSetVariant> instruction_set_variants();

}  // namespace edgecase::conformance
