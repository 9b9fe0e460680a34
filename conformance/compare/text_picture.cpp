#include "conformance/compare/text_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/compare/caption.h"

namespace edgecase::conformance {
namespace {

/// The lines above the rows: every fifth column's number, as far as there is room, and a mark over the wrong column.
std::string column_header(const Exhibit& exhibit, const Window& window, std::size_t margin, std::size_t stride) {
  const std::size_t width = margin + static_cast<std::size_t>(window.width) * stride;
  std::string numbers(width, ' ');
  std::size_t free_from = 0;
  for (int x = window.x; x < window.x + window.width; ++x) {
    const std::size_t at = margin + static_cast<std::size_t>(x - window.x) * stride;
    const std::string number = std::to_string(x);
    if (x % 5 != 0 || at < free_from) continue;
    numbers.resize(std::max(numbers.size(), at + number.size()), ' ');
    numbers.replace(at, number.size(), number);
    free_from = at + number.size() + 1;
  }
  std::string header = numbers.substr(0, numbers.find_last_not_of(' ') + 1) + "\n";
  if (exhibit.wrong && window.contains(exhibit.wrong->x, exhibit.wrong->y)) {
    const auto column = static_cast<std::size_t>(exhibit.wrong->x - window.x) * stride;
    header += std::string(margin + column + static_cast<std::size_t>(exhibit.wrong->sample), ' ') + "v\n";
  }
  return header;
}

std::string legend(const std::array<int, kMarks>& counts) {
  constexpr std::array<const char*, kMarks> kNames = {
      ". not covered", "# covered", "o missing", "x unexpected", "2-9 doubled", "- open, uncovered", "+ open, covered"};
  std::string line;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (counts[i] == 0) continue;
    line += fmt::format("{}{} {}", line.empty() ? "" : "   ", kNames[i], counts[i]);
  }
  return line + "\n";
}

std::string caption_text(const Caption& caption, const std::string& command) {
  std::string text;
  if (!caption.verdict.empty()) {
    text += fmt::format("{}, at {}: {}\n", caption.verdict, caption.location, caption.meaning);
  }
  if (!caption.vertices[0].empty()) {
    text += fmt::format("{}: {}  {}  {}\n", caption.triangle, caption.vertices[0], caption.vertices[1],
                        caption.vertices[2]);
  }
  if (!caption.edges.empty()) {
    text += fmt::format("edge functions there, {}:\n", caption.edge_unit);
    std::size_t width = 0;
    for (const EdgeRow& row : caption.edges) width = std::max(width, row.value.size());
    for (const EdgeRow& row : caption.edges)
      text += fmt::format("  {}  {:>{}}  {}\n", row.edge, row.value, width, row.side);
    text += caption.reason + "\n";
  }
  if (!command.empty()) text += fmt::format("$ {}\n", command);
  return text;
}

}  // namespace

char character_of(const SampleState& state) {
  switch (state.mark) {
    case Mark::empty:
      return '.';
    case Mark::covered:
      return '#';
    case Mark::missing:
      return 'o';
    case Mark::unexpected:
      return 'x';
    case Mark::doubled:
      return static_cast<char>('0' + std::min(state.observed, 9));
    case Mark::open_empty:
      return '-';
    case Mark::open_covered:
      return '+';
  }
  return ' ';
}

std::string text_picture(const Exhibit& exhibit) {
  const Window window = choose_window(exhibit);
  const int samples = exhibit.scene.setting.samples();
  const std::size_t digits = std::to_string(window.y + window.height - 1).size();
  const std::size_t margin = digits + 3;
  const std::size_t stride = static_cast<std::size_t>(samples) + (samples > 1 ? 1 : 0);
  const Caption caption = make_caption(exhibit);

  std::string text = fmt::format("{}\n{}\n", exhibit.title, caption.setting);
  text += column_header(exhibit, window, margin, stride);
  for (int y = window.y; y < window.y + window.height; ++y) {
    const bool points = exhibit.wrong && exhibit.wrong->y == y;
    text += fmt::format("{} {:>{}} ", points ? '>' : ' ', y, digits);
    for (int x = window.x; x < window.x + window.width; ++x) {
      if (samples > 1 && x != window.x) text += ' ';
      for (int s = 0; s < samples; ++s) text += character_of(sample_state(exhibit, x, y, s));
    }
    text += '\n';
  }
  return text + legend(count_marks(exhibit, window)) + caption_text(caption, exhibit.command);
}

}  // namespace edgecase::conformance
