// Every way in which the text of a case file can be wrong, and the whole line that says so.

#include <gtest/gtest.h>

#include <string>

#include "conformance/casefile/casefile.h"

namespace edgecase::conformance {
namespace {

std::string message(std::string_view text) {
  const auto result = parse_case(text, "f.json", "f");
  if (result) return "no error";
  EXPECT_EQ(result.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
  return result.error().message;
}

constexpr std::string_view kGood = R"({
"about": "a",
"source": "s",
"target": [4, 2],
"triangles": [[["0", "0"], ["4", "0"],
["0", "4"]]],
"expect": ["####", "###."]
})";

/// kGood with one passage replaced.
std::string with(std::string_view old_text, std::string_view new_text) {
  std::string text(kGood);
  const auto at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return text.replace(at, old_text.size(), new_text);
}

std::string replaced(std::string_view old_text, std::string_view new_text) { return message(with(old_text, new_text)); }

/// kGood with another geometry, in line 5.
std::string geometry(std::string_view fields) {
  return replaced("\"triangles\": [[[\"0\", \"0\"], [\"4\", \"0\"],\n[\"0\", \"4\"]]]", fields);
}

TEST(CaseFileErrors, TheGoodOneIsGood) { EXPECT_EQ(message(kGood), "no error"); }

TEST(CaseFileErrors, NotJson) {
  EXPECT_EQ(message(""), "f.json: the file is empty");
  EXPECT_EQ(message(" \n\t"), "f.json: the file is empty");
  EXPECT_EQ(message("{\n  \"about\": x\n}"), "f.json:2:12: not JSON: invalid literal");
  EXPECT_EQ(message("{\"about\": \"a\",\n  about: 1}"),
            "f.json:2:3: not JSON: invalid literal; expected string literal");
  EXPECT_EQ(message("{\"about\": [1"), "f.json:1:13: not JSON: unexpected end of input; expected ']'");
  EXPECT_EQ(message("{}\n{}"), "f.json:2:1: not JSON: unexpected '{'; expected end of input");
  EXPECT_EQ(message("{\"about\": 1e999}"), "f.json:1:15: not JSON: number overflow parsing '1e999'");
  EXPECT_EQ(message("{\"about\": \"\xff\"}"), "f.json:1:12: not JSON: invalid string: ill-formed UTF-8 byte");
}

TEST(CaseFileErrors, NotACase) {
  EXPECT_EQ(message("[]"), "f.json:1: an array of 0 is not an object with the fields of a case");
  EXPECT_EQ(message("\n\n3"), "f.json:3: 3 is not an object with the fields of a case");
}

TEST(CaseFileErrors, DeepNesting) {
  EXPECT_EQ(message("{\"about\":\n" + std::string(15, '[') + "0" + std::string(15, ']') + "}"),
            "f.json:1: source: the field is missing");
  EXPECT_EQ(message("{\"about\":\n" + std::string(16, '[') + "0" + std::string(16, ']') + "}"),
            "f.json:2: arrays and objects are nested deeper than 16");
  EXPECT_EQ(message(std::string(5'000'000, '[')), "f.json:1: arrays and objects are nested deeper than 16");
}

TEST(CaseFileErrors, Fields) {
  EXPECT_EQ(replaced("\"source\"", "\"sorce\""), "f.json:3: sorce: unknown field; did you mean source?");
  EXPECT_EQ(replaced("\"source\"", "\"colour\""), "f.json:3: colour: unknown field");
  EXPECT_EQ(replaced("\"source\"", "\"a\\nb\""), "f.json:3: a\\x0Ab: unknown field");
  EXPECT_EQ(replaced("\"source\"", "\"about\""), "f.json:3: \"about\" is given twice, first in line 2");
  EXPECT_EQ(replaced("\"about\": \"a\",", ""), "f.json:1: about: the field is missing");
  EXPECT_EQ(replaced("\"source\": \"s\",", ""), "f.json:1: source: the field is missing");
  EXPECT_EQ(replaced("\"target\": [4, 2],", ""), "f.json:1: target: the field is missing");
}

TEST(CaseFileErrors, Sentences) {
  EXPECT_EQ(replaced("\"a\"", "12"), "f.json:2: about: 12 is not a string");
  EXPECT_EQ(replaced("\"a\"", "\"\""), "f.json:2: about: \"\" is empty");
  EXPECT_EQ(replaced("\"s\"", "null"), "f.json:3: source: null is not a string");
}

TEST(CaseFileErrors, LongValuesAreCutBetweenCharacters) {
  const std::string long_value = std::string(59, 'y') + "\u00e9\u00e9";
  EXPECT_EQ(replaced("\"source\"", "\"" + long_value + "\""),
            "f.json:3: " + std::string(59, 'y') + "...: unknown field");
}

TEST(CaseFileErrors, Target) {
  EXPECT_EQ(replaced("[4, 2]", "4"), "f.json:4: target: 4 is not [width, height]");
  EXPECT_EQ(replaced("[4, 2]", "[4, 2, 1]"), "f.json:4: target: an array of 3 is not [width, height]");
  EXPECT_EQ(replaced("[4, 2]", "[0, 2]"), "f.json:4: target[0]: 0 is not a whole number from 1 to 16384");
  EXPECT_EQ(replaced("[4, 2]", "[4, 16385]"), "f.json:4: target[1]: 16385 is not a whole number from 1 to 16384");
  EXPECT_EQ(replaced("[4, 2]", "[4, -1]"), "f.json:4: target[1]: -1 is not a whole number from 1 to 16384");
  EXPECT_EQ(replaced("[4, 2]", "[4, 2.0]"), "f.json:4: target[1]: 2.0 is not a whole number from 1 to 16384");
  EXPECT_EQ(replaced("[4, 2]", "[4, \"2\"]"), "f.json:4: target[1]: \"2\" is not a whole number from 1 to 16384");
  EXPECT_EQ(replaced("[4, 2]", "[4, 18446744073709551617]"),
            "f.json:4: target[1]: 18446744073709551617 is not a whole number from 1 to 16384");
  EXPECT_EQ(replaced("[4, 2]", "[4, 18446744073709551615]"),
            "f.json:4: target[1]: 18446744073709551615 is not a whole number from 1 to 16384");
}

TEST(CaseFileErrors, Rules) {
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"samples\": 3,"), "f.json:3: samples: 3 is not a supported sample count; 1 is");
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"samples\": \"1\","),
            "f.json:3: samples: \"1\" is not a supported sample count; 1 is");
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"subpixel_bits\": 17,"),
            "f.json:3: subpixel_bits: 17 is not a whole number from 0 to 16");
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"rounding\": \"up\","),
            "f.json:3: rounding: \"up\" is not nearest_even, half_up, half_away or truncate");
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"rounding\": true,"), "f.json:3: rounding: true is not a string");
}

TEST(CaseFileErrors, Coordinates) {
  EXPECT_EQ(replaced("[\"4\", \"0\"]", "[\"4\", \"0.1\"]"),
            "f.json:5: triangles[0][1][1]: \"0.1\" is not exact in binary32; the nearest is \"0x1.99999ap-4\"");
  EXPECT_EQ(replaced("[\"0\", \"4\"]", "[\"nan\", \"4\"]"), "f.json:6: triangles[0][2][0]: \"nan\" is not finite");
  EXPECT_EQ(replaced("[\"0\", \"4\"]", "[\"-40000\", \"4\"]"),
            "f.json:6: triangles[0][2][0]: \"-40000\" is not from -32768 to 32768");
  EXPECT_EQ(replaced("[\"0\", \"4\"]", "[\"x\", \"4\"]"),
            "f.json:6: triangles[0][2][0]: \"x\" is not a decimal or hexadecimal number");
  EXPECT_EQ(replaced("[\"0\", \"4\"]", "[0.5, \"4\"]"),
            "f.json:6: triangles[0][2][0]: 0.5 is not a string; coordinates are written as \"1.5\"");
  EXPECT_EQ(replaced("[\"0\", \"4\"]", "[\"0\", 4\n]"),
            "f.json:6: triangles[0][2][1]: 4 is not a string; coordinates are written as \"1.5\"");
  const std::string long_text(1'000'000, '7');
  EXPECT_EQ(replaced("[\"0\", \"4\"]", "[\"" + long_text + "\", \"4\"]"),
            "f.json:6: triangles[0][2][0]: \"" + long_text.substr(0, 60) + "...\" is not from -32768 to 32768");
}

TEST(CaseFileErrors, Geometry) {
  EXPECT_EQ(geometry("\"samples\": 1"),
            "f.json:1: triangles: the field is missing, and so are fan, strip, and vertices with indices");
  const std::string three = R"([["0","0"],["4","0"],["0","4"]])";
  EXPECT_EQ(geometry("\"triangles\": [" + three + "],\n\"fan\": " + three),
            "f.json:6: fan: the case has triangles already; it takes one of triangles, fan, strip, or vertices with "
            "indices");
  EXPECT_EQ(geometry("\"vertices\": " + three),
            "f.json:5: vertices: the field takes indices, and no triangles, fan or "
            "strip, beside it");
  EXPECT_EQ(geometry("\"strip\": " + three + ", \"vertices\": " + three),
            "f.json:5: vertices: the field takes indices, and no triangles, fan or strip, beside it");
  EXPECT_EQ(geometry("\"indices\": [0, 1, 2]"), "f.json:5: indices: the field takes vertices beside it");
  EXPECT_EQ(geometry("\"triangles\": []"), "f.json:5: triangles: an array of 0 triangles; a scene has at least one");
  EXPECT_EQ(geometry("\"triangles\": {}"), "f.json:5: triangles: an object is not an array of triangles");
  EXPECT_EQ(geometry("\"triangles\": [[[\"0\",\"0\"]]]"),
            "f.json:5: triangles[0]: an array of 1 is not a triangle of 3 positions");
  EXPECT_EQ(geometry("\"fan\": [[\"0\",\"0\"], [\"4\",\"0\",\"1\"], [\"0\",\"0\"]]"),
            "f.json:5: fan[1]: an array of 3 is not a position [x, y]");
  EXPECT_EQ(geometry("\"fan\": [[\"0\",\"0\"], [\"4\",\"0\"]]"),
            "f.json:5: fan: an array of 2 positions; it takes at "
            "least 3");
  EXPECT_EQ(geometry("\"strip\": 7"), "f.json:5: strip: 7 is not an array of positions [x, y]");
  const std::string vertices = "\"vertices\": " + three + ",\n";
  EXPECT_EQ(geometry(vertices + "\"indices\": [0, 1, 3]"), "f.json:6: indices[2]: 3 is not a whole number from 0 to 2");
  EXPECT_EQ(geometry(vertices + "\"indices\": [0, -1, 2]"),
            "f.json:6: indices[1]: -1 is not a whole number from 0 to 2");
  EXPECT_EQ(geometry(vertices + "\"indices\": [0, 1, 2, 0]"),
            "f.json:6: indices: an array of 4 indices; it takes three for each triangle");
  EXPECT_EQ(geometry(vertices + "\"indices\": []"),
            "f.json:6: indices: an array of 0 indices; it takes three for each triangle");
}

TEST(CaseFileErrors, Watertight) {
  const auto watertight = [](std::string_view value) {
    return replaced("\"expect\"", "\"watertight\": " + std::string(value) + ",\n\"expect\"");
  };
  EXPECT_EQ(watertight("1"), "f.json:7: watertight: 1 is not true, false or an array of ranges [first, count]");
  EXPECT_EQ(watertight("[3]"), "f.json:7: watertight[0]: 3 is not a range of triangles [first, count]");
  EXPECT_EQ(watertight("[[1, 1]]"), "f.json:7: watertight[0][0]: 1 is not a whole number from 0 to 0");
  EXPECT_EQ(watertight("[[0, 2]]"), "f.json:7: watertight[0][1]: 2 is not a whole number from 1 to 1");
  EXPECT_EQ(
      geometry(R"("vertices": [["0","0"],["4","0"],["4","4"],["0","4"]], "indices": [0,1,2, 0,3,2],
"watertight": true)"),
      "f.json:6: watertight: triangles 0 and 1 both run from [\"4\", \"4\"] to [\"0\", \"0\"]; they overlap or differ "
      "in winding");
}

TEST(CaseFileErrors, Expect) {
  EXPECT_EQ(replaced("[\"####\", \"###.\"]", "[\"####\"]"), "f.json:7: expect: 1 rows; the target is 2 high");
  EXPECT_EQ(replaced("[\"####\", \"###.\"]", "\"####\""),
            "f.json:7: expect: \"####\" is not an array of strings, one for each row of the target");
  EXPECT_EQ(replaced("\"###.\"", "\"###\""), "f.json:7: expect[1]: \"###\" has 3 characters; the target is 4 wide");
  EXPECT_EQ(replaced("\"###.\"", "\"##x.\""),
            "f.json:7: expect[1]: \"##x.\" has 'x' in column 2; it takes '.', '#', '?' or a digit");
  EXPECT_EQ(replaced("\"###.\"", "\"##2.\""),
            "f.json:7: expect[1]: \"##2.\" asks for 2 triangles in column 2; the scene has 1");
  EXPECT_EQ(replaced("\"###.\"", "1"), "f.json:7: expect[1]: 1 is not a string");
}

}  // namespace
}  // namespace edgecase::conformance
