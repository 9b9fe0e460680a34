// What a scene does not ask for costs it nothing: the union of one centre sample consists of as many instructions of
// each kind, whether samples, scissors, masks, counts and numbers are compiled beside it (the library) or not
// (coverage_only.cpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Function {
  /// How many there are of each name. Their order, and where in its frame a compiler keeps a value, may change with
  /// anything else in the file.
  std::map<std::string, int> instructions;
  std::vector<std::string> references;  ///< symbols, in order
};
using Functions = std::map<std::string, Function>;

/// Turns references to a place in a section, "member .text+0x1234", into the name of the function there. What a call
/// refers to may be the place less the 4 bytes up to the next instruction.
void name_places(Functions& functions, const std::map<std::string, std::map<long, std::string>>& places) {
  for (auto& [name, function] : functions) {
    for (std::string& reference : function.references) {
      const auto sign = reference.find_last_of("+-");
      if (sign == std::string::npos) continue;
      const auto section = places.find(reference.substr(0, sign));
      if (section == places.end()) continue;
      const long offset = std::stol(reference.substr(sign), nullptr, 16);
      for (const long start : {offset, offset + 4}) {
        if (const auto found = section->second.find(start); found != section->second.end()) reference = found->second;
      }
    }
  }
}

/// What fills the gap before a loop or a function, and depends on where that comes to lie.
bool is_padding(const std::string& instruction) {
  return instruction.find("nop") != std::string::npos || instruction.starts_with("xchg   %ax,%ax");
}

/// What objdump says of an object file or of a library's members.
Functions disassemble(const std::string& file) {
  const std::string command = "'" EDGECASE_OBJDUMP "' -dr --no-show-raw-insn '" + file + "'";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  const std::regex header(R"(^([0-9a-f]+) <(.+)>:$)");
  const std::regex instruction(R"(^ *[0-9a-f]+:\t(.*)$)");
  const std::regex relocation(R"(^\t+[0-9a-f]+: R_\S+\t([^-+]+)(.*)$)");
  const std::regex member(R"(^(\S+): +file format .*$)");
  const std::regex disassembly(R"(^Disassembly of section (\S+):$)");
  const std::regex target(R"(\b[0-9a-f]+ <([^>+]+).*>)");
  std::map<std::string, std::map<long, std::string>> places;  // of functions in sections
  std::string member_name, section;
  Functions functions;
  Function* current = nullptr;
  std::string line;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != '\n') {
      line += static_cast<char>(c);
      continue;
    }
    std::smatch match;
    if (std::regex_match(line, match, header)) {
      current = &(functions[match[2]] = {});  // a library may hold an inline function several times
      places[section][std::stol(match[1], nullptr, 16)] = match[2];
    } else if (std::regex_match(line, match, member)) {
      member_name = match[1];
    } else if (std::regex_match(line, match, disassembly)) {
      section = member_name + " " + match[1].str();
    } else if (current != nullptr && std::regex_match(line, match, instruction)) {
      const std::string text = match[1];
      if (!is_padding(text)) ++current->instructions[text.substr(0, text.find(' '))];
      if (std::regex_search(text, match, target)) current->references.push_back(match[1]);
    } else if (current != nullptr && std::regex_match(line, match, relocation)) {
      const bool place = match[1].str().starts_with('.');
      current->references.push_back(place ? member_name + " " + match[1].str() + match[2].str() : match[1].str());
    }
    line.clear();
  }
  pclose(pipe);
  name_places(functions, places);
  return functions;
}

/// `name` and all that it calls, in the order of the calls.
void collect(const Functions& functions, const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const auto found = functions.find(name);
  if (found == functions.end()) return;
  names.push_back(name);
  for (const std::string& reference : found->second.references) collect(functions, reference, names);
}

/// The function whose mangled name has `part` in it.
std::string function_named(const Functions& functions, const std::string& part) {
  for (const auto& [name, function] : functions) {
    if (name.find(part) != std::string::npos) return name;
  }
  return {};
}

TEST(NoExtraCost, TheCoveragePathIsTheSameWithAndWithoutTheOtherFeatures) {
  const Functions with = disassemble(EDGECASE_RASTERIZER_LIBRARY);
  const Functions without = disassemble(EDGECASE_COVERAGE_ONLY_OBJECT);
  int compared = 0;
  // Highway's names; the first or the second is `portable`.
  for (const std::string isa : {"N_SCALAR", "N_EMU128", "N_SSE4", "N_AVX2", "N_AVX3"}) {
    const std::string with_name = function_named(with, isa + "11cover_unionE");
    const std::string without_name = function_named(without, isa + "13coverage_onlyE");
    ASSERT_EQ(with_name.empty(), without_name.empty()) << isa;
    if (with_name.empty()) continue;
    std::vector<std::string> with_names, without_names;
    collect(with, with_name, with_names);
    collect(without, without_name, without_names);
    ASSERT_EQ(with_names.size(), without_names.size()) << isa;
    int instructions = 0;
    for (std::size_t i = 0; i < with_names.size(); ++i) {
      const auto& observed = with.at(with_names[i]).instructions;
      const auto& expected = without.at(without_names[i]).instructions;
      EXPECT_EQ(observed, expected) << with_names[i];
      for (const auto& [instruction, count] : observed) instructions += count;
    }
    EXPECT_GT(instructions, 500) << isa << ": what is compared is not all of the path";
    RecordProperty(isa, instructions);
    std::printf("%s: %d instructions in %zu functions\n", isa.c_str(), instructions, with_names.size());
    ++compared;
  }
  EXPECT_GE(compared, 1);
}

}  // namespace
