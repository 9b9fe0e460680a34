#include "conformance/casefile/coordinate.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "conformance/casefile/casefile.h"

namespace edgecase::conformance {
namespace {

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

void expect_value(std::string_view text, float value) {
  const auto parsed = parse_coordinate(text);
  ASSERT_TRUE(parsed) << text << " " << parsed.error();
  EXPECT_EQ(bits(*parsed), bits(value)) << text;
}

void expect_fault(std::string_view text, std::string_view fault) {
  const auto parsed = parse_coordinate(text);
  ASSERT_FALSE(parsed) << text << " = " << *parsed;
  EXPECT_EQ(parsed.error(), fault) << text;
}

TEST(Coordinate, ReadsDecimalAndHexadecimal) {
  expect_value("0", 0.0f);
  expect_value("-0", -0.0f);
  expect_value("-0.000e7", -0.0f);
  expect_value("1.5", 1.5f);
  expect_value(".5", 0.5f);
  expect_value("12.", 12.0f);
  expect_value("0012.50", 12.5f);
  expect_value("-16383.99609375", -16383.99609375f);
  expect_value("125e-3", 0.125f);
  expect_value("0.00125E+2", 0.125f);
  expect_value("0x1.8p+3", 12.0f);
  expect_value("-0X.8P-1", -0.25f);
  expect_value("0xFF", 255.0f);
  expect_value("0x100000000p-32", 1.0f);
  expect_value("-32768", -32768.0f);
  expect_value("0x8p12", 32768.0f);
}

TEST(Coordinate, ReadsTheWholeRangeOfBinary32) {
  expect_value("0x1p-149", 0x1p-149f);
  expect_value("0x1.fffffcp-127", 0x1.fffffcp-127f);
  expect_value(
      "1.40129846432481707092372958328991613128026194187651577175706828388979108268586060148663818836212158203125e-45",
      0x1p-149f);
}

// Each is one last digit away from exact: a reading through double would round the difference away.
TEST(Coordinate, ExactnessIsExact) {
  expect_value("0.100000001490116119384765625", 0.1f);
  expect_fault("0.100000001490116119384765626", "is not exact in binary32; the nearest is \"0x1.99999ap-4\"");
  expect_value("1.00000011920928955078125", 0x1.000002p+0f);
  expect_fault("1.00000011920928955078125000000000000000000000000001",
               "is not exact in binary32; the nearest is \"0x1.000002p+0\"");
  // Half way between two binary32 numbers; a little more; the first exact again.
  expect_fault("1.000000059604644775390625", "is not exact in binary32; the nearest is \"1\"");
  expect_fault("1.000000059604644775390625000000000000000000000000000001",
               "is not exact in binary32; the nearest is \"0x1.000002p+0\"");
  expect_fault("0x1.000001p0", "is not exact in binary32; the nearest is \"1\"");
  expect_fault("0x1.0000010000000000001p0", "is not exact in binary32; the nearest is \"0x1.000002p+0\"");
  expect_value("0x1.00000200000000000000000000p0", 0x1.000002p+0f);
  // 24 bits in 7 digits; 25 bits.
  expect_value("0x0.1FFFFFEp0", 0x1.fffffep-4f);
  expect_fault("0x0.1FFFFFFp0", "is not exact in binary32; the nearest is \"0.125\"");
}

TEST(Coordinate, RefusesWhatIsNotExact) {
  expect_fault("0.1", "is not exact in binary32; the nearest is \"0x1.99999ap-4\"");
  expect_fault("-0.1", "is not exact in binary32; the nearest is \"-0x1.99999ap-4\"");
  expect_fault("1e-400", "is not exact in binary32; the nearest is \"0\"");
  expect_fault("1e-99999999999999999999", "is not exact in binary32; the nearest is \"0\"");
  expect_fault("0x1p-150", "is not exact in binary32; the nearest is \"0\"");
  expect_fault("-0x1p-99999999999999999999", "is not exact in binary32; the nearest is \"-0\"");
}

TEST(Coordinate, RefusesWhatIsOutOfRange) {
  const std::string fault = "is not from -32768 to 32768";
  for (const auto text : {"32769", "-32768.00390625", "1e400", "-1e99999999999999999999", "0x1p16",
                          "0x1p99999999999999999999", "0x8000.0000000000000000000001"})
    expect_fault(text, fault);
}

TEST(Coordinate, FiniteNumbersMayBeOfAnySize) {
  EXPECT_EQ(parse_finite("32769"), 32769.0f);
  EXPECT_EQ(parse_finite("-0x1p+127"), -0x1p127f);
  EXPECT_EQ(parse_finite("0x1.fffffep+127"), std::numeric_limits<float>::max());
  EXPECT_EQ(parse_finite("0x1p-149"), 0x1p-149f);
  const std::string range = "is not from -3.4028235e+38 to 3.4028235e+38";
  for (const char* beyond : {"0x1p+128", "0x1.ffffffp+127", "1e39", "4e38", "-1e999999999999", "0x1p+99999999"}) {
    EXPECT_EQ(parse_finite(beyond).error(), range) << beyond;
  }
  EXPECT_EQ(parse_finite("1e-60").error(), "is not exact in binary32; the nearest is \"0\"");
  EXPECT_EQ(parse_finite("inf").error(), "is not finite");
}

TEST(Coordinate, RefusesWhatIsNotANumber) {
  for (const auto text : {"",    "-",    "+1",    " 1",  "1 ",    "1.5.",   "1,5", "0x",  "0x.",   "0xg",  "1e",
                          "1e+", "0x1p", "0x1p-", "--1", "1e1.5", "0x1e5p", "1f",  "one", "-0x-1", "0x0x1"})
    expect_fault(text, "is not a decimal or hexadecimal number");
  for (const auto text : {"nan", "-NaN", "inf", "-Infinity"}) expect_fault(text, "is not finite");
}

TEST(Coordinate, WritesShortDecimalsOrPowersOfTwo) {
  EXPECT_EQ(write_coordinate(0.0f), "0");
  EXPECT_EQ(write_coordinate(-0.0f), "-0");
  EXPECT_EQ(write_coordinate(-1.5f), "-1.5");
  EXPECT_EQ(write_coordinate(100.0f), "100");
  EXPECT_EQ(write_coordinate(-16383.998046875f), "-16383.998046875");
  EXPECT_EQ(write_coordinate(0.1f), "0x1.99999ap-4");
  EXPECT_EQ(write_coordinate(-0x1p-149f), "-0x0.000002p-126");
}

RC_GTEST_PROP(CoordinateProperty, WhatIsWrittenReadsBackBitForBit, (std::uint32_t pattern)) {
  const float value = std::bit_cast<float>(pattern);
  RC_PRE(std::fabs(value) <= kMaxCaseCoordinate);
  const auto parsed = parse_coordinate(write_coordinate(value));
  RC_ASSERT(parsed.has_value());
  RC_ASSERT(bits(*parsed) == pattern);
}

RC_GTEST_PROP(CoordinateProperty, GridPointsAreShortDecimals, ()) {
  const int grid = *rc::gen::inRange(-32768 * 256, 32768 * 256 + 1);
  const auto text = write_coordinate(static_cast<float>(grid) / 256);
  RC_ASSERT(text.find('x') == std::string::npos);
  RC_ASSERT(bits(*parse_coordinate(text)) == bits(static_cast<float>(grid) / 256));
}

}  // namespace
}  // namespace edgecase::conformance
