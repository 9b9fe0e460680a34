#include "conformance/compare/picture.h"

#include <cairo-svg.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "conformance/compare/atomic_file.h"
#include "conformance/compare/panels.h"

namespace edgecase::conformance {
namespace {

constexpr double kMargin = 28;
constexpr double kTitle = 62;
constexpr double kGap = 34;
constexpr double kRoom = 720;
constexpr double kHalfRoom = 480;
constexpr double kPanelLabel = 24;
constexpr Font kCommandFont{12.5, false, true};
constexpr double kCommandLine = 19;

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

struct Size {
  double width = 0;
  double height = 0;
};

void draw_label(Canvas& canvas, const std::string& text, const GridPanel& grid, double x, double y) {
  canvas.colour(ink::kText);
  canvas.text(x, y - 28, canvas.shortened(text, {13, true, false}, grid.width), {13, true, false});
}

/// The same pixels as they were before a change, with a ring around the same sample.
void draw_before(Canvas& canvas, const View& view, const GridPanel& grid, double x, double y) {
  Exhibit before;
  before.scene = view.exhibit.scene;
  before.snapped = view.exhibit.before->snapped;
  before.must = view.exhibit.must;
  before.wrong = view.exhibit.wrong;
  if (before.wrong) before.wrong->triangle = 0;
  draw_label(canvas, view.exhibit.before->label, grid, x, y);
  grid.draw(canvas, {before, view.window, {}}, x, y);
}

/// Draws everything and returns the size it needs. Drawn once on a recording surface, it tells the size of the real
/// one.
Size draw(cairo_t* context, const View& view) {
  Canvas canvas(context);
  const bool before = view.exhibit.before.has_value();
  // Before and after: side by side, or one above the other if they are wide.
  const bool stacked = before && view.window.width > 2 * view.window.height;
  const GridPanel grid(view, before && !stacked ? kHalfRoom : kRoom);
  const SidePanel side;
  const double body_y = kMargin + kTitle;
  double grid_x = kMargin + GridPanel::kAxis;
  double grid_y = body_y + 22 + (before ? kPanelLabel : 0);
  if (before) {
    draw_before(canvas, view, grid, grid_x, grid_y);
    (stacked ? grid_y : grid_x) +=
        stacked ? grid.height + kGap + 22 + kPanelLabel : grid.width + kGap + GridPanel::kAxis;
    draw_label(canvas, view.exhibit.before->label_after, grid, grid_x, grid_y);
  }
  const double side_x = grid_x + grid.width + kGap;
  const double width = side_x + SidePanel::kWidth + kMargin;
  const double text_width = width - 2 * kMargin;

  const double side_end = side.draw(canvas, view, side_x, body_y);
  grid.draw(canvas, view, grid_x, grid_y);
  double end = std::max(side_end, grid_y + grid.height);

  const Font title{19, true, false};
  canvas.colour(ink::kText);
  canvas.text(kMargin, kMargin + 18, canvas.shortened(view.exhibit.title, title, text_width), title);
  canvas.colour(ink::kMuted);
  canvas.text(kMargin, kMargin + 41, canvas.shortened(view.caption.setting, {13}, text_width), {13});

  if (!view.exhibit.command.empty()) {
    const auto lines = wrap_command(canvas, view.exhibit.command, kCommandFont, text_width - 46);
    const double height = static_cast<double>(lines.size()) * kCommandLine + 18;
    canvas.colour(ink::kPanel);
    canvas.fill_rounded(kMargin, end + 24, text_width, height, 6);
    canvas.colour(ink::kMuted);
    canvas.text(kMargin + 14, end + 24 + 22, "$", kCommandFont);
    canvas.colour(ink::kText);
    double y = end + 24 + 22;
    for (const std::string& line : lines) {
      canvas.text(kMargin + 32, y, line, kCommandFont);
      y += kCommandLine;
    }
    end += 24 + height;
  }
  return {width, end + kMargin};
}

View view_of(const Exhibit& exhibit) { return {exhibit, choose_window(exhibit), make_caption(exhibit)}; }

tl::unexpected<Error> cairo_failed(cairo_status_t status) {
  return tl::unexpected(
      Error{ErrorKind::bad_input, std::string("cannot draw the picture: ") + cairo_status_to_string(status)});
}

Size measure(const View& view) {
  const Surface surface(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr), &cairo_surface_destroy);
  const Context context(cairo_create(surface.get()), &cairo_destroy);
  const Size size = draw(context.get(), view);
  return {std::ceil(size.width), std::ceil(size.height)};
}

cairo_status_t append(void* to, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void draw_on_paper(cairo_t* context, const View& view) {
  Canvas(context).colour(ink::kPaper);
  cairo_paint(context);
  draw(context, view);
}

// cairo's own writer takes five times as long, in which it tries every filter and packs as tightly as it can.
tl::expected<std::string, Error> encode_png(cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  const auto width = static_cast<std::size_t>(cairo_image_surface_get_width(surface));
  const auto height = static_cast<std::size_t>(cairo_image_surface_get_height(surface));
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  const unsigned char* const data = cairo_image_surface_get_data(surface);
  std::vector<unsigned char> rgb;
  rgb.reserve(3 * width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      std::uint32_t pixel;  // 0x..RRGGBB
      std::memcpy(&pixel, data + y * stride + x * sizeof pixel, sizeof pixel);
      for (const int shift : {16, 8, 0}) rgb.push_back(static_cast<unsigned char>(pixel >> shift & 0xFF));
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0) {
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("cannot write the picture: {}", image.message)});
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

tl::expected<std::string, Error> render_png(const Exhibit& exhibit, double scale) {
  const View view = view_of(exhibit);
  const Size size = measure(view);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(size.width * scale)),
                                                   static_cast<int>(std::ceil(size.height * scale))),
                        &cairo_surface_destroy);
  const Context context(cairo_create(surface.get()), &cairo_destroy);
  cairo_scale(context.get(), scale, scale);
  draw_on_paper(context.get(), view);
  if (const auto status = cairo_status(context.get()); status != CAIRO_STATUS_SUCCESS) return cairo_failed(status);
  return encode_png(surface.get());
}

tl::expected<std::string, Error> render_svg(const Exhibit& exhibit) {
  const View view = view_of(exhibit);
  const Size size = measure(view);
  std::string bytes;
  const Surface surface(cairo_svg_surface_create_for_stream(&append, &bytes, size.width, size.height),
                        &cairo_surface_destroy);
  cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
  {
    const Context context(cairo_create(surface.get()), &cairo_destroy);
    draw_on_paper(context.get(), view);
    if (const auto status = cairo_status(context.get()); status != CAIRO_STATUS_SUCCESS) return cairo_failed(status);
  }
  cairo_surface_finish(surface.get());
  if (const auto status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
    return cairo_failed(status);
  return bytes;
}

tl::expected<void, Error> write_png(const Exhibit& exhibit, const std::filesystem::path& path, double scale) {
  return render_png(exhibit, scale).and_then([&](const std::string& bytes) {
    return write_file_atomically(path, bytes);
  });
}

tl::expected<void, Error> write_svg(const Exhibit& exhibit, const std::filesystem::path& path) {
  return render_svg(exhibit).and_then([&](const std::string& bytes) { return write_file_atomically(path, bytes); });
}

}  // namespace edgecase::conformance
