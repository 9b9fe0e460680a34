#include "conformance/runner/exhaust_state.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace edgecase::conformance {
namespace {

using Json = nlohmann::ordered_json;

// What has to be the same for two runs to add up.
Json identity(const ExhaustPlan& plan, std::string_view device) {
  return {{"edgecase", EDGECASE_VERSION},
          {"lattice_bits", plan.lattice_bits},
          {"target", {plan.target.width, plan.target.height}},
          {"subject", plan.subject},
          {"device", device}};
}

Json to_json(const std::optional<Exhaustion::Wrong>& first) {
  if (!first) return nullptr;
  return {{"triangle", first->triangle}, {"x", first->x}, {"y", first->y}, {"missing", first->missing}};
}

std::string text(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

// Reads fields of one object; remembers the first that is wrong.
class Reader {
 public:
  explicit Reader(const Json& object) : object_(object) {}

  std::uint64_t number(const char* field, std::uint64_t most) {
    const Json* value = find(field);
    if (value == nullptr) return 0;
    if (!value->is_number_unsigned() || value->get<std::uint64_t>() > most) {
      complain(fmt::format("{} = {}, where a whole number from 0 to {} has to be", field, text(*value), most));
      return 0;
    }
    return value->get<std::uint64_t>();
  }
  double seconds(const char* field) {
    const Json* value = find(field);
    if (value == nullptr) return 0;
    if (!value->is_number() || !(value->get<double>() >= 0)) {
      complain(fmt::format("{} = {}, where a time has to be", field, text(*value)));
      return 0;
    }
    return value->get<double>();
  }
  bool truth(const char* field) {
    const Json* value = find(field);
    if (value != nullptr && !value->is_boolean()) {
      complain(fmt::format("{} = {}, where true or false has to be", field, text(*value)));
    }
    return value != nullptr && value->is_boolean() && value->get<bool>();
  }
  const Json* find(const char* field) {
    const auto found = object_.find(field);
    if (found != object_.end()) return &*found;
    complain(fmt::format("there is no field {}", field));
    return nullptr;
  }
  void complain(const std::string& what) {
    if (complaint_.empty()) complaint_ = what;
  }
  const std::string& complaint() const { return complaint_; }

 private:
  const Json& object_;
  std::string complaint_;
};

}  // namespace

std::string exhaust_state(const ExhaustPlan& plan, std::string_view device, const Exhaustion& done) {
  Json json = identity(plan, device);
  json["triangles"] = done.triangles;
  json["wrong"] = done.wrong;
  json["missing"] = done.missing;
  json["unexplained"] = done.unexplained;
  json["first"] = to_json(done.first);
  json["seconds"] = done.seconds;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

tl::expected<Exhaustion, Error> load_exhaust_state(const std::filesystem::path& file, const ExhaustPlan& plan,
                                                   std::string_view device) {
  const auto bad = [&](std::string_view what) {
    return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("--state {}: {}", file.string(), what)});
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error) && !error) return Exhaustion{};
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in || std::filesystem::is_directory(file, error)) return bad("cannot be read");
  const Json json = Json::parse(bytes, nullptr, false);
  if (!json.is_object()) return bad("is no state of an exhaustion");

  Reader reader(json);
  const Json wanted = identity(plan, device);
  for (const auto& [field, value] : wanted.items()) {
    const Json* found = reader.find(field.c_str());
    if (found != nullptr && *found != value) {
      reader.complain(fmt::format("{} is {}, this run's is {}", field, text(*found), text(value)));
    }
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(plan.target.width) * static_cast<std::uint64_t>(plan.target.height);
  Exhaustion done;
  done.triangles = reader.number("triangles", exhaust_triangles(plan));
  done.samples_compared = done.triangles * pixels;
  done.wrong = reader.number("wrong", done.samples_compared);
  done.missing = reader.number("missing", done.wrong);
  done.unexplained = reader.number("unexplained", done.triangles);
  done.seconds = reader.seconds("seconds");
  const Json* first = reader.find("first");
  if (first != nullptr && first->is_object() == (done.wrong == 0)) {
    reader.complain(fmt::format("first = {}, with {} wrong samples", text(*first), done.wrong));
  }
  if (!reader.complaint().empty()) return bad(reader.complaint());
  if (done.wrong != 0) {
    Reader wrong(*first);
    done.first = {wrong.number("triangle", done.triangles - 1),
                  static_cast<int>(wrong.number("x", static_cast<std::uint64_t>(plan.target.width) - 1)),
                  static_cast<int>(wrong.number("y", static_cast<std::uint64_t>(plan.target.height) - 1)),
                  wrong.truth("missing")};
    if (!wrong.complaint().empty()) return bad("first: " + wrong.complaint());
  }
  return done;
}

}  // namespace edgecase::conformance
