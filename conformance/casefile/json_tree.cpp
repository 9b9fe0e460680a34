#include "conformance/casefile/json_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace edgecase::conformance {
namespace {

/// Reads the text for the parser, and so knows how far the parser has read when it reports a value. That is the value's
/// last character, or, after a number, the one behind it. A line therefore counts as begun not at the line feed but
/// at its first character: then a number before a line feed still lies on its own line.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, int* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (line_feed_) ++*line_;
    line_feed_ = *at_ == '\n';
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  int* line_;
  bool line_feed_ = false;
};

class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, std::string_view path, const int* line) : text_(text), path_(path), line_(line) {}

  tl::expected<JsonNode, Error> take() {
    if (error_) return tl::unexpected(*error_);
    return std::move(root_);
  }

  bool null() override { return add(node(JsonNode::Kind::null)); }
  bool boolean(bool value) override {
    JsonNode made = node(JsonNode::Kind::boolean);
    made.boolean = value;
    return add(std::move(made));
  }
  bool number_integer(number_integer_t value) override {
    JsonNode made = node(JsonNode::Kind::integer);
    made.integer = value;
    return add(std::move(made));
  }
  bool number_unsigned(number_unsigned_t value) override {
    if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      return number_integer(static_cast<std::int64_t>(value));
    return number_float(0, std::to_string(value));
  }
  bool number_float(number_float_t, const string_t& written) override {
    JsonNode made = node(JsonNode::Kind::real);
    made.text = written;
    return add(std::move(made));
  }
  bool string(string_t& value) override {
    JsonNode made = node(JsonNode::Kind::string);
    made.text = std::move(value);
    return add(std::move(made));
  }
  bool binary(binary_t&) override { return false; }  // JSON text has none

  bool start_object(std::size_t) override { return open(JsonNode::Kind::object); }
  bool key(string_t& value) override {
    const auto [known, is_new] = open_.back().key_lines.emplace(value, *line_);
    if (!is_new)
      return fail(*line_, fmt::format("\"{}\" is given twice, first in line {}", printable(value), known->second));
    open_.back().node.keys.push_back(std::move(value));
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(JsonNode::Kind::array); }
  bool end_array() override { return close(); }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& exception) override {
    // `position` counts the bytes read, the offending one included. At the end of the text that one does not exist.
    const std::string_view before = text_.substr(0, std::min(position == 0 ? 0 : position - 1, text_.size()));
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t line_feed = before.rfind('\n');
    const std::size_t column = before.size() - (line_feed == std::string_view::npos ? 0 : line_feed + 1) + 1;
    error_ = Error{ErrorKind::bad_input,
                   fmt::format("{}:{}:{}: not JSON: {}", path_, line, column, reason(exception.what()))};
    return false;
  }

 private:
  struct Open {
    JsonNode node;
    std::map<std::string, int> key_lines;
  };

  JsonNode node(JsonNode::Kind kind) const {
    JsonNode made;
    made.kind = kind;
    made.line = *line_;
    return made;
  }

  bool add(JsonNode&& made) {
    (open_.empty() ? root_ : open_.back().node.children.emplace_back()) = std::move(made);
    return true;
  }

  bool open(JsonNode::Kind kind) {
    if (open_.size() == kMaxJsonDepth)
      return fail(*line_, fmt::format("arrays and objects are nested deeper than {}", kMaxJsonDepth));
    open_.push_back({node(kind), {}});
    return true;
  }

  bool close() {
    JsonNode closed = std::move(open_.back().node);
    open_.pop_back();
    return add(std::move(closed));
  }

  bool fail(int line, std::string_view what) {
    error_ = Error{ErrorKind::bad_input, fmt::format("{}:{}: {}", path_, line, what)};
    return false;
  }

  /// What is left of the library's message without its own `[name] parse error at line L, column C: syntax error while
  /// parsing X - ` and `; last read: '...'`, which may be as long as the file.
  static std::string reason(std::string_view what) {
    if (const auto dash = what.find(" - "); dash != std::string_view::npos)
      what.remove_prefix(dash + 3);
    else if (const auto name = what.find("] "); name != std::string_view::npos)
      what.remove_prefix(name + 2);
    const auto last_read = what.find("; last read: ");
    const auto expected = what.rfind("; expected ");
    std::string text(what.substr(0, last_read));
    if (expected != std::string_view::npos && last_read != std::string_view::npos && expected > last_read)
      text += what.substr(expected);
    return printable(text, 160);
  }

  std::string_view text_;
  std::string_view path_;
  const int* line_;
  std::vector<Open> open_;
  JsonNode root_;
  std::optional<Error> error_;
};

}  // namespace

tl::expected<JsonNode, Error> parse_json(std::string_view text, std::string_view path) {
  int line = 1;
  TreeBuilder builder(text, path, &line);
  constexpr bool kWholeText = true;
  constexpr bool kComments = true;
  nlohmann::json::sax_parse(CountingIterator(text.data(), &line), CountingIterator(text.data() + text.size(), &line),
                            &builder, nlohmann::json::input_format_t::json, kWholeText, kComments);
  return builder.take();
}

std::string printable(std::string_view text, std::size_t longest) {
  std::size_t end = std::min(text.size(), longest);
  // Not between the bytes of one UTF-8 character: those after the first are 10xxxxxx.
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  std::string result;
  for (const char c : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F)
      result += fmt::format("\\x{:02X}", byte);
    else
      result += c;
  }
  if (end < text.size()) result += "...";
  return result;
}

}  // namespace edgecase::conformance
