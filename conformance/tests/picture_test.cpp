#include "conformance/compare/picture.h"

#include <cairo.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "conformance/compare/atomic_file.h"
#include "conformance/compare/caption.h"
#include "conformance/compare/panels.h"
#include "conformance/compare/text_picture.h"
#include "conformance/tests/sample_exhibits.h"

/// Asked by the leak checker: fontconfig keeps patterns for the life of the process.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

/// An empty folder that goes away with the test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "edgecase_picture_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

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

Exhibit square_fan() {
  return make_exhibit({{16, 16}, {SampleLocation{}}}, {{Position{8.5f, 8.5f}, {3, 3}, {14, 3}},
                                                       {Position{8.5f, 8.5f}, {14, 3}, {14, 13}},
                                                       {Position{8.5f, 8.5f}, {14, 13}, {3, 13}},
                                                       {Position{8.5f, 8.5f}, {3, 13}, {3, 3}}});
}

std::size_t owner(const Exhibit& exhibit, int x, int y) {
  const std::size_t bit = MaskLayout(exhibit.scene.setting).bit(x, y, 0);
  for (std::size_t i = 0; i < exhibit.must.size(); ++i) {
    if (covered(exhibit.must[i], bit)) return i;
  }
  return 0;
}

Exhibit one_of_each() {
  Exhibit exhibit = square_fan();
  spoil(exhibit, owner(exhibit, 5, 8), 5, 8, 0);
  spoil(exhibit, 0, 1, 14, 0);
  spoil(exhibit, (owner(exhibit, 10, 5) + 1) % 4, 10, 5, 0);
  return exhibit;
}

TEST(SampleState, TellsTheMarksApart) {
  const Exhibit exhibit = one_of_each();
  EXPECT_EQ(sample_state(exhibit, 0, 0, 0).mark, Mark::empty);
  EXPECT_EQ(sample_state(exhibit, 6, 8, 0).mark, Mark::covered);
  EXPECT_EQ(sample_state(exhibit, 5, 8, 0).mark, Mark::missing);
  EXPECT_EQ(sample_state(exhibit, 1, 14, 0).mark, Mark::unexpected);
  EXPECT_EQ(sample_state(exhibit, 10, 5, 0).mark, Mark::doubled);
  EXPECT_EQ(sample_state(exhibit, 10, 5, 0).observed, 2);
}

TEST(SampleState, OpenSamplesMayBeCoveredOnce) {
  Exhibit exhibit = square_fan();
  const MaskLayout layout(exhibit.scene.setting);
  exhibit.may = exhibit.must;
  std::fill(exhibit.may.data().begin(), exhibit.may.data().end(), 0);
  for (const std::size_t triangle : {std::size_t{0}, std::size_t{1}}) {
    for (const int x : {0, 1, 2}) cover(exhibit.may[triangle], layout.bit(x, 0, 0));
  }
  cover(exhibit.observed[0], layout.bit(1, 0, 0));
  cover(exhibit.observed[0], layout.bit(2, 0, 0));
  cover(exhibit.observed[1], layout.bit(2, 0, 0));
  EXPECT_EQ(sample_state(exhibit, 0, 0, 0).mark, Mark::open_empty);
  EXPECT_EQ(sample_state(exhibit, 1, 0, 0).mark, Mark::open_covered);
  EXPECT_EQ(sample_state(exhibit, 2, 0, 0).mark, Mark::doubled);
}

TEST(Window, ShowsWhatMatters) {
  const Exhibit small = make_exhibit({{200, 100}, {SampleLocation{}}}, {{Position{60, 40}, {70, 40}, {60, 46}}});
  const Window around = choose_window(small);
  EXPECT_TRUE(around.contains(59, 39) && around.contains(70, 46));
  EXPECT_LE(around.width * around.height, 16 * 12);

  Exhibit large = make_exhibit({{2000, 400}, {SampleLocation{}}}, {{Position{-50, 0}, {1990, 200}, {5, 399}}});
  spoil(large, 0, 1999, 1, 0);
  const Window cut = choose_window(large);
  EXPECT_LE(cut.width, 48);
  EXPECT_LE(cut.height, 32);
  EXPECT_TRUE(cut.contains(1999, 1));
  EXPECT_EQ(cut.x + cut.width, 2000);
  EXPECT_EQ(cut.y, 0);

  const Exhibit pixel = make_exhibit({{1, 1}, {SampleLocation{}}}, {{Position{-9, -9}, {9, -9}, {-9, 9}}});
  EXPECT_EQ(choose_window(pixel).width * choose_window(pixel).height, 1);
}

TEST(Window, ReachesAStraySampleFarFromTheTriangle) {
  Exhibit exhibit = make_exhibit({{40, 30}, {SampleLocation{}}}, {{Position{1, 1}, {9, 1}, {1, 9}}});
  spoil(exhibit, 0, 3, 2, 0);
  spoil(exhibit, 0, 3, 27, 0);
  EXPECT_TRUE(choose_window(exhibit).contains(3, 27));
}

TEST(Caption, DecimalsAreExact) {
  EXPECT_EQ(exact_decimal(0, 8), "0");
  EXPECT_EQ(exact_decimal(384, 8), "1.5");
  EXPECT_EQ(exact_decimal(-1, 8), "-0.00390625");
  EXPECT_EQ(exact_decimal(257, 8), "1.00390625");
  EXPECT_EQ(exact_decimal(-512, 8), "-2");
  EXPECT_EQ(exact_decimal(65535, 16), "0.9999847412109375");
  EXPECT_EQ(exact_decimal(7, 0), "7");
}

TEST(Caption, SaysWhyASampleIsInsideOrOutside) {
  Exhibit exhibit = make_exhibit({{8, 8}, {SampleLocation{}}}, {{Position{1.5f, 1.5f}, {6.5f, 1.5f}, {1.5f, 6.5f}}});
  const auto reason = [&](int x, int y) {
    exhibit.explanation = explain(exhibit.snapped[0], exhibit.scene.setting, x, y, 0);
    return make_caption(exhibit).reason;
  };
  EXPECT_EQ(reason(2, 2), "inside: on the inner side of all three edges");
  EXPECT_EQ(reason(3, 1), "inside: on v0 -> v1, a top edge");
  EXPECT_EQ(reason(1, 3), "inside: on v2 -> v0, a left edge");
  EXPECT_EQ(reason(4, 3), "outside: on v1 -> v2, neither top nor left");
  EXPECT_EQ(reason(7, 7), "outside: beyond the edge v1 -> v2");

  exhibit.explanation = explain(exhibit.snapped[0], exhibit.scene.setting, 2, 2, 0);
  exhibit.explanation->inside = false;
  EXPECT_EQ(make_caption(exhibit).reason, "outside: the scissor leaves this pixel out");
  exhibit.explanation->culled = true;
  EXPECT_EQ(make_caption(exhibit).reason, "culled by the way it faces: the triangle covers nothing");
}

TEST(TextPicture, ShowsRowsWithCoordinates) {
  Exhibit exhibit = make_exhibit({{8, 6}, {SampleLocation{}}}, {{Position{1.5f, 1.5f}, {6.5f, 1.5f}, {1.5f, 5.5f}}});
  exhibit.title = "two samples";
  spoil(exhibit, 0, 2, 1, 0);
  spoil(exhibit, 0, 6, 1, 0);
  EXPECT_EQ(text_picture(exhibit),
            "two samples\n"
            "8 x 6 px, 1 sample a pixel, 8 subpixel bits, snap to nearest even\n"
            "    0    5\n"
            "      v\n"
            "  0 ........\n"
            "> 1 .#o###x.\n"
            "  2 .####...\n"
            "  3 .###....\n"
            "  4 .##.....\n"
            "  5 ........\n"
            ". not covered 33   # covered 13   o missing 1   x unexpected 1\n"
            "missing at pixel (2, 1), sample 0, at (2.5, 1.5): the rules cover it, softpipe does not\n"
            "triangle: v0 (1.5, 1.5)  v1 (6.5, 1.5)  v2 (1.5, 5.5)\n"
            "edge functions there, in (1/256 px)^2, positive inside:\n"
            "  v0 -> v1           0  top\n"
            "  v1 -> v2  +1,048,576  -\n"
            "  v2 -> v0    +262,144  left\n"
            "inside: on v0 -> v1, a top edge\n"
            "$ ./edgecase run --subject osmesa-softpipe findings/0001-softpipe-fans.json\n");
}

TEST(TextPicture, DoubledSamplesShowHowOften) {
  EXPECT_EQ(character_of({Mark::doubled, 2}), '2');
  EXPECT_EQ(character_of({Mark::doubled, 64}), '9');
  EXPECT_THAT(text_picture(one_of_each()), HasSubstr("2-9 doubled 1"));
}

TEST(TextPicture, GroupsTheSamplesOfAPixel) {
  Exhibit exhibit = make_exhibit({{4, 3}, {{4, 4}, {12, 12}}}, {{Position{0.5f, 0.5f}, {3.5f, 0.5f}, {0.5f, 2.5f}}});
  spoil(exhibit, 0, 1, 1, 1);
  EXPECT_THAT(text_picture(exhibit), HasSubstr("\n> 1 .# #x #. ..\n"));
  EXPECT_THAT(text_picture(exhibit), HasSubstr("\n        v\n"));
}

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
  const Folder folder;
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

TEST(AtomicFile, ReplacesWholeFilesAndFollowsLinks) {
  const Folder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a", "one"));
  ASSERT_TRUE(write_file_atomically(folder / "a", "two"));
  std::filesystem::create_symlink(folder / "a", folder / "link");
  ASSERT_TRUE(write_file_atomically(folder / "link", "three"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(content_of(folder / "a"), "three");
  EXPECT_EQ(folder.files(), 2u);
  EXPECT_FALSE(write_file_atomically(folder / "", "x"));
  EXPECT_EQ(folder.files(), 2u);
}

TEST(AtomicFile, KeepsTheModeOfAnExistingFile) {
  const Folder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a", "one"));
  std::filesystem::permissions(folder / "a", std::filesystem::perms{0640});
  ASSERT_TRUE(write_file_atomically(folder / "a", "two"));
  EXPECT_EQ(std::filesystem::status(folder / "a").permissions(), std::filesystem::perms{0640});
  EXPECT_EQ(content_of(folder / "a"), "two");
}

TEST(AtomicFile, TakesTheLongestNameThatAFileCanHave) {
  const Folder folder;
  const std::string name(255, 'n');
  ASSERT_TRUE(write_file_atomically(folder / name, "x"));
  EXPECT_EQ(content_of(folder / name), "x");
}

// As in `edgecase run --json /dev/stdout > file`: nothing that was printed before or after may be overwritten.
TEST(AtomicFile, StandsInOrderWithWhatIsPrinted) {
  const Folder folder;
  std::fflush(stdout);
  const int saved = ::dup(STDOUT_FILENO);
  const int file = ::open((folder / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ASSERT_EQ(::dup2(file, STDOUT_FILENO), STDOUT_FILENO);
  ::close(file);
  std::fputs("before ", stdout);
  const auto by_name = write_file_atomically("/dev/stdout", "one ");
  std::fputs("between ", stdout);
  const auto by_number = write_file_atomically("/dev/fd/1", "two ");
  std::fputs("after", stdout);
  std::fflush(stdout);
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  EXPECT_TRUE(by_name && by_number);
  EXPECT_EQ(content_of(folder / "out"), "before one between two after");
  EXPECT_FALSE(write_file_atomically("/dev/fd/9999", "x"));
}

// A limit on the size of files stands in for a full disk: the write fails part of the way.
TEST(AtomicFile, AFailedWriteLeavesTheOldFileAndNothingElse) {
  const Folder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a", "old"));
  const auto previous = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{1000, limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto written = write_file_atomically(folder / "a", std::string(5000, 'n'));
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, previous);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("/a: cannot write: File too large"));
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_EQ(folder.files(), 1u);
}

}  // namespace
}  // namespace edgecase::conformance
