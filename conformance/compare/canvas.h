// A thin layer over cairo: colours, text that knows its width, and the few shapes that pictures need.
#pragma once

#include <cairo.h>

#include <string>

namespace edgecase::conformance {

/// sRGB, each from 0 to 1.
struct Colour {
  double red = 0;
  double green = 0;
  double blue = 0;
};

constexpr Colour rgb(unsigned hex) {
  return {static_cast<double>(hex >> 16 & 0xFF) / 255, static_cast<double>(hex >> 8 & 0xFF) / 255,
          static_cast<double>(hex & 0xFF) / 255};
}

struct Font {
  double size = 13;
  bool bold = false;
  bool mono = false;
};

/// Draws in user units of one pixel, y down. Borrows the context.
class Canvas {
 public:
  explicit Canvas(cairo_t* context);

  cairo_t* context() const { return context_; }
  void colour(const Colour& colour, double alpha = 1);
  double width_of(const std::string& text, const Font& font);
  /// Text from x on, its baseline at y.
  void text(double x, double y, const std::string& text, const Font& font);
  /// The same with a rim of `halo` that sets it off from what lies beneath.
  void text_with_halo(double x, double y, const std::string& text, const Font& font, const Colour& ink,
                      const Colour& halo);
  void text_centred(double x, double y, const std::string& text, const Font& font);
  void text_right(double x, double y, const std::string& text, const Font& font);
  /// `text` cut at its end with an ellipsis so that it is at most `width` wide.
  std::string shortened(const std::string& text, const Font& font, double width);

  void fill_box(double x, double y, double width, double height);
  void fill_rounded(double x, double y, double width, double height, double radius);
  void stroke_rounded(double x, double y, double width, double height, double radius, double line);
  void stroke_box(double x, double y, double width, double height, double line);
  void line(double x0, double y0, double x1, double y1, double width);
  void fill_disc(double x, double y, double radius);
  void stroke_circle(double x, double y, double radius, double line);

 private:
  void use(const Font& font);
  void rounded_path(double x, double y, double width, double height, double radius);

  cairo_t* context_;
};

}  // namespace edgecase::conformance
