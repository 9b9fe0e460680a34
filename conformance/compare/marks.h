// How each mark is drawn: a colour of the Okabe-Ito palette and a shape of its own.
#pragma once

#include "conformance/compare/canvas.h"
#include "conformance/compare/exhibit.h"

namespace edgecase::conformance {

/// M. Okabe and K. Ito, "Color Universal Design" (2008): told apart with every common colour vision deficiency.
namespace palette {
inline constexpr Colour kBlue = rgb(0x0072B2);
inline constexpr Colour kSkyBlue = rgb(0x56B4E9);
inline constexpr Colour kOrange = rgb(0xE69F00);
inline constexpr Colour kVermillion = rgb(0xD55E00);
inline constexpr Colour kPurple = rgb(0xCC79A7);
inline constexpr Colour kGreen = rgb(0x009E73);
}  // namespace palette

/// In the legend's words.
const char* label_of(Mark mark);

/// The mark's pure colour.
Colour colour_of(Mark mark);

/// The mark around (x, y); `radius` is that of the disc of a covered sample, other shapes are up to half as large
/// again.
void draw_mark(Canvas& canvas, Mark mark, double x, double y, double radius);

}  // namespace edgecase::conformance
