// The parts of a picture: each is measured first and then drawn at its place.
#pragma once

#include <string>
#include <vector>

#include "conformance/compare/canvas.h"
#include "conformance/compare/caption.h"
#include "conformance/compare/exhibit.h"

namespace edgecase::conformance {

/// What all panels draw from.
struct View {
  const Exhibit& exhibit;
  Window window;
  Caption caption;
};

namespace ink {
inline constexpr Colour kText = rgb(0x1B1F24);
inline constexpr Colour kMuted = rgb(0x5B6570);
inline constexpr Colour kRule = rgb(0xDDE1E6);
inline constexpr Colour kPaper = rgb(0xFFFFFF);
inline constexpr Colour kPanel = rgb(0xF3F5F7);
}  // namespace ink

/// The enlarged pixels. `width` and `height` leave out the labels, which lie in a margin of kAxis on the left and
/// above.
struct GridPanel {
  static constexpr double kAxis = 34;
  /// As large as `room` pixels of width allow.
  GridPanel(const View& view, double room);
  void draw(Canvas& canvas, const View& view, double x, double y) const;
  double cell = 0;  ///< size of a pixel
  double width = 0;
  double height = 0;
};

/// Legend, first wrong sample, vertices, edge functions and overview, one below the other.
struct SidePanel {
  static constexpr double kWidth = 330;
  /// Draws from (x, y) down and returns the y of its end.
  double draw(Canvas& canvas, const View& view, double x, double y) const;
};

/// Height of the overview of `view`, 0 if the window shows all there is.
double overview_height(const View& view);
/// Target, outlines and window in a box `width` wide.
void draw_overview(Canvas& canvas, const View& view, double x, double y, double width);

/// `command` broken at blanks into lines of at most `width`, each but the last ending in a backslash, so that it can
/// still be copied.
std::vector<std::string> wrap_command(Canvas& canvas, const std::string& command, const Font& font, double width);

}  // namespace edgecase::conformance
