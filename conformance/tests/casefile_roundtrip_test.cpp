// What write_case writes, parse_case reads as the same; and no text at all makes parse_case do worse than report it.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "conformance/casefile/casefile.h"
#include "conformance/scene/assemble.h"
#include "conformance/scene/standard_samples.h"

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

Setting any_setting(const Extent& target) {
  Setting setting;
  setting.target = target;
  if (*rc::gen::arbitrary<bool>()) {
    const auto standard = standard_sample_locations(1 << *rc::gen::inRange(0, 5));
    setting.sample_locations.assign(standard.begin(), standard.end());
  } else {
    setting.sample_locations.resize(*rc::gen::inRange<std::size_t>(1, 17));
    for (SampleLocation& at : setting.sample_locations) at = {*rc::gen::inRange(0, 16), *rc::gen::inRange(0, 16)};
  }
  if (*rc::gen::arbitrary<bool>()) {
    const auto size = rc::gen::map(rc::gen::arbitrary<int>(), [](int value) { return value & 0x7fffffff; });
    setting.scissor = Rect{*rc::gen::arbitrary<int>(), *rc::gen::arbitrary<int>(), *size, *size};
  }
  setting.cull = static_cast<CullMode>(*rc::gen::inRange(0, 3));
  setting.front_face = static_cast<FrontFace>(*rc::gen::inRange(0, 2));
  return setting;
}

/// Triangles, or an assembly with them, or clip space.
void add_geometry(Scene& scene) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 12);
  const auto coordinate = any_coordinate();
  const int kind = *rc::gen::inRange(0, 3);
  if (kind == 0) {
    for (std::size_t i = 0; i < count; ++i) {
      auto& triangle = scene.triangles.emplace_back();
      for (auto& position : triangle) position = {*coordinate, *coordinate};
    }
  } else if (kind == 1) {
    Assembly& assembly = scene.assembly.emplace();
    assembly.topology = static_cast<Topology>(*rc::gen::inRange(0, 3));
    assembly.vertices.resize(count * 3);
    for (auto& position : assembly.vertices) position = {*coordinate, *coordinate};
    if (*rc::gen::arbitrary<bool>()) {
      const bool restarts = assembly.topology != Topology::list;
      assembly.indices = {0, 1, 2};
      if (restarts) assembly.indices.push_back(kRestartIndex);
      for (std::size_t i = 0; i < count * 3; ++i)
        assembly.indices.push_back(static_cast<std::uint32_t>(*rc::gen::inRange<std::size_t>(0, count * 3)));
    }
    scene.triangles = assemble(assembly);
  } else {
    // The reader wants a width above 0 and a height other than 0.
    const auto size = rc::gen::suchThat(coordinate, [](float value) { return value != 0; });
    ClipGeometry& clip = scene.clip.emplace();
    clip.viewport = {*coordinate, *coordinate, std::fabs(*size), *size};
    const auto finite = rc::gen::map(rc::gen::arbitrary<std::uint32_t>(), [](std::uint32_t value) {
      const float number = std::bit_cast<float>(value);
      return std::isfinite(number) ? number : 1.0f;
    });
    clip.triangles.resize(count);
    for (auto& triangle : clip.triangles) {
      for (auto& position : triangle) position = {*finite, *finite, *finite, *finite};
    }
  }
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
  made.scene.rules.half_pixel_first = made.scene.rules.subpixel_bits > 0 && *rc::gen::arbitrary<bool>();
  made.scene.setting = any_setting(made.scene.setting.target);
  add_geometry(made.scene);
  if (made.scene.clip) return made;
  const std::size_t triangles = made.scene.triangles.size();
  // One triangle is a mesh whatever its shape.
  for (std::size_t i = 0; i < triangles && made.scene.setting.cull == CullMode::none; ++i) {
    if (*rc::gen::arbitrary<bool>()) made.scene.meshes.push_back({i, 1});
  }
  if (*rc::gen::arbitrary<bool>()) {
    auto& counts = made.expect.emplace().counts;
    const int most = static_cast<int>(std::min<std::size_t>(triangles, 9));
    for (int i = 0; i < width * height * made.scene.setting.samples(); ++i)
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
  // Equal bits are seen to below, by equal text, where == would take -0 for 0.
  RC_ASSERT(read->scene.assembly == made.scene.assembly);
  RC_ASSERT(read->scene.clip == made.scene.clip);
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
                                                                    "1e9", "null", "\"fan\": ", "\\u0000", "0x",
                                                                    "\"restart\"", "\"clip\": ", "\"samples\": 2,"}),
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
