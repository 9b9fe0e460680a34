// Report: what a run found, and its four forms: JSON for programs, JUnit for CI servers, text for a terminal, HTML for
// a browser. Plain values in, strings out; nothing here draws, compares or writes files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "conformance/compare/clip_mesh.h"

namespace edgecase::conformance {

enum class Verdict {
  pass,   ///< every sample compared is as the rules say
  fail,   ///< a wrong sample, a subject that broke, or a known deviation that is no longer there
  known,  ///< wrong exactly as the known-deviations file says
  skip,   ///< outside what the subject can do
};

/// `pass`, `fail`, `known` or `skip`.
const char* name_of(Verdict verdict);

/// The first sample that a subject got wrong, with all that is needed to see it again.
struct FirstWrong {
  std::string kind;            ///< `missing`, `unexpected` or `doubled`
  std::uint64_t triangle = 0;  ///< index within the test case
  int x = 0;                   ///< pixel column from the target's left border
  int y = 0;                   ///< pixel row from the target's top border
  int sample = 0;              ///< index within the pixel
  /// What the rules say about it, for a person; may hold several lines, as a picture in characters does.
  std::string text;
  /// Window x and y of the triangle's three vertices in pixels, as hexadecimal floats.
  std::array<std::array<std::string, 2>, 3> vertices;
  /// The shell command that shows it again; empty if there is none.
  std::string command;
};

/// One picture of a wrong sample. File names are relative to the report folder; an empty one means no such file.
struct Shown {
  std::string caption;
  std::string png;
  std::string svg;
  std::string case_file;  ///< the scene of the picture as a case file
  std::string command;    ///< the shell command that runs that case file
  bool known = false;     ///< explained in the known-deviations file
  bool crack = false;     ///< a mesh that clipping tore
};

/// One subject on one test case.
struct Result {
  std::string subject;   ///< its name on the command line
  std::string device;    ///< as the subject itself reports it; may be empty
  std::string snap;      ///< how it transforms and snaps vertices; may be empty
  std::string testcase;  ///< a case file or a generator
  /// What the test case is about. Results of one subject and category share a line of the table.
  std::string category;
  Verdict verdict = Verdict::pass;
  std::uint64_t triangles = 0;
  std::uint64_t samples_compared = 0;
  std::uint64_t missing = 0;
  std::uint64_t unexpected = 0;
  std::uint64_t doubled = 0;
  /// Meshes in the window that were looked at as a whole: those drawn together with a wrong triangle, and a share of
  /// the others. In the rest, whose triangles are right one by one, no hole or double was looked for.
  std::uint64_t meshes_checked = 0;
  std::uint64_t known_triangles = 0;  ///< triangles that are wrong as a known deviation says
  std::uint64_t unpredicted = 0;      ///< triangles not compared, because no model says what the subject has to cover
  std::uint64_t may = 0;  ///< samples that the rules leave open, covered otherwise than by rounding to nearest even and
                          ///< the top-left rule
  Cracks cracks;          ///< of meshes in clip space; no fault by themselves
  std::optional<FirstWrong> first;
  /// Why it failed or was skipped, or the cause of the known deviation; empty if it passed.
  std::string reason;
  double seconds = 0;          ///< wall-clock time of the whole test case
  double subject_seconds = 0;  ///< the part of it spent inside the subject
  std::vector<Shown> shown;
};

struct Report {
  std::string version;
  std::uint64_t seed = 0;
  std::string rules = "exact";  ///< the set of rules that was asked for
  std::vector<Result> results;
  double seconds = 0;  ///< wall-clock time of the run; less than the sum over its results if they ran side by side
};

/// Every form takes any bytes as text: what is no UTF-8 becomes U+FFFD, and control characters are made visible as \x1b
/// where the format could not carry them or would act on them.

/// {"edgecase": version, "seed", "rules", "results": [...], "categories": [...], "totals": {...}}: categories has one
/// entry for each subject and category, with the causes of what is known or skipped. Every key is always there; what
/// does not apply is null. The pictures are not in it.
std::string to_json(const Report& report);

/// JUnit XML: a suite per subject. A known deviation is a passed test with its cause as output.
std::string to_junit(const Report& report);

/// A table of subjects and categories, what went wrong, the causes of what is known, skipped or torn by clipping, and a
/// closing summary in words. `terminal` adds colours.
std::string to_text(const Report& report, bool terminal);

/// The index.html of a report folder: one page that loads nothing but the pictures beside it.
std::string to_html(const Report& report);

}  // namespace edgecase::conformance
