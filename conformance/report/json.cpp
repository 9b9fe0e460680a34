#include <nlohmann/json.hpp>

#include "conformance/report/report.h"
#include "conformance/report/summary.h"

namespace edgecase::conformance {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order that the design lists them in

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json to_value(const std::optional<FirstWrong>& first) {
  if (!first) return nullptr;
  return {{"kind", first->kind},
          {"triangle", first->triangle},
          {"x", first->x},
          {"y", first->y},
          {"sample", first->sample},
          {"text", first->text},
          {"vertices", first->vertices},
          {"command", text_or_null(first->command)}};
}

Json to_value(const Cracks& cracks) {
  Json value{{"meshes", cracks.meshes}, {"torn_meshes", cracks.torn_meshes}, {"samples_inside", cracks.samples_inside},
             {"holes", cracks.holes},   {"doubled", cracks.doubled},         {"first", nullptr}};
  if (const auto& first = cracks.first) {
    value["first"] = {{"kind", name_of(first->kind)},
                      {"triangle", first->triangle},
                      {"x", first->x},
                      {"y", first->y},
                      {"sample", first->sample}};
  }
  return value;
}

Json to_value(const Result& result) {
  return {{"subject", result.subject},
          {"device", text_or_null(result.device)},
          {"snap", text_or_null(result.snap)},
          {"case", result.testcase},
          {"category", text_or_null(result.category)},
          {"verdict", name_of(result.verdict)},
          {"triangles", result.triangles},
          {"samples_compared", result.samples_compared},
          {"missing", result.missing},
          {"unexpected", result.unexpected},
          {"doubled", result.doubled},
          {"meshes_checked", result.meshes_checked},
          {"known_triangles", result.known_triangles},
          {"unpredicted", result.unpredicted},
          {"may", result.may},
          {"cracks", to_value(result.cracks)},
          {"first", to_value(result.first)},
          {"reason", text_or_null(result.reason)},
          {"seconds", result.seconds},
          {"subject_seconds", result.subject_seconds}};
}

Json to_value(const Totals& totals) {
  return {{"pass", totals.pass},
          {"fail", totals.fail},
          {"known", totals.known},
          {"skip", totals.skip},
          {"triangles", totals.triangles},
          {"samples_compared", totals.samples_compared},
          {"missing", totals.missing},
          {"unexpected", totals.unexpected},
          {"doubled", totals.doubled},
          {"meshes_checked", totals.meshes_checked},
          {"known_triangles", totals.known_triangles},
          {"unpredicted", totals.unpredicted},
          {"may", totals.may},
          {"cracks", totals.cracks.holes + totals.cracks.doubled}};
}

Json categories_of(const Report& report) {
  Json categories = Json::array();
  for (const SubjectSummary& subject : by_subject(report)) {
    for (const CategorySummary& category : by_category(report, subject)) {
      Json entry{{"subject", subject.name}, {"category", text_or_null(category.category)}};
      entry.update(to_value(category.totals));
      entry["causes"] = Json::array();
      for (const Cause& cause : causes(report, category.results)) {
        entry["causes"].push_back(
            {{"verdict", name_of(cause.verdict)}, {"reason", cause.reason}, {"cases", cause.results.size()}});
      }
      categories.push_back(std::move(entry));
    }
  }
  return categories;
}

}  // namespace

std::string to_json(const Report& report) {
  Json results = Json::array();
  for (const Result& result : report.results) results.push_back(to_value(result));
  Json totals = to_value(totals_of(report));
  totals["seconds"] = report.seconds;
  const Json root = {{"edgecase", report.version},
                     {"seed", report.seed},
                     {"rules", report.rules},
                     {"results", std::move(results)},
                     {"categories", categories_of(report)},
                     {"totals", std::move(totals)}};
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace edgecase::conformance
