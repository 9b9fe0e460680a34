// What write_case writes, parse_case reads as the same; and no text at all makes parse_case do worse than report it.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "conformance/casefile/casefile.h"

namespace edgecase::conformance {
namespace {

/// Grid points, and any other binary32 number in range.
rc::Gen<float> any_coordinate() {
  const auto grid = rc::gen::map(rc::gen::inRange(-32768 * 256, 32768 * 256 + 1),
                                 [](int value) { return static_cast<float>(value) / 256; });
  const auto bits = rc::gen::map(rc::gen::arbitrary<std::uint32_t>(), [](std::uint32_t value) {
    const float number = std::bit_cast<float>(value);
    return std::fabs(number) <= kMaxCaseCoordinate ? number : -0.0f;
  });
  return rc::gen::oneOf(grid, bits);
}

std::string any_sentence() {
  // Unicode up to U+00FF, and everything that JSON escapes.
  std::string text = "x";
  for (const int c : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 256))) {
    if (c < 0x80) {
      text += static_cast<char>(c);
    } else {
      text += static_cast<char>(0xC0 | (c >> 6));
      text += static_cast<char>(0x80 | (c & 0x3F));
    }
  }
  return text;
}

Case any_case() {
  Case made;
  made.about = any_sentence();
  made.source = any_sentence();
  const int width = *rc::gen::inRange(1, 10);
  const int height = *rc::gen::inRange(1, 6);
  made.scene.setting.target = {width, height};
  made.scene.rules.subpixel_bits = *rc::gen::inRange(0, 17);
  made.scene.rules.rounding = static_cast<SnapRounding>(*rc::gen::inRange(0, 4));
  const auto triangles = *rc::gen::inRange<std::size_t>(1, 12);
  for (std::size_t i = 0; i < triangles; ++i) {
    auto& triangle = made.scene.triangles.emplace_back();
    for (auto& position : triangle) position = {*any_coordinate(), *any_coordinate()};
  }
  // One triangle is a mesh whatever its shape.
  for (std::size_t i = 0; i < triangles; ++i) {
    if (*rc::gen::arbitrary<bool>()) made.scene.meshes.push_back({i, 1});
  }
  if (*rc::gen::arbitrary<bool>()) {
    auto& counts = made.expect.emplace().counts;
    const int most = static_cast<int>(std::min<std::size_t>(triangles, 9));
    for (int i = 0; i < width * height; ++i)
      counts.push_back(static_cast<std::int8_t>(*rc::gen::inRange(int{Expectation::kMay}, most + 1)));
  }
  return made;
}

RC_GTEST_PROP(CaseFileProperty, WhatIsWrittenReadsBackBitForBit, ()) {
  const Case made = any_case();
  const std::string text = write_case(made);
  const auto read = parse_case(text, "p", "fan/n");
  if (!read) RC_FAIL(read.error().message);
  RC_ASSERT(read->about == made.about);
  RC_ASSERT(read->source == made.source);
  RC_ASSERT(read->scene.setting == made.scene.setting);
  RC_ASSERT(read->scene.rules == made.scene.rules);
  RC_ASSERT(read->scene.meshes == made.scene.meshes);
  RC_ASSERT(read->expect == made.expect);
  RC_ASSERT(read->scene.triangles.size() == made.scene.triangles.size());
  for (std::size_t i = 0; i < made.scene.triangles.size(); ++i) {
    using Bits = std::array<std::uint32_t, 6>;
    RC_ASSERT(std::bit_cast<Bits>(read->scene.triangles[i]) == std::bit_cast<Bits>(made.scene.triangles[i]));
  }
  RC_ASSERT(write_case(*read) == text);
}

RC_GTEST_PROP(CaseFileProperty, DamagedTextIsReadOrReportedInOneLine, ()) {
  std::string text = write_case(any_case());
  const auto damages = *rc::gen::inRange(1, 4);
  for (int i = 0; i < damages; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto count = *rc::gen::inRange<std::size_t>(0, 12);
    const auto inserted =
        *rc::gen::oneOf(rc::gen::elementOf(std::vector<std::string>{"", "\"", "[", "]", "{", "}", ",", "\n", "/*", "-",
                                                                    "1e9", "null", "\"fan\": ", "\\u0000", "0x"}),
                        rc::gen::container<std::string>(rc::gen::arbitrary<char>()));
    text.replace(at, count, inserted);
    if (text.empty()) text = " ";
  }
  const auto read = parse_case(text, "p.json", "p");
  if (read) return;
  RC_ASSERT(read.error().kind == ErrorKind::bad_input);
  RC_ASSERT(read.error().message.starts_with("p.json:"));
  for (const char c : read.error().message) RC_ASSERT(static_cast<unsigned char>(c) >= 0x20);
  RC_ASSERT(read.error().message.size() < 400);
}

}  // namespace
}  // namespace edgecase::conformance
