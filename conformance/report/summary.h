// What the results of a report add up to: shared by its forms, so that they cannot disagree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "conformance/report/report.h"

namespace edgecase::conformance {

struct Totals {
  std::uint64_t pass = 0;
  std::uint64_t fail = 0;
  std::uint64_t known = 0;
  std::uint64_t skip = 0;
  std::uint64_t triangles = 0;
  std::uint64_t samples_compared = 0;
  std::uint64_t missing = 0;
  std::uint64_t unexpected = 0;
  std::uint64_t doubled = 0;
  std::uint64_t meshes_checked = 0;
  std::uint64_t may = 0;
  std::uint64_t known_triangles = 0;
  std::uint64_t unpredicted = 0;
  Cracks cracks;

  std::uint64_t cases() const { return pass + fail + known + skip; }
  void add(const Result& result);
};

Totals totals_of(const Report& report);

/// The results of one subject.
struct SubjectSummary {
  std::string name;
  std::string device;  ///< the first that is not empty
  Totals totals;
  Totals failed;                     ///< of its failed results alone
  Totals known;                      ///< of its known deviations alone
  std::vector<std::size_t> results;  ///< indices into Report::results, ascending
};

/// In the order in which the subjects first occur.
std::vector<SubjectSummary> by_subject(const Report& report);

/// The results of one subject in one category.
struct CategorySummary {
  std::string category;
  Totals totals;
  std::vector<std::size_t> results;  ///< indices into Report::results, ascending
};

/// In the order in which the categories first occur.
std::vector<CategorySummary> by_category(const Report& report, const SubjectSummary& subject);

/// Results with the same verdict and reason.
struct Cause {
  Verdict verdict = Verdict::skip;
  std::string reason;
  std::vector<std::size_t> results;
};

/// Why those of `results` are known or skipped that are, in the order in which the causes first occur.
std::vector<Cause> causes(const Report& report, const std::vector<std::size_t>& results);

/// One sentence without its full stop that somebody who has never seen a report understands:
/// "lavapipe (llvmpipe (LLVM 15.0.6)) agrees on every one of 1,024 samples of 4 triangles".
std::string sentence(const SubjectSummary& subject);

/// "12 missing, 3 unexpected, 1 doubled" of those that are not zero; "" if all are. They are not added up, because a
/// sample that is unexpected in a triangle may be doubled in its mesh as well.
std::string wrong_samples(std::uint64_t missing, std::uint64_t unexpected, std::uint64_t doubled);

/// "12 holes, 3 doubled among 4,096 samples inside; 2 of 70 clipped meshes torn"; "" if nothing is torn.
std::string torn(const Cracks& cracks);

/// "hole at pixel (12, 7), sample 0, mesh from triangle 5".
std::string place(const Cracks& cracks);

/// What is to be said of one result, line by line: its reason, how many samples are wrong, the first of them and the
/// command that shows it again. What is not there has no line; names hold no line breaks.
std::string details(const Result& result);

/// "missing at pixel (12, 7), sample 0, triangle 5".
std::string place(const FirstWrong& first);

/// "(0x1.8p+0, 0x0p+0) (0x1.8p+0, 0x1.8p+1) (0x1p+2, 0x1.8p+1)".
std::string vertices(const FirstWrong& first);

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t number);

/// "1 case", "2,000 cases"; `plural` is what an s does not make.
std::string counted(std::uint64_t number, const char* noun, const char* plural = nullptr);

}  // namespace edgecase::conformance
