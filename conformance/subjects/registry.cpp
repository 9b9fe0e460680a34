#include "conformance/subjects/registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "conformance/scene/nearest_name.h"
#include "conformance/subjects/driver_subject.h"
#include "conformance/subjects/edgecase_subject.h"
#include "conformance/subjects/family_subject.h"
#include "conformance/subjects/fault_subject.h"
#include "conformance/subjects/inexact_subject.h"

namespace edgecase::conformance {
namespace {

constexpr std::string_view kEdgecase = "edgecase";
constexpr std::string_view kEdgecaseFamily = "edgecase:";
constexpr std::string_view kFaultFamily = "fault:";
constexpr std::string_view kInexactFamily = "inexact:";
constexpr std::string_view kVulkanFamily = "vulkan:";
constexpr std::string_view kDrivers[] = {"lavapipe", "lavapipe:bgra8", "osmesa-llvmpipe", "osmesa-softpipe",
                                         "swiftshader"};

tl::unexpected<Error> unknown(const std::string& name) {
  const std::vector<SubjectName> subjects = subject_names();
  std::vector<std::string_view> known;
  for (const SubjectName& subject : subjects) known.push_back(subject.name);
  const auto nearest = nearest_name(name, known);
  return tl::unexpected(
      Error{ErrorKind::bad_input, fmt::format("unknown subject \"{}\"; {}", name,
                                              nearest ? fmt::format("the nearest is \"{}\"", *nearest)
                                                      : "\"edgecase list subjects\" names those there are")});
}

tl::unexpected<Error> unavailable(const std::string& name, const InstructionSetVariant& set) {
  return tl::unexpected(
      Error{ErrorKind::absent, fmt::format("{}: this machine, or this build, has no {}", name, set.instructions)});
}

}  // namespace

std::vector<SubjectName> subject_names() {
  std::vector<SubjectName> names{
      {"edgecase", "our own rasterizer"},
      {"edgecase:scalar", "its incremental reference"},
      {"lavapipe", "Mesa's llvmpipe through Vulkan"},
      {"lavapipe:bgra8", "the same with a B8G8R8A8 colour target, for which it has other code paths"},
      {"osmesa-llvmpipe", "Mesa's llvmpipe through OpenGL"},
      {"osmesa-softpipe", "Mesa's older rasterizer through OpenGL; breaks the rules, in ways that are known"},
      {"swiftshader", "Google's software rasterizer through Vulkan; optional, from Debian's package chromium"},
      {"vulkan:DEVICE-OR-ICD", "a Vulkan driver, by part of its device's name or by its ICD file (.json)"}};
  for (const FamilySubjectName& member : family_subjects()) {
    if (member.name == "scalar") continue;  // is there already, for every number of subpixel bits
    names.push_back({fmt::format("{}{}", kEdgecaseFamily, member.name), std::string(member.about)});
  }
  for (const InstructionSetVariant& variant : instruction_set_variants()) {
    names.push_back({fmt::format("{}{}", kEdgecaseFamily, variant.name),
                     fmt::format("our own rasterizer in {}{}", variant.instructions,
                                 variant.available ? "" : ", which this machine does not have")});
  }
  for (const InexactInfo& inexact : inexact_subjects()) {
    names.push_back(
        {fmt::format("{}{}", kInexactFamily, inexact.name), fmt::format("not exact: {}", inexact.description)});
  }
  for (const FaultInfo& fault : faults()) {
    names.push_back(
        {fmt::format("{}{}", kFaultFamily, fault.name), fmt::format("wrong on purpose: {}", fault.description)});
  }
  return names;
}

tl::expected<std::unique_ptr<Subject>, Error> make_subject(const std::string& name) {
  const auto rest_of = [&name](std::string_view family) { return name.substr(std::min(family.size(), name.size())); };
  std::unique_ptr<Subject> subject;
  if (name == kEdgecase) {
    subject = make_edgecase_subject("");
  } else if (name.starts_with(kEdgecaseFamily) && name != kEdgecaseFamily) {
    const std::string variant = rest_of(kEdgecaseFamily);
    for (const InstructionSetVariant& set : instruction_set_variants()) {
      if (variant == set.name && !set.available) return unavailable(name, set);
    }
    subject = make_edgecase_subject(variant);
  } else if (name.starts_with(kFaultFamily)) {
    subject = make_fault_subject(rest_of(kFaultFamily));
  } else if (name.starts_with(kInexactFamily)) {
    subject = make_inexact_subject(rest_of(kInexactFamily));
  } else if (std::ranges::find(kDrivers, name) != std::end(kDrivers) ||
             (name.starts_with(kVulkanFamily) && name != kVulkanFamily)) {
    return make_driver_subject(name);
  }
  if (subject == nullptr) return unknown(name);
  return subject;
}

}  // namespace edgecase::conformance
