#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <unordered_map>

#include "conformance/report/escape.h"
#include "conformance/report/report.h"
#include "conformance/report/summary.h"
#include "page_assets.h"

namespace edgecase::conformance {
namespace {

constexpr std::array kVerdicts{Verdict::fail, Verdict::known, Verdict::pass, Verdict::skip};

/// A browser lays out a table as a whole: many short ones spare it the rows that are out of view.
constexpr std::size_t kRowsOfTable = 200;

/// Tells the verdicts apart where colours do not.
const char* glyph_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "\u2713";  // check mark
    case Verdict::fail:
      return "\u2717";  // ballot x
    case Verdict::known:
      return "\u2248";  // almost equal
    case Verdict::skip:
      return "\u2013";  // dash
  }
  return "";
}

/// The page of one report. Rows and findings carry the numbers of their subject and category in `data-` attributes,
/// which is what the script filters by.
class Page {
 public:
  explicit Page(const Report& report)
      : report_(report), subjects_(by_subject(report)), totals_(totals_of(report)), subject_of_(report.results.size()) {
    for (std::size_t s = 0; s < subjects_.size(); ++s) {
      for (const std::size_t i : subjects_[s].results) subject_of_[i] = s;
    }
    for (const Result& result : report.results) {
      if (category_index_.try_emplace(result.category, categories_.size()).second) {
        categories_.push_back(result.category);
      }
    }
  }

  std::string render() {
    head();
    summary();
    filter();
    findings("failures", "What is wrong", [](const Result& r) { return r.verdict == Verdict::fail; });
    findings("known", "Known deviations", [](const Result& r) { return r.verdict == Verdict::known; });
    findings("cracks", "Meshes that clipping tears", [](const Result& r) {
      return r.cracks.first && r.verdict != Verdict::fail && r.verdict != Verdict::known;
    });
    results();
    add("<script>{}</script>\n</body>\n</html>\n", kPageScript);
    return std::move(out_);
  }

 private:
  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
  }

  static std::string category_name(const std::string& category) {
    return category.empty() ? "other" : markup(category);
  }

  void head() {
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>Edgecase: {} failed, {} passed</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        grouped(totals_.fail), grouped(totals_.pass), kPageStyle);
    add("<header>\n<h1>Triangle coverage, sample by sample</h1>\n"
        "<p class=\"quiet\">edgecase {} &middot; rules {} &middot; seed {} &middot; {} in {:.1f} s</p>\n<ul "
        "class=\"says\">\n",
        markup(report_.version), markup(report_.rules), report_.seed, counted(totals_.cases(), "result"),
        report_.seconds);
    for (const SubjectSummary& subject : subjects_) {
      const Verdict worst = subject.totals.fail != 0    ? Verdict::fail
                            : subject.totals.known != 0 ? Verdict::known
                            : subject.totals.pass != 0  ? Verdict::pass
                                                        : Verdict::skip;
      add("<li><span class=\"glyph {}\">{}</span>{}.</li>\n", name_of(worst), glyph_of(worst),
          markup(sentence(subject)));
    }
    add("{}</ul>\n</header>\n", subjects_.empty() ? "<li>Nothing was compared.</li>\n" : "");
  }

  void summary() {
    using Counts = std::map<Verdict, std::size_t>;
    std::vector<std::vector<Counts>> counts(categories_.size(), std::vector<Counts>(subjects_.size()));
    for (std::size_t i = 0; i < report_.results.size(); ++i) {
      const Result& result = report_.results[i];
      ++counts[category_index_.at(result.category)][subject_of_[i]][result.verdict];
    }
    add("<h2>Summary</h2>\n<div class=\"wide\"><table id=\"summary\">\n<caption>Test cases by category and subject: "
        "<span class=\"pass\">{} passed</span>, <span class=\"fail\">{} failed</span>, <span class=\"known\">{} "
        "deviates as "
        "is known</span>, <span class=\"skip\">{} skipped</span></caption>\n<thead><tr><th scope=\"col\">category</th>",
        glyph_of(Verdict::pass), glyph_of(Verdict::fail), glyph_of(Verdict::known), glyph_of(Verdict::skip));
    for (const SubjectSummary& subject : subjects_) {
      add("<th scope=\"col\">{}<small>{}</small></th>", markup(visible_line(subject.name)),
          markup(visible_line(subject.device)));
    }
    add("</tr></thead>\n<tbody>\n");
    for (std::size_t c = 0; c < categories_.size(); ++c) {
      add("<tr><th scope=\"row\">{}</th>", category_name(categories_[c]));
      for (std::size_t s = 0; s < subjects_.size(); ++s) {
        add("<td>");
        for (const Verdict verdict : kVerdicts) {
          const auto found = counts[c][s].find(verdict);
          if (found == counts[c][s].end()) continue;
          add("<span class=\"{0}\"><a href=\"#results\" data-choose=\"{1} {2} {0}\" "
              "title=\"{0}\">{3}&nbsp;{4}</a></span>",
              name_of(verdict), s, c, grouped(found->second), glyph_of(verdict));
        }
        add("</td>");
      }
      add("</tr>\n");
    }
    add("</tbody>\n<tfoot>\n");
    summary_row("triangles", &Totals::triangles);
    summary_row("samples compared", &Totals::samples_compared);
    summary_row("missing samples", &Totals::missing);
    summary_row("unexpected samples", &Totals::unexpected);
    summary_row("doubled samples", &Totals::doubled);
    add("</tfoot>\n</table></div>\n");
    coverage();
  }

  // A line for each subject and category, with the causes of what is known or skipped.
  void coverage() {
    add("<details><summary>Samples by subject and category</summary>\n<div class=\"wide\"><table id=\"coverage\">\n"
        "<thead><tr><th scope=\"col\">subject</th><th scope=\"col\">category</th>");
    for (const char* name : {"cases", "triangles", "samples", "missing", "unexpected", "doubled", "failed", "known",
                             "skipped", "unpredicted", "cracks"}) {
      add("<th scope=\"col\" class=\"number\">{}</th>", name);
    }
    add("<th scope=\"col\">causes</th></tr></thead>\n<tbody>\n");
    for (const SubjectSummary& subject : subjects_) {
      for (const CategorySummary& category : by_category(report_, subject)) {
        const Totals& t = category.totals;
        add("<tr><td>{}</td><td>{}</td>", markup(visible_line(subject.name)), category_name(category.category));
        for (const std::uint64_t number :
             {t.cases(), t.triangles, t.samples_compared, t.missing, t.unexpected, t.doubled, t.fail, t.known, t.skip,
              t.unpredicted, t.cracks.holes + t.cracks.doubled}) {
          add("<td class=\"number\">{}</td>", grouped(number));
        }
        add("<td>");
        for (const Cause& cause : causes(report_, category.results)) {
          add("<div>{} {}: {}</div>", grouped(cause.results.size()), name_of(cause.verdict), markup(cause.reason));
        }
        add("</td></tr>\n");
      }
    }
    add("</tbody>\n</table></div></details>\n");
  }

  void summary_row(const char* name, std::uint64_t Totals::*number) {
    add("<tr><th scope=\"row\">{}</th>", name);
    for (const SubjectSummary& subject : subjects_) add("<td>{}</td>", grouped(subject.totals.*number));
    add("</tr>\n");
  }

  // Without the script nothing could be filtered: it is what shows the form.
  void filter() {
    add("<form hidden>\n<label>subject<select name=\"subject\"><option value=\"\">all</option>");
    for (std::size_t s = 0; s < subjects_.size(); ++s) {
      add("<option value=\"{}\">{}</option>", s, markup(visible_line(subjects_[s].name)));
    }
    add("</select></label>\n<label>category<select name=\"category\"><option value=\"\">all</option>");
    for (std::size_t c = 0; c < categories_.size(); ++c) {
      add("<option value=\"{}\">{}</option>", c, category_name(categories_[c]));
    }
    add("</select></label>\n<label>verdict<select name=\"verdict\"><option value=\"\">all</option>");
    for (const Verdict verdict : kVerdicts) add("<option>{}</option>", name_of(verdict));
    add("</select></label>\n<label>case<input name=\"search\" type=\"search\" placeholder=\"part of its "
        "name\"></label>\n"
        "<output class=\"quiet\"></output>\n</form>\n");
  }

  void findings(const char* id, const char* title, bool (*belongs)(const Result&)) {
    if (std::ranges::none_of(report_.results, belongs)) return;
    add("<section id=\"{}\">\n<h2>{}</h2>\n", id, title);
    for (std::size_t i = 0; i < report_.results.size(); ++i) {
      if (belongs(report_.results[i])) finding(i);
    }
    add("</section>\n");
  }

  std::string data(std::size_t i) const {
    const Result& result = report_.results[i];
    return fmt::format("data-subject=\"{}\" data-category=\"{}\" data-verdict=\"{}\" data-name=\"{}\"", subject_of_[i],
                       category_index_.at(result.category), name_of(result.verdict),
                       markup_attribute(visible_line(result.testcase)));
  }

  void finding(std::size_t i) {
    const Result& result = report_.results[i];
    const bool known = result.verdict == Verdict::known || result.verdict == Verdict::pass;
    add("<article id=\"r{}\" {}{}>\n", i, known ? "class=\"deviation\" " : "", data(i));
    add("{}<h3><span class=\"glyph {}\">{}</span> {}: {}</h3>{}\n", known ? "<details><summary>" : "",
        name_of(result.verdict), glyph_of(result.verdict), markup(visible_line(result.subject)),
        markup(visible_line(result.testcase)), known ? "</summary>" : "");
    add("<dl>\n");
    if (!result.reason.empty()) add("<dt>{}</dt><dd>{}</dd>\n", known ? "cause" : "reason", markup(result.reason));
    const std::string wrong = wrong_samples(result.missing, result.unexpected, result.doubled);
    if (!wrong.empty()) {
      add("<dt>wrong samples</dt><dd>{} among {} of {}</dd>\n", wrong, counted(result.samples_compared, "sample"),
          counted(result.triangles, "triangle"));
    }
    if (result.verdict == Verdict::known) {
      add("<dt>known triangles</dt><dd>{}</dd>\n", grouped(result.known_triangles));
    }
    if (result.cracks.first) {
      add("<dt>cracks</dt><dd>{}; the first: {}</dd>\n", torn(result.cracks), place(result.cracks));
    }
    if (result.first) {
      add("<dt>first</dt><dd>{}</dd>\n<dt>its triangle</dt><dd><code>{}</code></dd>\n", markup(place(*result.first)),
          markup(vertices(*result.first)));
      if (!result.first->text.empty()) add("<dt></dt><dd><pre>{}</pre></dd>\n", markup(result.first->text));
      command(result.first->command);
    }
    add("</dl>\n");
    if (!result.shown.empty()) {
      add("<div class=\"pictures\">\n");
      for (const Shown& shown : result.shown) picture(shown);
      add("</div>\n");
    }
    add("{}</article>\n", known ? "</details>" : "");
  }

  void command(const std::string& text) {
    if (text.empty()) return;
    add("<dt>to see it again</dt><dd><code class=\"command\">{}</code></dd>\n", markup(visible_line(text)));
  }

  void picture(const Shown& shown) {
    add("<figure>\n");
    const std::string& image = shown.png.empty() ? shown.svg : shown.png;
    const std::string& enlarged = shown.svg.empty() ? shown.png : shown.svg;
    if (!image.empty()) {
      add("<a href=\"{}\"><img src=\"{}\" alt=\"{}\" loading=\"lazy\"></a>\n", relative_url(enlarged),
          relative_url(image), markup_attribute(shown.caption));
    }
    const char* kind = shown.crack   ? "<span class=\"known\">crack:</span> "
                       : shown.known ? "<span class=\"known\">known deviation:</span> "
                                     : "";
    add("<figcaption>{}{}", kind, markup(shown.caption));
    if (!shown.case_file.empty()) {
      add(" <a href=\"{}\">{}</a>", relative_url(shown.case_file), markup(visible_line(shown.case_file)));
    }
    if (!shown.command.empty()) {
      add("\n<code class=\"command\">{}</code>", markup(visible_line(shown.command)));
    }
    add("</figcaption>\n</figure>\n");
  }

  void results() {
    add("<h2 id=\"results\">All results</h2>\n<div class=\"wide\">\n");
    for (std::size_t i = 0; i < report_.results.size(); ++i) {
      if (i % kRowsOfTable == 0) begin_table();
      row(i);
      if ((i + 1) % kRowsOfTable == 0 || i + 1 == report_.results.size()) add("</tbody></table></div>\n");
    }
    add("</div>\n");
  }

  void begin_table() {
    add("<div class=\"rows\"><table><thead><tr>");
    for (const char* name : {"subject", "case", "verdict"}) add("<th scope=\"col\">{}</th>", name);
    for (const char* name : {"triangles", "samples", "missing", "unexpected", "doubled", "seconds"}) {
      add("<th scope=\"col\" class=\"number\">{}</th>", name);
    }
    add("<th scope=\"col\">reason</th></tr></thead>\n<tbody>\n");
  }

  void row(std::size_t i) {
    const Result& result = report_.results[i];
    const bool found = result.verdict == Verdict::fail || result.verdict == Verdict::known || result.cracks.first;
    const std::string name = markup(visible_line(result.testcase));
    add("<tr {}><td>{}</td><td>{}</td><td class=\"verdict {}\"><span class=\"glyph\">{}</span> {}</td>", data(i),
        markup(visible_line(result.subject)), found ? fmt::format("<a href=\"#r{}\">{}</a>", i, name) : name,
        name_of(result.verdict), glyph_of(result.verdict), name_of(result.verdict));
    for (const std::uint64_t number :
         {result.triangles, result.samples_compared, result.missing, result.unexpected, result.doubled}) {
      add("<td class=\"number\">{}</td>", grouped(number));
    }
    add("<td class=\"number\">{:.3f}</td><td>{}</td></tr>\n", result.seconds, markup(result.reason));
  }

  const Report& report_;
  std::vector<SubjectSummary> subjects_;
  Totals totals_;
  std::vector<std::size_t> subject_of_;  ///< of each result: an index into subjects_
  std::vector<std::string> categories_;
  std::unordered_map<std::string, std::size_t> category_index_;
  std::string out_;
};

}  // namespace

std::string to_html(const Report& report) { return Page(report).render(); }

}  // namespace edgecase::conformance
