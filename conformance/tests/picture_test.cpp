#include "conformance/compare/picture.h"

#include <cairo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cstring>
#include <memory>
#include <sstream>

#include "conformance/compare/panels.h"
#include "conformance/tests/sample_exhibits.h"
#include "conformance/tests/temporary_folder.h"

/// Asked by the leak checker: fontconfig keeps patterns for the life of the process.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

/// A decoded PNG.
class Pixels {
 public:
  explicit Pixels(const std::string& png) : rest_(png) {
    surface_.reset(cairo_image_surface_create_from_png_stream(&Pixels::read, this));
    cairo_surface_flush(surface_.get());
  }
  bool good() const { return cairo_surface_status(surface_.get()) == CAIRO_STATUS_SUCCESS; }
  int width() const { return cairo_image_surface_get_width(surface_.get()); }
  int height() const { return cairo_image_surface_get_height(surface_.get()); }
  unsigned at(int x, int y) const {
    const unsigned char* row = cairo_image_surface_get_data(surface_.get()) +
                               static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_.get());
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, row + static_cast<std::ptrdiff_t>(x) * 4, 4);
    return pixel & 0xFFFFFF;
  }
  int count(unsigned colour) const {
    int sum = 0;
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) sum += at(x, y) == colour ? 1 : 0;
    }
    return sum;
  }

 private:
  static cairo_status_t read(void* from, unsigned char* data, unsigned length) {
    auto& rest = static_cast<Pixels*>(from)->rest_;
    if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, rest.data(), length);
    rest.remove_prefix(length);
    return CAIRO_STATUS_SUCCESS;
  }
  std::string_view rest_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_{nullptr, &cairo_surface_destroy};
};

constexpr unsigned kBlue = 0x0072B2;
constexpr unsigned kOrange = 0xE69F00;
constexpr unsigned kVermillion = 0xD55E00;
constexpr unsigned kPurple = 0xCC79A7;
constexpr unsigned kGreen = 0x009E73;

TEST(Png, HasTheColoursOfItsMarksAndNoOthers) {
  const auto png = render_png(one_of_each());
  ASSERT_TRUE(png);
  const Pixels pixels(*png);
  ASSERT_TRUE(pixels.good());
  for (const unsigned colour : {kBlue, kOrange, kVermillion, kPurple}) EXPECT_GT(pixels.count(colour), 20) << colour;
  EXPECT_EQ(pixels.count(kGreen), 0);
  // One diamond in the grid (at most 162 pixels) and one in the legend (113), and no line drawn astray.
  EXPECT_LT(pixels.count(kOrange), 162 + 113);

  const auto clean = render_png(square_fan());
  ASSERT_TRUE(clean);
  for (const unsigned colour : {kOrange, kVermillion, kPurple, kGreen}) EXPECT_EQ(Pixels(*clean).count(colour), 0);
}

// The window is the whole 16x16 target in cells of 37 px, its corner at (62, 112): every covered sample has its disc,
// and every other sample does not.
TEST(Png, PutsMarksOnTheSamplePoints) {
  const Exhibit exhibit = square_fan();
  const auto png = render_png(exhibit);
  ASSERT_TRUE(png);
  const Pixels pixels(*png);
  const Window window = choose_window(exhibit);
  ASSERT_EQ(window.width, 16);
  ASSERT_EQ(window.height, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const unsigned colour = pixels.at(62 + 37 * x + 18, 112 + 37 * y + 18);
      EXPECT_EQ(colour == kBlue, sample_state(exhibit, x, y, 0).mark == Mark::covered) << x << ' ' << y;
    }
  }
}

TEST(Png, StaysOfAReasonableSize) {
  std::vector<Exhibit> exhibits = {one_of_each()};
  exhibits.push_back(make_exhibit({{1, 1}, {SampleLocation{}}}, {{Position{0, 0}, {1, 0}, {0, 1}}}));
  exhibits.push_back(make_exhibit({{3000, 50}, {SampleLocation{}}}, {{Position{-16384, 0}, {16384, 0}, {0, 16384}}}));
  exhibits.back().title = std::string(500, 'W');
  exhibits.back().command = std::string(300, 'x') + " " + std::string(90, 'y') + " " + std::string(90, 'z');
  exhibits.push_back(make_exhibit({{48, 32}, {SampleLocation{}}}, {{Position{0, 0}, {48, 0}, {0, 32}}}));
  exhibits.push_back(make_exhibit({{1, 300}, {SampleLocation{}}}, {}));
  for (const Exhibit& exhibit : exhibits) {
    const auto png = render_png(exhibit);
    ASSERT_TRUE(png);
    const Pixels pixels(*png);
    ASSERT_TRUE(pixels.good());
    EXPECT_GE(pixels.width(), 400);
    EXPECT_LE(pixels.width(), 1250);
    EXPECT_LE(pixels.height(), 1000);
    // Nothing is cut off: the margins are paper.
    for (int x = 0; x < pixels.width(); ++x) {
      EXPECT_EQ(pixels.at(x, 10), 0xFFFFFFu);
      EXPECT_EQ(pixels.at(x, pixels.height() - 10), 0xFFFFFFu);
    }
    for (int y = 0; y < pixels.height(); ++y) EXPECT_EQ(pixels.at(10, y), 0xFFFFFFu);
  }
}

TEST(Canvas, LongTextIsCutOrBrokenToItsWidth) {
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1), &cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()), &cairo_destroy);
  Canvas canvas(context.get());
  const Font font{12, false, true};
  EXPECT_EQ(canvas.shortened("short", font, 100), "short");
  const std::string cut = canvas.shortened("ααααααααααααααααααααααα", font, 100);
  EXPECT_LE(canvas.width_of(cut, font), 100);
  EXPECT_TRUE(cut.starts_with("αααα") && cut.ends_with("α…")) << cut;

  const std::string command = "one two three four five six seven eight nine ten a-word-that-is-wider-than-a-line end";
  std::string joined;
  const auto lines = wrap_command(canvas, command, font, 120);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool last = i + 1 == lines.size();
    EXPECT_EQ(lines[i].ends_with(" \\"), !last) << lines[i];
    joined += last ? lines[i] : lines[i].substr(0, lines[i].size() - 1);
    if (lines[i].find("wider") == std::string::npos) {
      EXPECT_LE(canvas.width_of(lines[i], font), 120) << lines[i];
    }
  }
  EXPECT_EQ(joined, command);
  EXPECT_GT(lines.size(), 4u);
}

TEST(Png, BeforeAndAfterStandSideBySideOrOneAboveTheOther) {
  const auto size = [](const Exhibit& exhibit) {
    const auto png = render_png(exhibit);
    EXPECT_TRUE(png);
    const Pixels pixels(*png);
    EXPECT_TRUE(pixels.good());
    return std::pair(pixels.width(), pixels.height());
  };
  for (const Extent target : {Extent{20, 30}, Extent{40, 8}}) {
    Exhibit exhibit = make_exhibit({target, {SampleLocation{}}}, {{Position{0, 0}, {30, 0}, {0, 30}}});
    const auto [width, height] = size(exhibit);
    exhibit.before = Before{"before the change", "after it", exhibit.snapped};
    const auto [both_width, both_height] = size(exhibit);
    EXPECT_EQ(both_width > width, target.height > target.width);
    EXPECT_EQ(both_height > height + 30, target.height < target.width);
  }
}

TEST(Png, ScaleEnlargesIt) {
  const auto once = render_png(square_fan());
  const auto twice = render_png(square_fan(), 2);
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(Pixels(*twice).width(), 2 * Pixels(*once).width());
}

TEST(Svg, IsWellFormed) {
  Exhibit exhibit = one_of_each();
  exhibit.title = "a < b & \"c\" > d";
  const auto svg = render_svg(exhibit);
  ASSERT_TRUE(svg);
  std::istringstream text(*svg);
  boost::property_tree::ptree tree;
  ASSERT_NO_THROW(boost::property_tree::read_xml(text, tree));
  EXPECT_TRUE(tree.get_child_optional("svg.g"));
  std::istringstream view_box(tree.get<std::string>("svg.<xmlattr>.viewBox", ""));
  double left = 0, top = 0, width = 0, height = 0;
  view_box >> left >> top >> width >> height;
  EXPECT_GT(width, 400);
  EXPECT_GT(height, 400);
}

TEST(PictureFile, IsWrittenWhole) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(one_of_each(), folder / "a.png"));
  ASSERT_TRUE(write_svg(one_of_each(), folder / "a.svg"));
  EXPECT_EQ(content_of(folder / "a.png"), *render_png(one_of_each()));
  EXPECT_THAT(content_of(folder / "a.svg"), HasSubstr("</svg>"));
  EXPECT_EQ(folder.files(), 2u);
}

TEST(PictureFile, ErrorsNameTheFile) {
  const auto absent = write_png(square_fan(), "/nowhere/at/all/a.png");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().message, "/nowhere/at/all/a.png: cannot write: No such file or directory");
  const auto full = write_svg(square_fan(), "/dev/full");
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().message, "/dev/full: cannot write: No space left on device");
  // A device is written to, never replaced.
  struct stat status {};
  ASSERT_EQ(::stat("/dev/full", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode));
}

}  // namespace
}  // namespace edgecase::conformance
