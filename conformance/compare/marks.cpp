#include "conformance/compare/marks.h"

namespace edgecase::conformance {
namespace {

void polygon(Canvas& canvas, std::initializer_list<std::pair<double, double>> points, const Colour& colour, bool filled,
             double line) {
  cairo_t* context = canvas.context();
  cairo_new_path(context);
  for (const auto& [x, y] : points) cairo_line_to(context, x, y);
  cairo_close_path(context);
  canvas.colour(colour);
  if (filled) cairo_fill_preserve(context);
  cairo_set_line_width(context, line);
  cairo_stroke(context);
}

}  // namespace

const char* label_of(Mark mark) {
  switch (mark) {
    case Mark::empty:
      return "not covered";
    case Mark::covered:
      return "covered";
    case Mark::missing:
      return "missing";
    case Mark::unexpected:
      return "unexpected";
    case Mark::doubled:
      return "doubled";
    case Mark::open_empty:
      return "left open, not covered";
    case Mark::open_covered:
      return "left open, covered";
  }
  return "";
}

Colour colour_of(Mark mark) {
  switch (mark) {
    case Mark::empty:
      return rgb(0xA6ADB5);
    case Mark::covered:
      return palette::kBlue;
    case Mark::missing:
      return palette::kVermillion;
    case Mark::unexpected:
      return palette::kOrange;
    case Mark::doubled:
      return palette::kPurple;
    case Mark::open_empty:
    case Mark::open_covered:
      return palette::kGreen;
  }
  return {};
}

void draw_mark(Canvas& canvas, Mark mark, double x, double y, double radius) {
  const Colour colour = colour_of(mark);
  canvas.colour(colour);
  const double r = radius;
  switch (mark) {
    case Mark::empty:
      canvas.fill_disc(x, y, r * 0.42);
      break;
    case Mark::covered:
      canvas.fill_disc(x, y, r);
      break;
    case Mark::missing:
      canvas.line(x - 1.25 * r, y - 1.25 * r, x + 1.25 * r, y + 1.25 * r, r * 0.75);
      canvas.line(x - 1.25 * r, y + 1.25 * r, x + 1.25 * r, y - 1.25 * r, r * 0.75);
      break;
    case Mark::unexpected:
      polygon(canvas, {{x, y - 1.5 * r}, {x + 1.5 * r, y}, {x, y + 1.5 * r}, {x - 1.5 * r, y}}, colour, true, r * 0.2);
      break;
    case Mark::doubled:
      canvas.fill_disc(x, y, r * 0.65);
      canvas.stroke_circle(x, y, r * 1.25, r * 0.45);
      break;
    case Mark::open_empty:
    case Mark::open_covered:
      polygon(canvas, {{x, y - 1.3 * r}, {x + 1.2 * r, y + r}, {x - 1.2 * r, y + r}}, colour,
              mark == Mark::open_covered, r * 0.4);
      break;
  }
}

}  // namespace edgecase::conformance
