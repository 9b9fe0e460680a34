#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "conformance/compare/marks.h"
#include "conformance/compare/panels.h"

namespace edgecase::conformance {
namespace {

constexpr double kLine = 20;
constexpr double kSection = 18;

double heading(Canvas& canvas, double x, double y, const std::string& text) {
  canvas.colour(ink::kMuted);
  canvas.text(x, y + 11, text, {11, true, false});
  canvas.colour(ink::kRule);
  canvas.line(x, y + 18.5, x + SidePanel::kWidth, y + 18.5, 1);
  return y + 26;
}

double line_of_text(Canvas& canvas, double x, double y, const std::string& text, const Font& font) {
  canvas.colour(ink::kText);
  canvas.text(x, y + 13, canvas.shortened(text, font, SidePanel::kWidth), font);
  return y + kLine;
}

/// `text` broken at blanks into lines of at most the panel's width.
double paragraph(Canvas& canvas, double x, double y, const std::string& text, const Font& font) {
  std::string line;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t blank = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, blank - begin);
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && canvas.width_of(longer, font) > SidePanel::kWidth) {
      y = line_of_text(canvas, x, y, line, font);
      line = word;
    } else {
      line = longer;
    }
    begin = blank + 1;
  }
  return line.empty() ? y : line_of_text(canvas, x, y, line, font);
}

std::string with_arrow(std::string text) {
  if (const std::size_t at = text.find("->"); at != std::string::npos) text.replace(at, 2, "→");
  return text;
}

double legend(Canvas& canvas, const View& view, double x, double y) {
  y = heading(canvas, x, y, "SAMPLES IN VIEW");
  const std::array<int, kMarks> counts = count_marks(view.exhibit, view.window);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const Mark mark = static_cast<Mark>(i);
    if (counts[i] == 0 && mark != Mark::covered) continue;
    draw_mark(canvas, mark, x + 9, y + 8.5, 5);
    canvas.colour(ink::kText);
    canvas.text(x + 28, y + 13, label_of(mark), {13});
    canvas.text_right(x + SidePanel::kWidth, y + 13, std::to_string(counts[i]), {13, false, true});
    y += kLine;
  }
  return y;
}

double wrong_sample(Canvas& canvas, const View& view, double x, double y) {
  y = heading(canvas, x, y, "FIRST WRONG SAMPLE");
  std::string verdict = view.caption.verdict;
  verdict.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(verdict.front())));
  y = line_of_text(canvas, x, y, verdict, {14, true, false});
  y = line_of_text(canvas, x, y, "lies at " + view.caption.location, {13});
  return paragraph(canvas, x, y, view.caption.meaning, {13});
}

double vertices(Canvas& canvas, const View& view, double x, double y) {
  std::string title = view.caption.triangle;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
  y = heading(canvas, x, y, title + ", AS SNAPPED");
  for (const std::string& vertex : view.caption.vertices) {
    double size = 13;
    while (size > 9 && canvas.width_of(vertex, {size, false, true}) > SidePanel::kWidth) size -= 0.5;
    y = line_of_text(canvas, x, y, vertex, {size, false, true});
  }
  return y;
}

double edges(Canvas& canvas, const View& view, double x, double y) {
  y = heading(canvas, x, y, "EDGE FUNCTIONS AT THIS SAMPLE");
  for (const EdgeRow& row : view.caption.edges) {
    const bool decides = row.value.starts_with('-') || row.value == "0";
    canvas.colour(ink::kText);
    canvas.text(x, y + 13, with_arrow(row.edge), {13, decides, true});
    canvas.text_right(x + 258, y + 13, row.value, {13, decides, true});
    canvas.text(x + 276, y + 13, row.side == "-" ? "–" : row.side, {13, decides, true});
    y += kLine;
  }
  canvas.colour(ink::kMuted);
  std::string unit = view.caption.edge_unit;
  unit.replace(unit.find("^2"), 2, "²");
  canvas.text(x, y + 13, unit, {11});
  y += kLine + 2;
  return paragraph(canvas, x, y, with_arrow(view.caption.reason), {13, true, false});
}

}  // namespace

double SidePanel::draw(Canvas& canvas, const View& view, double x, double y) const {
  y = legend(canvas, view, x, y);
  if (!view.caption.verdict.empty()) y = wrong_sample(canvas, view, x, y + kSection);
  if (!view.caption.vertices[0].empty()) y = vertices(canvas, view, x, y + kSection);
  if (!view.caption.edges.empty()) y = edges(canvas, view, x, y + kSection);
  if (const double height = overview_height(view); height > 0) {
    y = heading(canvas, x, y + kSection, "OVERVIEW");
    draw_overview(canvas, view, x, y, kWidth);
    y += height;
  }
  return y;
}

std::vector<std::string> wrap_command(Canvas& canvas, const std::string& command, const Font& font, double width) {
  std::vector<std::string> lines;
  std::string rest = command;
  while (canvas.width_of(rest, font) > width) {
    std::size_t cut = std::string::npos;
    for (std::size_t blank = rest.find(' '); blank != std::string::npos; blank = rest.find(' ', blank + 1)) {
      if (cut != std::string::npos && canvas.width_of(rest.substr(0, blank) + " \\", font) > width) break;
      cut = blank;
    }
    if (cut == std::string::npos) break;
    lines.push_back(rest.substr(0, cut) + " \\");
    rest = rest.substr(cut + 1);
  }
  lines.push_back(rest);
  return lines;
}

}  // namespace edgecase::conformance
