#include <algorithm>
#include <cmath>

#include "conformance/compare/marks.h"
#include "conformance/compare/panels.h"

namespace edgecase::conformance {
namespace {

/// The region that the overview shows, in pixels: the target and the triangles, at most one target's extent beyond it.
struct Region {
  double x0, y0, x1, y1;
  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
};

Region region_of(const View& view) {
  const Extent& target = view.exhibit.scene.setting.target;
  Region region{0, 0, static_cast<double>(target.width), static_cast<double>(target.height)};
  for (const GridTriangle& triangle : view.exhibit.snapped) {
    for (const GridPoint& p : triangle) {
      const double x = std::ldexp(static_cast<double>(p.x), -view.exhibit.scene.rules.subpixel_bits);
      const double y = std::ldexp(static_cast<double>(p.y), -view.exhibit.scene.rules.subpixel_bits);
      region.x0 = std::min(region.x0, std::max(x, -1.0 * target.width));
      region.y0 = std::min(region.y0, std::max(y, -1.0 * target.height));
      region.x1 = std::max(region.x1, std::min(x, 2.0 * target.width));
      region.y1 = std::max(region.y1, std::min(y, 2.0 * target.height));
    }
  }
  return region;
}

constexpr double kHeight = 150;

}  // namespace

double overview_height(const View& view) {
  const Extent& target = view.exhibit.scene.setting.target;
  const bool whole = view.window.width == target.width && view.window.height == target.height;
  return whole ? 0 : kHeight;
}

void draw_overview(Canvas& canvas, const View& view, double x, double y, double width) {
  const Region region = region_of(view);
  const double padding = 8;
  const double scale = std::min((width - 2 * padding) / region.width(), (kHeight - 2 * padding) / region.height());
  const double left = x + (width - region.width() * scale) / 2;
  const double top = y + (kHeight - region.height() * scale) / 2;
  const auto at_x = [&](double pixel) { return left + (pixel - region.x0) * scale; };
  const auto at_y = [&](double pixel) { return top + (pixel - region.y0) * scale; };
  const Extent& target = view.exhibit.scene.setting.target;

  cairo_save(canvas.context());
  cairo_rectangle(canvas.context(), x, y, width, kHeight);
  cairo_clip(canvas.context());
  canvas.colour(ink::kPanel);
  canvas.fill_rounded(x, y, width, kHeight, 6);
  canvas.colour(ink::kPaper);
  canvas.fill_box(at_x(0), at_y(0), target.width * scale, target.height * scale);
  const int bits = view.exhibit.scene.rules.subpixel_bits;
  for (const GridTriangle& triangle : view.exhibit.snapped) {
    for (const GridPoint& p : triangle) {
      cairo_line_to(canvas.context(), at_x(std::ldexp(static_cast<double>(p.x), -bits)),
                    at_y(std::ldexp(static_cast<double>(p.y), -bits)));
    }
    cairo_close_path(canvas.context());
  }
  canvas.colour(palette::kSkyBlue, 0.35);
  cairo_fill_preserve(canvas.context());
  canvas.colour(ink::kText);
  cairo_set_line_width(canvas.context(), view.exhibit.snapped.size() == 1 ? 1 : 0.5);
  cairo_stroke(canvas.context());
  canvas.colour(rgb(0x8A939C));
  canvas.stroke_box(at_x(0), at_y(0), target.width * scale, target.height * scale, 1);

  // A window of a few pixels in a huge target would vanish: its frame is at least 7 units wide.
  const Window& window = view.window;
  const double frame_width = std::max(window.width * scale, 7.0);
  const double frame_height = std::max(window.height * scale, 7.0);
  canvas.colour(palette::kVermillion);
  canvas.stroke_box(at_x(window.x + window.width / 2.0) - frame_width / 2,
                    at_y(window.y + window.height / 2.0) - frame_height / 2, frame_width, frame_height, 2);
  cairo_restore(canvas.context());
}

}  // namespace edgecase::conformance
