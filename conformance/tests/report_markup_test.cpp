#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <regex>
#include <sstream>

#include "conformance/report/report.h"
#include "conformance/tests/report_samples.h"

namespace edgecase::conformance {
namespace {

using boost::property_tree::ptree;
using testing::HasSubstr;
using testing::Not;

/// Every text of every result is hostile.
Report hostile() {
  Report report = one_of_each();
  report.version = kHostile;
  for (Result& result : report.results) {
    result.subject = result.device = result.testcase = result.category = result.reason = kHostile;
    result.shown.push_back(
        {std::string(kHostile), "a\"b.png", "javascript:a.svg", "c'd<.json", std::string(kHostile), true});
    if (!result.first) continue;
    result.first->kind = result.first->text = result.first->command = kHostile;
    result.first->vertices[0][0] = kHostile;
  }
  return report;
}

/// As boost hands them over: markup undone.
constexpr std::string_view kHostileShown =
    "<b a=\"1\" c='2'>&amp; ]]> \\x1b[31m \\x9b \\x00 \\x7f \n \\x0d \xef\xbf\xbd \xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd "
    "\xc3\xa9\xe2\x82\xac";

ptree parse_xml(const std::string& xml) {
  ptree root;
  std::istringstream in(xml);
  boost::property_tree::read_xml(in, root);
  return root;
}

void expect_no_control_characters(const std::string& text) {
  for (const char c : text) {
    EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << static_cast<int>(c);
    EXPECT_NE(c, '\x7f');
  }
}

std::size_t occurrences(const std::string& text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

TEST(JunitReport, HasASuitePerSubject) {
  Report report = one_of_each();
  report.results.push_back(skipped("softpipe", "cases/c.json", "samples"));
  const ptree suites = parse_xml(to_junit(report)).get_child("testsuites");
  EXPECT_EQ(suites.get<int>("<xmlattr>.tests"), 5);
  EXPECT_EQ(suites.get<int>("<xmlattr>.failures"), 1);
  EXPECT_EQ(suites.get<int>("<xmlattr>.skipped"), 2);
  EXPECT_EQ(suites.get<double>("<xmlattr>.time"), 1.5);
  ASSERT_EQ(suites.count("testsuite"), 2u);
  const ptree& lavapipe = suites.get_child("testsuite");
  EXPECT_EQ(lavapipe.get<std::string>("<xmlattr>.name"), "lavapipe");
  EXPECT_EQ(lavapipe.get<int>("<xmlattr>.tests"), 2);
  EXPECT_EQ(lavapipe.get<int>("<xmlattr>.failures"), 0);
  EXPECT_EQ(lavapipe.get<int>("<xmlattr>.skipped"), 1);
  EXPECT_EQ(lavapipe.get<double>("<xmlattr>.time"), 0.25);
  EXPECT_EQ(lavapipe.get_child("properties").count("property"), 4u);
  const ptree& pass = lavapipe.get_child("testcase");
  EXPECT_EQ(pass.get<std::string>("<xmlattr>.classname"), "lavapipe.edges");
  EXPECT_EQ(pass.get<std::string>("<xmlattr>.name"), "cases/a.json");
  EXPECT_EQ(pass.get<double>("<xmlattr>.time"), 0.25);
  EXPECT_EQ(pass.size(), 1u);  // its attributes alone
}

TEST(JunitReport, SaysWhatDidNotPass) {
  const std::string xml = to_junit(one_of_each());
  EXPECT_THAT(xml, HasSubstr("<failure message=\"3 samples of a left edge are missing\" type=\"missing\">"
                             "3 samples of a left edge are missing\n"
                             "3 missing, 1 unexpected among 1,024 samples of 4 triangles\n"
                             "first: missing at pixel (12, 7), sample 0, triangle 2: (0x1.8p+0, 0x0p+0) "
                             "(0x1.8p+0, 0x1.8p+1) (0x1p+2, 0x1.8p+1)\n"
                             "..#\n.!#\n"
                             "to see it again: edgecase run &#39;left edge.json&#39; --subject softpipe\n</failure>"));
  EXPECT_THAT(xml, HasSubstr("<system-out>known deviation: breaks ties to the right\n2 doubled among"));
  EXPECT_THAT(xml, HasSubstr("<skipped message=\"16 samples are not supported\"/>"));
}

TEST(JunitReport, IsWellFormedWhateverTheNamesAre) {
  const std::string xml = to_junit(hostile());
  expect_no_control_characters(xml);
  const ptree suite = parse_xml(xml).get_child("testsuites.testsuite");
  EXPECT_EQ(suite.get<std::string>("<xmlattr>.name"), kHostileShown);
  int failures = 0;
  for (const auto& [tag, child] : suite) {
    if (const auto failure = child.get_child_optional("failure")) {
      ++failures;
      EXPECT_EQ(failure->get<std::string>("<xmlattr>.message"), kHostileShown);
      EXPECT_THAT(failure->data(), HasSubstr(std::string(kHostileShown)));
    }
  }
  EXPECT_EQ(failures, 1);
}

TEST(HtmlReport, ShowsEveryResultOnceAndEachFindingWithItsPictures) {
  Report report = one_of_each();
  report.results[1].shown = {{"Pixel (12, 7)", "a b.png", "a b.svg", "a.json", "edgecase show a.json", false}};
  const std::string page = to_html(report);
  EXPECT_EQ(occurrences(page, "<tr data-subject="), 4u);
  EXPECT_EQ(occurrences(page, "<article id="), 2u);
  EXPECT_THAT(page, HasSubstr("<article id=\"r1\" data-subject=\"1\" data-category=\"0\" data-verdict=\"fail\" "
                              "data-name=\"cases/a.json\">"));
  EXPECT_THAT(page, HasSubstr("<td><a href=\"#r1\">cases/a.json</a></td><td class=\"verdict fail\">"));
  EXPECT_THAT(
      page, HasSubstr("<a href=\"./a%20b.svg\"><img src=\"./a%20b.png\" alt=\"Pixel (12, 7)\" loading=\"lazy\"></a>"));
  EXPECT_THAT(page, HasSubstr("<a href=\"./a.json\">a.json</a>"));
  EXPECT_THAT(page, HasSubstr("<code class=\"command\">edgecase show a.json</code>"));
  EXPECT_THAT(page, HasSubstr("<pre>..#\n.!#</pre>"));
  EXPECT_THAT(page,
              HasSubstr("<code class=\"command\">edgecase run &#39;left edge.json&#39; --subject softpipe</code>"));
  EXPECT_THAT(page, HasSubstr("<dt>cause</dt><dd>breaks ties to the right</dd>"));
  EXPECT_THAT(page, HasSubstr("<td>16 samples are not supported</td>"));
  EXPECT_THAT(page,
              HasSubstr("softpipe failed 1 of 2 cases: 3 missing, 1 unexpected among 2,048 samples of 8 triangles."));
}

TEST(HtmlReport, IsInertWhateverTheNamesAre) {
  const std::string page = to_html(hostile());
  EXPECT_THAT(page, Not(HasSubstr("<b a=")));
  EXPECT_THAT(page, HasSubstr("&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;amp;"));
  EXPECT_THAT(page, Not(HasSubstr("javascript:")));
  expect_no_control_characters(page);
  // Each tag's attributes are as the page wrote them: the same tags as with harmless names.
  const std::regex attribute("[a-z-]+=\"[^\"<>]*\"");
  const std::regex tag("<(/?[a-z0-9]+|!DOCTYPE)((?:[^<>\"]|\"[^\"]*\")*)>");
  const std::size_t script = page.find("<script>");
  std::size_t tags = 0;
  for (std::sregex_iterator it(page.begin(), page.begin() + static_cast<std::ptrdiff_t>(script), tag), end; it != end;
       ++it, ++tags) {
    const std::string rest = std::regex_replace((*it)[2].str(), attribute, "");
    EXPECT_EQ(rest.find_first_of("\"'=&"), std::string::npos) << it->str();
  }
  EXPECT_EQ(tags, occurrences(page.substr(0, script), "<"));
}

TEST(HtmlReport, LoadsNothingFromElsewhere) {
  Report report = one_of_each();
  report.results[1].shown = {{"caption", "a.png", "a.svg", "a.json", "edgecase show a.json", false}};
  const std::string page = to_html(report);
  std::size_t found = 0;
  for (const char* attribute : {" src=\"", " href=\""}) {
    for (std::size_t at = page.find(attribute); at != std::string::npos; at = page.find(attribute, at + 1), ++found) {
      const std::string target = page.substr(at + std::string_view(attribute).size(), 2);
      EXPECT_TRUE(target == "./" || target.front() == '#') << target;
    }
  }
  EXPECT_GT(found, 5u);
  for (const char* loads : {"http:", "https:", "url(", "@import", "fetch(", "<link"}) {
    EXPECT_THAT(page, Not(HasSubstr(loads)));
  }
}

TEST(HtmlReport, SplitsManyResultsIntoTables) {
  Report report;
  report.results.assign(400, passed("lavapipe", "case", "edges"));
  EXPECT_EQ(occurrences(to_html(report), "<div class=\"rows\">"), 2u);
  report.results.push_back(passed("lavapipe", "case", "edges"));
  const std::string page = to_html(report);
  EXPECT_EQ(occurrences(page, "<div class=\"rows\">"), 3u);
  EXPECT_EQ(occurrences(page, "<tr data-subject="), 401u);
  EXPECT_EQ(occurrences(page, "<div"), occurrences(page, "</div>"));
  EXPECT_EQ(occurrences(page, "<table"), occurrences(page, "</table>"));
  EXPECT_EQ(occurrences(page, "<tbody"), occurrences(page, "</tbody>"));
}

TEST(HtmlReport, OfNothing) { EXPECT_THAT(to_html(Report{}), HasSubstr("Nothing was compared.")); }

}  // namespace
}  // namespace edgecase::conformance
