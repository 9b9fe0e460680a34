// Finding out how a subject clips, so that one that nobody has met before is judged in clip space by what it does.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "conformance/models/transform_model.h"
#include "conformance/scene/error.h"
#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

/// The model of `subject`, which draws clip space, with a clipper that explains what it covers of triangles across the
/// view volume's planes. `transform` is what find_transform() found of it. Candidates are the known clippers, and every
/// combination of depth range, guard bands, interpolation, winding, fill, second culling and scissors; those that
/// explain triangles across one plane are told apart by triangles that are searched for that, as is then the order of
/// every two planes. Where nothing tells two apart, the known one is taken, and the other one predicts the same. The
/// error is one phrase for a person: how far the best came.
tl::expected<TransformModel, std::string> find_clipper(Subject& subject, const TransformModel& transform);

}  // namespace edgecase::conformance
