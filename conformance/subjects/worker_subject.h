// A subject whose driver runs in a worker process of its own, so that it can crash, hang or need its own environment.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "conformance/subjects/enclosing_viewport.h"
#include "conformance/subjects/subject.h"
#include "conformance/subjects/worker_process.h"

namespace edgecase::conformance {

/// A crash or hang is an Error{ErrorKind::subject} naming the signal and the triangles that were being drawn; the next
/// draw starts a new worker. One instance is used from one thread at a time; several instances are independent.
class WorkerSubject final : public Subject {
 public:
  /// Starts the worker and asks it what it can do.
  static tl::expected<std::unique_ptr<Subject>, Error> start(const std::string& name, WorkerCommand command);

  const SubjectInfo& info() const override { return info_; }
  /// The default's reasons, and: sample locations other than the standard ones; a mask, or all masks of an assembly,
  /// larger than the driver's largest buffer; a vertex that the driver's viewport transform would change.
  std::optional<std::string> refusal(const Scene& scene) const override;
  tl::expected<void, Error> draw(const Scene& scene, MaskBatch& masks) override;
  /// In the memory that it shares with the worker, if one draw suffices.
  tl::expected<DrawnMasks, Error> draw_in_place(const Scene& scene, MaskBatch& scratch) override;
  double driver_seconds() const override { return driver_seconds_; }

 private:
  WorkerSubject(const std::string& name, WorkerCommand command, std::unique_ptr<WorkerProcess> worker);
  /// Lays the vertices of triangles `first` to `first + count - 1` into the worker's memory, and leaves room for masks.
  tl::expected<DrawRequest, Error> lay_out(const Scene& scene, std::size_t first, std::size_t count);
  /// How many triangles one draw may hold.
  std::size_t most_at_once(const Scene& scene) const;
  /// Their masks, in the worker's memory.
  tl::expected<DrawnMasks, Error> draw_part(const Scene& scene, std::size_t first, std::size_t count);

  WorkerCommand command_;
  std::unique_ptr<WorkerProcess> worker_;  ///< none after a crash
  SubjectInfo info_;
  EnclosingViewport viewport_;
  std::size_t max_mask_bytes_;
  double driver_seconds_ = 0;
};

}  // namespace edgecase::conformance
