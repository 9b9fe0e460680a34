// Counts the instructions that this thread retires.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace edgecase::conformance {

/// Instructions outside the kernel while `work` ran; nothing where the system has or lends no such counter, as in many
/// virtual machines. `work` is called in any case.
std::optional<std::uint64_t> count_instructions(const std::function<void()>& work);

}  // namespace edgecase::conformance
