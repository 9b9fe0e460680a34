#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "conformance/compare/marks.h"
#include "conformance/compare/panels.h"

namespace edgecase::conformance {
namespace {

/// From window pixels to the canvas.
struct Mapping {
  double x, y, cell;
  int first_column, first_row;

  double at_x(double pixel) const { return x + (pixel - first_column) * cell; }
  double at_y(double pixel) const { return y + (pixel - first_row) * cell; }
};

double in_pixels(std::int64_t coordinate, int bits) { return std::ldexp(static_cast<double>(coordinate), -bits); }

/// How far the marks of a cell may reach without running into each other.
double mark_radius(const Setting& setting, double cell) {
  if (setting.samples() == 1) return std::min(cell * 0.17, 6.0);
  double nearest = 16;
  for (std::size_t i = 0; i < setting.sample_locations.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& a = setting.sample_locations[i];
      const auto& b = setting.sample_locations[j];
      nearest = std::min(nearest, std::hypot(a.x - b.x, a.y - b.y));
    }
  }
  return std::clamp(nearest / 16 * cell * 0.28, 1.4, 5.5);
}

/// The ground of a pixel with one sample takes a tint of its mark.
void draw_tint(Canvas& canvas, const View& view, const Mapping& map, int x, int y) {
  const Setting& setting = view.exhibit.scene.setting;
  int marked = 0;
  Mark mark = Mark::empty;
  for (int s = 0; s < setting.samples(); ++s) {
    const Mark sample = sample_state(view.exhibit, x, y, s).mark;
    if (sample == Mark::covered || setting.samples() == 1) mark = sample;
    marked += mark != Mark::empty && sample == mark ? 1 : 0;
  }
  if (marked == 0 || mark == Mark::open_empty) return;
  canvas.colour(mark == Mark::covered ? palette::kSkyBlue : colour_of(mark),
                0.26 * static_cast<double>(marked) / setting.samples());
  canvas.fill_box(map.at_x(x), map.at_y(y), map.cell, map.cell);
}

void draw_axes(Canvas& canvas, const View& view, const Mapping& map) {
  const Window& window = view.window;
  const Font font{11};
  const int widest = std::max(window.x + window.width, window.y + window.height);
  const double room = canvas.width_of(std::to_string(widest), font) + 8;
  const auto step = [&](double needed) {
    for (const int candidate : {1, 2, 5, 10}) {
      if (candidate * map.cell >= needed) return candidate;
    }
    return 20;
  };
  canvas.colour(ink::kMuted);
  const int column_step = step(room);
  for (int x = window.x; x < window.x + window.width; ++x) {
    if (x % column_step == 0) canvas.text_centred(map.at_x(x + 0.5), map.y - 8, std::to_string(x), font);
  }
  const int row_step = step(16);
  for (int y = window.y; y < window.y + window.height; ++y) {
    if (y % row_step == 0) canvas.text_right(map.x - 8, map.at_y(y + 0.5) + 4, std::to_string(y), font);
  }
}

void draw_outlines(Canvas& canvas, const View& view, const Mapping& map) {
  const int bits = view.exhibit.scene.rules.subpixel_bits;
  const auto trace = [&](const GridTriangle& triangle) {
    cairo_new_sub_path(canvas.context());
    for (const GridPoint& p : triangle) {
      cairo_line_to(canvas.context(), map.at_x(in_pixels(p.x, bits)), map.at_y(in_pixels(p.y, bits)));
    }
    cairo_close_path(canvas.context());
  };
  const std::vector<GridTriangle>& all = view.exhibit.snapped;
  const auto stroke = [&](const Colour& colour, double alpha, double width) {
    canvas.colour(colour, alpha);
    cairo_set_line_width(canvas.context(), width);
    cairo_stroke(canvas.context());
  };
  for (const GridTriangle& triangle : all) trace(triangle);
  stroke(ink::kText, all.size() == 1 ? 1 : 0.5, all.size() == 1 ? 1.6 : 1.0);
  if (all.size() > 1 && view.exhibit.wrong && view.exhibit.wrong->triangle < all.size()) {
    trace(all[view.exhibit.wrong->triangle]);
    stroke(ink::kText, 1, 2);
  }
}

/// Where the ring around the first wrong sample lies, if it is in view.
struct Ring {
  double x, y, radius;
};

std::optional<Ring> ring_of(const View& view, const Mapping& map, double radius) {
  const auto& wrong = view.exhibit.wrong;
  if (!wrong || !view.window.contains(wrong->x, wrong->y)) return std::nullopt;
  const Setting& setting = view.exhibit.scene.setting;
  const SampleLocation& at = setting.sample_locations[static_cast<std::size_t>(wrong->sample)];
  return Ring{map.at_x(wrong->x + at.x / 16.0), map.at_y(wrong->y + at.y / 16.0),
              setting.samples() == 1 ? map.cell * 0.48 : radius * 2.3};
}

/// The vertices that the caption lists: a square each, or its name, pushed away from the triangle's middle.
enum class VertexPart { square, name };

void draw_vertices(Canvas& canvas, const View& view, const Mapping& map, const std::optional<Ring>& ring,
                   VertexPart part) {
  const std::vector<GridTriangle>& all = view.exhibit.snapped;
  const std::size_t index = view.exhibit.wrong ? view.exhibit.wrong->triangle : 0;
  if (index >= all.size() || view.caption.vertices[0].empty()) return;
  const int bits = view.exhibit.scene.rules.subpixel_bits;
  double middle_x = 0;
  double middle_y = 0;
  for (const GridPoint& p : all[index]) {
    middle_x += in_pixels(p.x, bits) / 3;
    middle_y += in_pixels(p.y, bits) / 3;
  }
  const Font font{12, true, false};
  const Window& window = view.window;
  for (std::size_t i = 0; i < 3; ++i) {
    const double px = in_pixels(all[index][i].x, bits);
    const double py = in_pixels(all[index][i].y, bits);
    if (px < window.x || px > window.x + window.width || py < window.y || py > window.y + window.height) continue;
    if (part == VertexPart::square) {
      canvas.colour(ink::kText);
      canvas.fill_box(map.at_x(px) - 3, map.at_y(py) - 3, 6, 6);
      continue;
    }
    const double length = std::max(std::hypot(px - middle_x, py - middle_y), 1e-9);
    const bool ringed = ring && std::hypot(map.at_x(px) - ring->x, map.at_y(py) - ring->y) < ring->radius + 12;
    const double push = ringed ? 2 * ring->radius + 14 : 17;
    const std::string name = fmt::format("v{}", i);
    const double width = canvas.width_of(name, font);
    const double x = std::clamp(map.at_x(px) + (px - middle_x) / length * push, map.x + width / 2 + 3,
                                map.at_x(window.x + window.width) - width / 2 - 3);
    const double y =
        std::clamp(map.at_y(py) + (py - middle_y) / length * push, map.y + 9, map.at_y(window.y + window.height) - 9);
    canvas.text_with_halo(x - width / 2, y + 4, name, font, ink::kText, ink::kPaper);
  }
}

}  // namespace

GridPanel::GridPanel(const View& view, double room) {
  const int extent = std::max(view.window.width, view.window.height);
  const double largest = std::clamp(360.0 / extent, view.exhibit.scene.setting.samples() == 1 ? 48.0 : 72.0, 96.0);
  cell = std::clamp(std::floor(std::min(room / view.window.width, 600.0 / view.window.height)), 12.0, largest);
  width = cell * view.window.width;
  height = cell * view.window.height;
}

void GridPanel::draw(Canvas& canvas, const View& view, double x, double y) const {
  const Window& window = view.window;
  const Setting& setting = view.exhibit.scene.setting;
  const Mapping map{x, y, cell, window.x, window.y};
  const auto each_pixel = [&](auto&& body) {
    for (int py = window.y; py < window.y + window.height; ++py) {
      for (int px = window.x; px < window.x + window.width; ++px) body(px, py);
    }
  };
  draw_axes(canvas, view, map);

  cairo_save(canvas.context());
  cairo_rectangle(canvas.context(), x, y, width, height);
  cairo_clip(canvas.context());
  each_pixel([&](int px, int py) { draw_tint(canvas, view, map, px, py); });
  canvas.colour(ink::kRule);
  for (int i = 1; i < window.width; ++i) canvas.line(x + i * cell, y, x + i * cell, y + height, 1);
  for (int i = 1; i < window.height; ++i) canvas.line(x, y + i * cell, x + width, y + i * cell, 1);
  const double radius = mark_radius(setting, cell);
  const std::optional<Ring> ring = ring_of(view, map, radius);
  draw_outlines(canvas, view, map);
  draw_vertices(canvas, view, map, ring, VertexPart::square);
  each_pixel([&](int px, int py) {
    for (int s = 0; s < setting.samples(); ++s) {
      const SampleLocation& at = setting.sample_locations[static_cast<std::size_t>(s)];
      draw_mark(canvas, sample_state(view.exhibit, px, py, s).mark, map.at_x(px + at.x / 16.0),
                map.at_y(py + at.y / 16.0), radius);
    }
  });
  draw_vertices(canvas, view, map, ring, VertexPart::name);
  cairo_restore(canvas.context());

  canvas.colour(rgb(0x8A939C));
  canvas.stroke_box(x, y, width, height, 1.2);
  if (ring) {
    canvas.colour(ink::kText);
    canvas.stroke_circle(ring->x, ring->y, ring->radius, 1.8);
  }
}

}  // namespace edgecase::conformance
