#include "conformance/casefile/cursor.h"

#include <fmt/format.h>

#include "conformance/casefile/coordinate.h"

namespace edgecase::conformance {
namespace {

std::string described(const JsonNode& node) {
  switch (node.kind) {
    case JsonNode::Kind::null:
      return "null";
    case JsonNode::Kind::boolean:
      return node.boolean ? "true" : "false";
    case JsonNode::Kind::integer:
      return std::to_string(node.integer);
    case JsonNode::Kind::real:
      return printable(node.text);
    case JsonNode::Kind::string:
      return fmt::format("\"{}\"", printable(node.text));
    case JsonNode::Kind::array:
      return fmt::format("an array of {}", node.children.size());
    case JsonNode::Kind::object:
      break;
  }
  return "an object";
}

}  // namespace

std::string Cursor::path() const {
  if (parent_ == nullptr) return "";
  const std::string before = parent_->path();
  if (parent_->node_->kind == JsonNode::Kind::array) return fmt::format("{}[{}]", before, index_);
  const std::string key = printable(parent_->node_->keys[index_]);
  return before.empty() ? key : fmt::format("{}.{}", before, key);
}

tl::unexpected<Error> Cursor::remark(std::string_view what) const {
  const std::string field = path();
  return tl::unexpected<Error>(
      {ErrorKind::bad_input, fmt::format("{}:{}: {}{}{}", file_, node_->line, field, field.empty() ? "" : ": ", what)});
}

tl::unexpected<Error> Cursor::fault(std::string_view what) const {
  return remark(fmt::format("{} {}", described(*node_), what));
}

tl::expected<std::int64_t, Error> Cursor::integer(std::int64_t least, std::int64_t greatest) const {
  const std::int64_t value = node_->integer;
  if (node_->kind != JsonNode::Kind::integer || value < least || value > greatest)
    return fault(fmt::format("is not a whole number from {} to {}", least, greatest));
  return value;
}

tl::expected<std::string_view, Error> Cursor::string() const {
  if (node_->kind != JsonNode::Kind::string) return fault("is not a string");
  return node_->text;
}

tl::expected<bool, Error> Cursor::boolean() const {
  if (node_->kind != JsonNode::Kind::boolean) return fault("is neither true nor false");
  return node_->boolean;
}

tl::expected<float, Error> Cursor::coordinate() const {
  if (node_->kind != JsonNode::Kind::string) return fault("is not a string; coordinates are written as \"1.5\"");
  const auto value = parse_coordinate(node_->text);
  if (!value) return fault(value.error());
  return *value;
}

tl::expected<float, Error> Cursor::finite() const {
  if (node_->kind != JsonNode::Kind::string) return fault("is not a string; numbers are written as \"1.5\"");
  const auto value = parse_finite(node_->text);
  if (!value) return fault(value.error());
  return *value;
}

tl::expected<void, Error> Cursor::array(std::string_view what, std::size_t size) const {
  if (node_->kind != JsonNode::Kind::array || (size != 0 && node_->children.size() != size))
    return fault(fmt::format("is not {}", what));
  return {};
}

}  // namespace edgecase::conformance
