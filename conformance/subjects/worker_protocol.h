// What the program and a worker process say to each other. Both are built from this file at once, so plain structs are
// the format. Messages go as whole packets over a SOCK_SEQPACKET pair; vertices and masks lie in a shared memory file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "conformance/scene/error.h"
#include "conformance/scene/scene.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// The worker finds its ends of the connection under these descriptors.
inline constexpr int kWorkerSocket = 3;
inline constexpr int kWorkerMemory = 4;

/// Text of bounded length; what does not fit is cut off.
template <std::size_t Capacity>
struct FixedText {
  std::array<char, Capacity> bytes{};
  std::uint32_t length = 0;

  void assign(std::string_view text) { length = static_cast<std::uint32_t>(text.copy(bytes.data(), Capacity)); }
  std::string_view view() const { return {bytes.data(), length}; }
};

/// The outcome of anything the worker does.
struct WorkerStatus {
  bool ok = true;
  ErrorKind kind = ErrorKind::subject;
  FixedText<1000> message;

  void set(const Error& error) {
    ok = false;
    kind = error.kind;
    message.assign(error.message);
  }
};

/// Worker to program, once, when the driver is open (or could not be opened).
struct WorkerHello {
  WorkerStatus status;
  FixedText<250> device;
  Rules rules;
  std::array<std::int32_t, 8> sample_counts{};
  std::uint32_t sample_count_number = 0;
  std::int32_t max_target = 0;
  bool scissor = false;
  bool cull = false;
  bool assembly = false;
  bool clip = false;
  bool flipped_viewport = false;
  float max_viewport = 0;
  float viewport_bound = 0;
  double max_coordinate = 0;
  std::uint64_t max_mask_bytes = 0;
};

/// Program to worker: draw what lies at the start of the shared memory, leave the masks at `masks_offset`. The
/// vertices' coordinates, as in Primitives, lie at its very start.
struct DrawRequest {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::int32_t samples = 0;  ///< at standard locations
  bool has_scissor = false;
  Rect scissor;
  CullMode cull = CullMode::none;
  FrontFace front_face = FrontFace::clockwise;
  Viewport viewport;
  Topology topology = Topology::list;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  std::uint64_t components = 0;  ///< of a vertex
  std::uint64_t indices = 0;
  std::uint64_t indices_offset = 0;  ///< bytes, a multiple of 8, as the next
  std::uint64_t masks_offset = 0;
  std::uint64_t memory_bytes = 0;  ///< the shared memory's present size; it only grows
};

/// Worker to program, after each DrawRequest.
struct DrawReply {
  WorkerStatus status;
  double driver_seconds = 0;
};

}  // namespace edgecase::conformance
