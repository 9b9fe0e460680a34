// Counts the instructions that this thread runs outside the kernel: by the processor's counter, where the system has
// and lends one, or one by one.
//
// One by one: with its trap flag set, an x86 processor raises an exception after every instruction, whatever the
// instruction set, which the system turns into a signal; its handler adds one. Some microseconds each, and exact: the
// same work has the same number every time. What is not counted: other threads, what the kernel does for a system call,
// and the instruction that ends the counting. A string instruction with a rep prefix counts once for every round, where
// the processor's counter counts it once.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace edgecase::conformance {

/// Whether this machine has a counter that count_instructions() can use.
bool has_instruction_counter();

/// Instructions while `work` ran; nothing where the system has or lends no such counter, as in many virtual machines.
/// `work` is called in any case.
std::optional<std::uint64_t> count_instructions(const std::function<void()>& work);

/// The same one by one, less those of calling a function that does nothing; nothing if there are more than `most` of
/// them, of which the others then run at full speed, and on processors and systems where it cannot be done. `work` is
/// called in any case. Not in two threads at once, as all threads share the signal's handler.
std::optional<std::uint64_t> step_through(const std::function<void()>& work, std::uint64_t most);

}  // namespace edgecase::conformance
