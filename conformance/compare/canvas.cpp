#include "conformance/compare/canvas.h"

#include <numbers>

namespace edgecase::conformance {

Canvas::Canvas(cairo_t* context) : context_(context) {
  // The same letters at the same places in PNG and SVG: no hinting to a pixel grid, grey levels only.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(context_, options);
  cairo_font_options_destroy(options);
  cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
}

void Canvas::colour(const Colour& colour, double alpha) {
  cairo_set_source_rgba(context_, colour.red, colour.green, colour.blue, alpha);
}

void Canvas::use(const Font& font) {
  cairo_select_font_face(context_, font.mono ? "DejaVu Sans Mono" : "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context_, font.size);
}

double Canvas::width_of(const std::string& text, const Font& font) {
  use(font);
  cairo_text_extents_t extents;
  cairo_text_extents(context_, text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(double x, double y, const std::string& text, const Font& font) {
  use(font);
  cairo_move_to(context_, x, y);
  cairo_show_text(context_, text.c_str());
}

void Canvas::text_with_halo(double x, double y, const std::string& text, const Font& font, const Colour& ink,
                            const Colour& halo) {
  use(font);
  cairo_move_to(context_, x, y);
  cairo_text_path(context_, text.c_str());
  colour(halo);
  cairo_set_line_width(context_, 4);
  cairo_stroke(context_);
  colour(ink);
  this->text(x, y, text, font);
}

void Canvas::text_centred(double x, double y, const std::string& text, const Font& font) {
  this->text(x - width_of(text, font) / 2, y, text, font);
}

void Canvas::text_right(double x, double y, const std::string& text, const Font& font) {
  this->text(x - width_of(text, font), y, text, font);
}

std::string Canvas::shortened(const std::string& text, const Font& font, double width) {
  if (width_of(text, font) <= width) return text;
  std::string kept = text;
  while (!kept.empty() && width_of(kept + "…", font) > width) {
    // Continuation bytes of UTF-8 go with the byte that starts them.
    while (!kept.empty() && (static_cast<unsigned char>(kept.back()) & 0xC0) == 0x80) kept.pop_back();
    if (!kept.empty()) kept.pop_back();
  }
  return kept + "…";
}

void Canvas::fill_box(double x, double y, double width, double height) {
  cairo_rectangle(context_, x, y, width, height);
  cairo_fill(context_);
}

void Canvas::rounded_path(double x, double y, double width, double height, double radius) {
  constexpr double kQuarter = std::numbers::pi / 2;
  cairo_new_sub_path(context_);
  cairo_arc(context_, x + width - radius, y + radius, radius, -kQuarter, 0);
  cairo_arc(context_, x + width - radius, y + height - radius, radius, 0, kQuarter);
  cairo_arc(context_, x + radius, y + height - radius, radius, kQuarter, 2 * kQuarter);
  cairo_arc(context_, x + radius, y + radius, radius, 2 * kQuarter, 3 * kQuarter);
  cairo_close_path(context_);
}

void Canvas::fill_rounded(double x, double y, double width, double height, double radius) {
  rounded_path(x, y, width, height, radius);
  cairo_fill(context_);
}

void Canvas::stroke_rounded(double x, double y, double width, double height, double radius, double line) {
  rounded_path(x, y, width, height, radius);
  cairo_set_line_width(context_, line);
  cairo_stroke(context_);
}

void Canvas::stroke_box(double x, double y, double width, double height, double line) {
  cairo_rectangle(context_, x, y, width, height);
  cairo_set_line_width(context_, line);
  cairo_stroke(context_);
}

void Canvas::line(double x0, double y0, double x1, double y1, double width) {
  cairo_move_to(context_, x0, y0);
  cairo_line_to(context_, x1, y1);
  cairo_set_line_width(context_, width);
  cairo_stroke(context_);
}

void Canvas::fill_disc(double x, double y, double radius) {
  cairo_new_sub_path(context_);
  cairo_arc(context_, x, y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(context_);
}

void Canvas::stroke_circle(double x, double y, double radius, double line) {
  cairo_new_sub_path(context_);
  cairo_arc(context_, x, y, radius, 0, 2 * std::numbers::pi);
  cairo_set_line_width(context_, line);
  cairo_stroke(context_);
}

}  // namespace edgecase::conformance
