#include "conformance/runner/known_deviations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "conformance/models/llvmpipe_window.h"
#include "conformance/models/llvmpipe_wrap.h"
#include "conformance/models/softpipe_model.h"

namespace edgecase::conformance {
namespace {

using Json = nlohmann::json;

struct Model {
  std::string_view name;
  DeviationModel in_window;
  DeviationModel of_part;
  bool (*is_frequent)(const Setting& setting);
};

constexpr std::array kModels{
    Model{"softpipe", {.predict = predict_softpipe}, {.predict = predict_softpipe}, nullptr},
    Model{"llvmpipe",
          {predict_llvmpipe, llvmpipe_may_deviate, llvmpipe_any_may_deviate},
          {[](const Setting& setting, const Triangle& triangle, MutableMaskView mask) {
             predict_llvmpipe_wrap(setting, triangle, mask);
           },
           [](const Setting&, const Triangle& triangle) { return llvmpipe_may_wrap(triangle); },
           [](const Setting&, std::span<const Triangle> triangles) { return llvmpipe_any_may_wrap(triangles); }},
          llvmpipe_passes_scissor}};

tl::unexpected<Error> bad(const std::filesystem::path& file, std::string_view what) {
  return tl::unexpected(Error{ErrorKind::bad_input, fmt::format("{}: {}", file.string(), what)});
}

std::optional<std::string> text(const Json& entry, const char* field) {
  const auto found = entry.find(field);
  if (found == entry.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

}  // namespace

tl::expected<std::vector<KnownDeviation>, Error> load_known_deviations(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) return bad(file, std::strerror(errno));
  const Json list = Json::parse(in, nullptr, /*allow_exceptions=*/false, /*ignore_comments=*/true);
  if (!list.is_array()) return bad(file, "not a JSON array");

  std::vector<KnownDeviation> result;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].is_object()) return bad(file, fmt::format("[{}]: not an object", i));
    for (const auto& [field, value] : list[i].items()) {
      if (field != "subject" && field != "device" && field != "model" && field != "cause") {
        return bad(file, fmt::format("[{}].{}: unknown field", i, field));
      }
    }
    const auto subject = text(list[i], "subject");
    const auto model_name = text(list[i], "model");
    const auto cause = text(list[i], "cause");
    if (!subject || !model_name || !cause) {
      return bad(file, fmt::format("[{}]: needs the texts subject, model and cause", i));
    }
    const auto model =
        std::find_if(kModels.begin(), kModels.end(), [&](const Model& m) { return m.name == *model_name; });
    if (model == kModels.end()) return bad(file, fmt::format("[{}].model: \"{}\" is no model", i, *model_name));
    const auto device = text(list[i], "device");
    if (list[i].contains("device") && (!device || device->empty())) {
      return bad(file, fmt::format("[{}].device: not a part of a device's name", i));
    }
    if (std::ranges::find(result, *subject, &KnownDeviation::subject) != result.end()) {
      return bad(file, fmt::format("[{}].subject: \"{}\" is there twice", i, *subject));
    }
    result.push_back(
        {*subject, device.value_or(std::string()), *cause, model->in_window, model->of_part, model->is_frequent});
  }
  return result;
}

const KnownDeviation* find_known_deviation(const std::vector<KnownDeviation>& all, std::string_view subject,
                                           std::string_view device) {
  const bool by_device = subject.starts_with("vulkan:");
  const auto found = std::ranges::find_if(all, [&](const KnownDeviation& known) {
    return known.subject == subject ||
           (by_device && !known.device.empty() && device.find(known.device) != std::string_view::npos);
  });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace edgecase::conformance
