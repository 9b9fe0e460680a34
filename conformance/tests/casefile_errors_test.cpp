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
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"subpixel_bits\": 17,"),
            "f.json:3: subpixel_bits: 17 is not a whole number from 0 to 16");
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"rounding\": \"up\","),
            "f.json:3: rounding: \"up\" is not nearest_even, half_up, half_away or truncate");
  EXPECT_EQ(replaced("\"s\",", "\"s\", \"rounding\": true,"), "f.json:3: rounding: true is not a string");
}

TEST(CaseFileErrors, HalfPixelFirst) {
  const auto fields = [](std::string_view value) { return replaced("\"s\",", "\"s\", " + std::string(value) + ","); };
  EXPECT_EQ(fields("\"half_pixel_first\": 1"), "f.json:3: half_pixel_first: 1 is neither true nor false");
  EXPECT_EQ(fields("\"half_pixel_first\": true, \"subpixel_bits\": 0"),
            "f.json:3: half_pixel_first: true takes at least 1 subpixel bit");
  EXPECT_EQ(fields("\"half_pixel_first\": false, \"subpixel_bits\": 0"), "no error");
}

TEST(CaseFileErrors, Samples) {
  // Without the expectation, which is one of a single sample.
  const auto fields = [](std::string_view value) {
    const std::string text = with("\"s\",", "\"s\", " + std::string(value) + ",");
    return message(text.substr(0, text.find(",\n\"expect\"")) + "}");
  };
  for (const char* count : {"3", "0", "-1", "17", "32", "\"1\"", "1.0"}) {
    EXPECT_EQ(fields(std::string("\"samples\": ") + count),
              std::string("f.json:3: samples: ") + count + " is not a standard sample count: 1, 2, 4, 8 or 16");
  }
  const auto positions = [&](std::string_view value) { return fields("\"sample_positions\": " + std::string(value)); };
  EXPECT_EQ(positions("[[0, 15]]"), "no error");
  EXPECT_EQ(positions("8"),
            "f.json:3: sample_positions: 8 is not an array of positions [x, y] in sixteenths of a pixel");
  EXPECT_EQ(positions("[]"), "f.json:3: sample_positions: an array of 0 positions; it takes 1 to 16");
  EXPECT_EQ(positions("[[8]]"),
            "f.json:3: sample_positions[0]: an array of 1 is not a position [x, y] in sixteenths of a pixel");
  EXPECT_EQ(positions("[[8, 16]]"), "f.json:3: sample_positions[0][1]: 16 is not a whole number from 0 to 15");
  EXPECT_EQ(positions("[[8, 8], [-1, 8]]"), "f.json:3: sample_positions[1][0]: -1 is not a whole number from 0 to 15");
  EXPECT_EQ(positions("[[\"0.5\", 8]]"),
            "f.json:3: sample_positions[0][0]: \"0.5\" is not a whole number from 0 to 15");
  std::string many;
  for (int i = 0; i < 16; ++i) many += "[8, 8], ";
  EXPECT_EQ(positions("[" + many + "[1, 1]]"),
            "f.json:3: sample_positions: an array of 17 positions; it takes 1 to 16");
  EXPECT_EQ(fields("\"sample_positions\": [[1, 1], [2, 2]], \"samples\": 4"),
            "f.json:3: sample_positions: an array of 2 positions; samples says 4");
  EXPECT_EQ(fields("\"sample_positions\": [[1, 1], [2, 2]], \"samples\": 1"),
            "f.json:3: sample_positions: an array of 2 positions; samples says 1");
  EXPECT_EQ(fields("\"sample_positions\": [[1, 1], [2, 2]], \"samples\": 2"), "no error");
}

TEST(CaseFileErrors, Scissor) {
  const auto scissor = [](std::string_view value) {
    return replaced("\"s\",", "\"s\", \"scissor\": " + std::string(value) + ",");
  };
  EXPECT_EQ(scissor("[-2147483648, 2147483647, 0, 2147483647]"), "no error");
  EXPECT_EQ(scissor("[0, 0, 4]"), "f.json:3: scissor: an array of 3 is not [x, y, width, height]");
  EXPECT_EQ(scissor("[0, 0, -1, 4]"), "f.json:3: scissor[2]: -1 is not a whole number from 0 to 2147483647");
  EXPECT_EQ(scissor("[0, 0, 4, -1]"), "f.json:3: scissor[3]: -1 is not a whole number from 0 to 2147483647");
  EXPECT_EQ(scissor("[2147483648, 0, 4, 4]"),
            "f.json:3: scissor[0]: 2147483648 is not a whole number from -2147483648 to 2147483647");
  EXPECT_EQ(scissor("[0, 0.5, 4, 4]"),
            "f.json:3: scissor[1]: 0.5 is not a whole number from -2147483648 to 2147483647");
}

TEST(CaseFileErrors, Culling) {
  const auto fields = [](std::string_view value) { return replaced("\"s\",", "\"s\", " + std::string(value) + ","); };
  EXPECT_EQ(fields("\"cull\": \"both\""), "f.json:3: cull: \"both\" is not none, front or back");
  EXPECT_EQ(fields("\"cull\": true"), "f.json:3: cull: true is not a string");
  EXPECT_EQ(fields("\"front_face\": \"ccw\""), "f.json:3: front_face: \"ccw\" is not clockwise or counter_clockwise");
  EXPECT_EQ(fields("\"cull\": \"back\", \"watertight\": true"),
            "f.json:3: watertight: the field takes no culling beside it: culled triangles leave holes");
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
            "f.json:1: triangles: the field is missing, and so are fan, strip, vertices and clip");
  const std::string three = R"([["0","0"],["4","0"],["0","4"]])";
  EXPECT_EQ(geometry("\"triangles\": [" + three + "],\n\"fan\": " + three),
            "f.json:6: fan: the case has triangles already; it takes one of triangles, fan, strip, vertices and clip");
  EXPECT_EQ(geometry("\"vertices\": " + three),
            "f.json:5: vertices: the field takes indices, topology or both beside it");
  EXPECT_EQ(geometry("\"strip\": " + three + ", \"vertices\": " + three),
            "f.json:5: vertices: the case has strip already; it takes one of triangles, fan, strip, vertices and clip");
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
  EXPECT_EQ(geometry(vertices + "\"indices\": []"), "f.json:6: indices: an array of 0 indices; they make no triangle");
  EXPECT_EQ(geometry("\"triangles\": [" + three + "],\n\"indices\": [0, 1, 2]"),
            "f.json:6: indices: the field takes vertices beside it");
}

TEST(CaseFileErrors, Topology) {
  const std::string three = R"("vertices": [["0","0"],["4","0"],["0","4"]])";
  EXPECT_EQ(geometry(three + ",\n\"topology\": \"strap\""), "f.json:6: topology: \"strap\" is not list, strip or fan");
  EXPECT_EQ(geometry(three + ",\n\"topology\": 1"), "f.json:6: topology: 1 is not a string");
  EXPECT_EQ(geometry("\"topology\": \"strip\", \"strip\": [[\"0\",\"0\"],[\"4\",\"0\"],[\"0\",\"4\"]]"),
            "f.json:5: topology: the field takes vertices beside it");
  const std::string strip = three + ", \"topology\": \"strip\",\n\"indices\": ";
  EXPECT_EQ(geometry(strip + "[0, 1, 2]"), "no error");
  EXPECT_EQ(geometry(strip + "[0, 1, \"restart\", 2]"),
            "f.json:6: indices: an array of 4 indices; they make no triangle");
  EXPECT_EQ(geometry(strip + "[0, 1, \"reset\"]"), "f.json:6: indices[2]: \"reset\" is not a whole number from 0 to 2");
  EXPECT_EQ(geometry(strip + "[0, 1, null]"), "f.json:6: indices[2]: null is not a whole number from 0 to 2");
  EXPECT_EQ(geometry(strip + "[0, 1, 4294967295]"),
            "f.json:6: indices[2]: 4294967295 is not a whole number from 0 to 2");
  const std::string list = R"("vertices": [["0","0"],["4","0"],["0","4"],["0","0"]], "topology": "list")";
  EXPECT_EQ(geometry(list), "f.json:5: vertices: an array of 4 positions; it takes three for each triangle");
  EXPECT_EQ(geometry(list + ",\n\"indices\": [0, 1]"),
            "f.json:6: indices: an array of 2 indices; it takes three for each triangle");
  for (const char* topology : {"", ", \"topology\": \"list\""}) {
    EXPECT_EQ(geometry(three + topology + ",\n\"indices\": [0, 1, 2, \"restart\", 0, 1]"),
              "f.json:6: indices[3]: \"restart\" takes a topology of strip or fan beside it");
  }
}

TEST(CaseFileErrors, Clip) {
  const auto clip = [](std::string_view fields) { return geometry("\"clip\": " + std::string(fields)); };
  const std::string good = R"([[["-1","-1","0","1"],["1","-1","0","1"],["-1","1","0","1"]]])";
  const auto viewport = [&](std::string_view value) { return clip(good + ",\n\"viewport\": " + std::string(value)); };
  EXPECT_EQ(viewport("[\"0\", \"0\", \"4\", \"4\"]"), "no error");
  EXPECT_EQ(viewport("[\"0\", \"0\", \"4\"]"), "f.json:6: viewport: an array of 3 is not [x, y, width, height]");
  EXPECT_EQ(viewport("[\"0\", \"0\", \"0\", \"4\"]"), "f.json:6: viewport[2]: \"0\" is not above 0");
  EXPECT_EQ(viewport("[\"0\", \"0\", \"-4\", \"4\"]"), "f.json:6: viewport[2]: \"-4\" is not above 0");
  EXPECT_EQ(viewport("[\"0\", \"0\", \"4\", \"-0\"]"), "f.json:6: viewport[3]: \"-0\" is 0");
  EXPECT_EQ(viewport("[\"40000\", \"0\", \"4\", \"4\"]"),
            "f.json:6: viewport[0]: \"40000\" is not from -32768 to 32768");
  EXPECT_EQ(geometry(R"("viewport": ["0","0","4","4"], "fan": [["0","0"],["4","0"],["0","4"]])"),
            "f.json:5: viewport: the field takes clip beside it");
  EXPECT_EQ(clip("[]"), "f.json:5: clip: an array of 0 triangles; a scene has at least one");
  EXPECT_EQ(clip("[[[\"0\",\"0\",\"0\",\"1\"]]]"),
            "f.json:5: clip[0]: an array of 1 is not a triangle of 3 positions [x, y, z, w]");
  EXPECT_EQ(clip(R"([[["0","0"],["4","0"],["0","4"]]])"),
            "f.json:5: clip[0][0]: an array of 2 is not a position [x, y, z, w]");
  EXPECT_EQ(clip(R"([[["0","0","0",1],["4","0","0","1"],["0","4","0","1"]]])"),
            "f.json:5: clip[0][0][3]: 1 is not a string; numbers are written as \"1.5\"");
  EXPECT_EQ(clip(R"([[["0","0","0","1e39"],["4","0","0","1"],["0","4","0","1"]]])"),
            "f.json:5: clip[0][0][3]: \"1e39\" is not from -3.4028235e+38 to 3.4028235e+38");
  EXPECT_EQ(
      clip(R"([[["0","0","0","1"],["1","0","0","1"],["0","1","0","1"]],
                     [["0","0","0","1"],["1","0","0","1"],["1","1","0","1"]]], "watertight": true)"),
      "f.json:6: watertight: triangles 0 and 1 both run from [\"0\", \"0\", \"0\", \"1\"] to [\"1\", \"0\", \"0\", "
      "\"1\"]; they overlap or differ in winding");
  EXPECT_EQ(clip(R"([[["-1","-1","0","1"],["2","-1","0","1"],["-1","1","0","1"]]])"),
            "f.json:6: expect: clip[0][1] has no exact window position (inside the view volume, w a power of two, no "
            "rounding; or every w below 0), and without that nothing can be expected");
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

TEST(CaseFileErrors, ExpectOfSamples) {
  const auto expect = [](std::string_view value) {
    std::string text = with("[\"####\", \"###.\"]", value);
    text.insert(text.find("\"source\""), "\"samples\": 2, ");
    return message(text);
  };
  EXPECT_EQ(expect("[[\"####\", \"###.\"], [\"##..\", \"....\"]]"), "no error");
  EXPECT_EQ(expect("\"####\""), "f.json:7: expect: \"####\" is not an array with the rows of each sample");
  EXPECT_EQ(expect("[[\"####\", \"###.\"]]"), "f.json:7: expect: the rows of 1 samples; the case has 2");
  EXPECT_EQ(expect("[\"####\", \"###.\"]"),
            "f.json:7: expect[0]: \"####\" is not an array of strings, one for each row of the target");
  EXPECT_EQ(expect("[[\"####\", \"###.\"], [\"##..\"]]"), "f.json:7: expect[1]: 1 rows; the target is 2 high");
  EXPECT_EQ(expect("[[\"####\", \"###.\"], [\"##..\", \"###\"]]"),
            "f.json:7: expect[1][1]: \"###\" has 3 characters; the target is 4 wide");
}

}  // namespace
}  // namespace edgecase::conformance
