#include "conformance/subjects/driver_subject.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>

#include "conformance/subjects/worker_subject.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kVulkanPrefix = "vulkan:";
constexpr std::string_view kOsmesaPrefix = "osmesa-";
constexpr const char* kSwiftshader = "swiftshader";
// Where Debian's chromium package puts it; Vulkan's loader does not look there.
constexpr const char* kSwiftshaderIcd = "/usr/lib/chromium/vk_swiftshader_icd.json";
// Where Vulkan's loader looks for ICD files of Debian packages and of the system's owner.
constexpr const char* kIcdFolders[] = {"/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"};

std::string worker_program() {
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path() / "edgecase-worker";
  return fs::exists(beside, ignored) ? beside.string() : EDGECASE_WORKER_PATH;
}

tl::expected<std::string, Error> icd_file(const std::string& named) {
  std::error_code ignored;
  if (named.find('/') != std::string::npos) {
    if (fs::exists(named, ignored)) return fs::absolute(named).string();
    return tl::unexpected(Error{ErrorKind::absent, fmt::format("no ICD file {}", named)});
  }
  std::string looked;
  for (const char* folder : kIcdFolders) {
    if (const fs::path file = fs::path(folder) / named; fs::exists(file, ignored)) return file.string();
    looked += fmt::format("{}{}", looked.empty() ? "" : ", ", folder);
  }
  return tl::unexpected(Error{ErrorKind::absent, fmt::format("no ICD file {} in {}", named, looked)});
}

}  // namespace

tl::expected<std::unique_ptr<Subject>, Error> make_driver_subject(const std::string& name) {
  WorkerCommand command;
  command.program = worker_program();
  command.arguments = {name};
  if (name.starts_with(kOsmesaPrefix)) {
    command.environment = {"GALLIUM_DRIVER=" + name.substr(kOsmesaPrefix.size())};
  }
  const bool by_icd = name.starts_with(kVulkanPrefix) && name.ends_with(".json");
  if (by_icd || name == kSwiftshader) {
    const auto file = icd_file(by_icd ? name.substr(kVulkanPrefix.size()) : kSwiftshaderIcd);
    if (!file) {
      return tl::unexpected(
          Error{file.error().kind, fmt::format("{}: {}{}", name, file.error().message,
                                               by_icd ? "" : "; the Debian package chromium brings it")});
    }
    // Loaders before 1.3.207 know only the second name.
    command.environment = {"VK_DRIVER_FILES=" + *file, "VK_ICD_FILENAMES=" + *file};
  }
  return WorkerSubject::start(name, std::move(command));
}

}  // namespace edgecase::conformance
