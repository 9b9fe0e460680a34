// A value of a case file and the way to it, so that every error can name both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "conformance/casefile/json_tree.h"
#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// Points into a JsonNode and at the Cursor it was reached from; both must outlive it. Costs nothing until something is
/// wrong: only then is the path, as `triangles[3][1][0]`, put together.
class Cursor {
 public:
  Cursor(const JsonNode& root, std::string_view file) : node_(&root), file_(file) {}

  const JsonNode& node() const { return *node_; }
  std::size_t size() const { return node_->children.size(); }
  /// Child i of an array or object.
  Cursor operator[](std::size_t i) const { return {node_->children[i], *this, i}; }

  /// `FILE:LINE: PATH: VALUE what`.
  tl::unexpected<Error> fault(std::string_view what) const;
  /// `FILE:LINE: PATH: what`, for what is wrong with more than the value.
  tl::unexpected<Error> remark(std::string_view what) const;

  tl::expected<std::int64_t, Error> integer(std::int64_t least, std::int64_t greatest) const;
  tl::expected<std::string_view, Error> string() const;
  tl::expected<bool, Error> boolean() const;
  /// A finite binary32 number, as coordinate.h says.
  tl::expected<float, Error> coordinate() const;
  /// The same, of any size.
  tl::expected<float, Error> finite() const;
  /// One of `names`.
  template <class Choice, std::size_t N>
  tl::expected<Choice, Error> choice(const std::array<std::pair<std::string_view, Choice>, N>& names) const {
    const auto name = string();
    if (!name) return tl::unexpected(name.error());
    std::string known;
    for (std::size_t i = 0; i < N; ++i) {
      if (names[i].first == *name) return names[i].second;
      known.append(i == 0 ? "" : i + 1 == N ? " or " : ", ").append(names[i].first);
    }
    return fault("is not " + known);
  }
  /// Whether this is an array, of `size` items where that is not 0; `what` says what it should be: `[width, height]`.
  tl::expected<void, Error> array(std::string_view what, std::size_t size = 0) const;

 private:
  Cursor(const JsonNode& node, const Cursor& parent, std::size_t index)
      : node_(&node), parent_(&parent), index_(index), file_(parent.file_) {}
  std::string path() const;

  const JsonNode* node_;
  const Cursor* parent_ = nullptr;
  std::size_t index_ = 0;
  std::string_view file_;
};

}  // namespace edgecase::conformance
