// An exhibit as rows of characters.
#pragma once

#include <string>

#include "conformance/compare/exhibit.h"

namespace edgecase::conformance {

/// The window of choose_window() with pixel coordinates in the margins, one character a sample (the samples of a pixel
/// side by side), a legend of the characters that occur, and the caption. The row and the column of the first wrong
/// sample are pointed at with > and v. Plain ASCII; ends in a line break.
std::string text_picture(const Exhibit& exhibit);

/// The character of a sample: '.' not covered, '#' covered, 'o' missing, 'x' unexpected, '2' to '9' doubled (how often,
/// at most 9), '-' and '+' left open by the rules and not covered or covered.
char character_of(const SampleState& state);

}  // namespace edgecase::conformance
