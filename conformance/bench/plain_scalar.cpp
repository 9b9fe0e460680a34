// Compiled without the vectorizers, see CMakeLists.txt.
#include "conformance/bench/plain_step.h"

namespace edgecase::conformance {

void step_scalar(const PlainEdges<std::int32_t>& edges, const PlainBox& box, std::uint8_t* pixels) {
  step_plain(edges, box, pixels);
}
void step_scalar(const PlainEdges<std::int64_t>& edges, const PlainBox& box, std::uint8_t* pixels) {
  step_plain(edges, box, pixels);
}

}  // namespace edgecase::conformance
