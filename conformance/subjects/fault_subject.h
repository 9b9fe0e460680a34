// Subjects that are wrong on purpose: a conformance suite is believed when it catches each of them.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "conformance/subjects/subject.h"

namespace edgecase::conformance {

struct FaultInfo {
  std::string_view name;         ///< NAME of the subject `fault:NAME`
  std::string_view description;  ///< what is planted, one line
  std::string_view revealed_by;  ///< scenes that show it, one line
};

/// Every planted fault.
std::span<const FaultInfo> faults();

/// The subject `fault:NAME` for the NAME of one of faults(); null for any other.
///
/// All of them share one straightforward rasterizer that takes any subpixel bits, any sample locations, snaps to
/// nearest even and covers coordinates up to one 256th of a pixel below 32768 px; each has exactly one line of it
/// spoilt.
std::unique_ptr<Subject> make_fault_subject(std::string_view name);

/// That rasterizer with nothing spoilt, named `fault:none`: exact, so that what catches a fault catches the fault and
/// not its host. It is no fault and not one of faults().
std::unique_ptr<Subject> make_faultless_subject();

}  // namespace edgecase::conformance
