// The program edgecase-worker: one driver, named by the only argument, served to the program that started it. It alone
// loads Vulkan and OSMesa.
#include <sys/socket.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "conformance/subjects/osmesa_driver.h"
#include "conformance/subjects/vulkan_driver.h"
#include "conformance/subjects/worker_protocol.h"
#include "conformance/subjects/worker_server.h"

namespace edgecase::conformance {
namespace {

bool is_on(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && std::string_view(value) == "1";
}

tl::expected<std::unique_ptr<Driver>, Error> open_driver(std::string_view subject) {
  constexpr std::string_view kVulkan = "vulkan:";
  constexpr std::string_view kOsmesa = "osmesa-";
  if (subject.starts_with(kOsmesa)) return open_osmesa_driver(std::string(subject.substr(kOsmesa.size())));
  // lavapipe's device and driver both call themselves llvmpipe. Of an ICD file, which VK_DRIVER_FILES names by now, the
  // first device is taken.
  VulkanSelection selection{"llvmpipe", is_on("EDGECASE_VALIDATION"), is_on("EDGECASE_COPY_MASKS")};
  selection.colour_target = subject == "lavapipe:bgra8";
  if (subject == "swiftshader") selection.name = "SwiftShader";
  if (subject.starts_with(kVulkan)) {
    selection.name = subject.ends_with(".json") ? "" : subject.substr(kVulkan.size());
  }
  auto driver = open_vulkan_driver(selection);
  if (!driver && driver.error().kind == ErrorKind::absent && subject.starts_with("lavapipe")) {
    return tl::unexpected(
        Error{ErrorKind::absent, driver.error().message + "; the Debian package mesa-vulkan-drivers brings lavapipe"});
  }
  return driver;
}

}  // namespace
}  // namespace edgecase::conformance

int main(int argc, char** argv) {
  using namespace edgecase::conformance;
  int type = 0;
  socklen_t size = sizeof type;
  if (argc != 2 || getsockopt(kWorkerSocket, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET) {
    std::fputs("edgecase-worker is started by edgecase, not by hand\n", stderr);
    return 2;
  }
  serve_driver([subject = std::string_view(argv[1])] { return open_driver(subject); });
}
