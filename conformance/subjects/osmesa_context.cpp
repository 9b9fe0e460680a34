#include "conformance/subjects/osmesa_context.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <utility>

namespace edgecase::conformance {
namespace {

constexpr const char* kLibrary = "libOSMesa.so.8";
constexpr int kWindowSize = 16;

tl::unexpected<Error> absent(std::string message) {
  return tl::unexpected(Error{ErrorKind::absent, std::move(message)});
}

template <typename Function>
bool load(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace

tl::expected<std::unique_ptr<OsmesaContext>, Error> OsmesaContext::create() {
  std::unique_ptr<OsmesaContext> result(new OsmesaContext);
  result->library_ = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (result->library_ == nullptr) {
    return absent(fmt::format("no {}; the Debian package libosmesa6 brings it", kLibrary));
  }
  decltype(&OSMesaCreateContextAttribs) create_context = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetProcAddress) get_address = nullptr;
  if (!load(result->library_, "OSMesaCreateContextAttribs", create_context) ||
      !load(result->library_, "OSMesaMakeCurrent", make_current) ||
      !load(result->library_, "OSMesaGetProcAddress", get_address)) {
    return absent(fmt::format("{} is too old: it has no OSMesaCreateContextAttribs", kLibrary));
  }
  // llvmpipe has 4.5; softpipe stops at 3.3, and has what is needed as extensions.
  for (const auto& [major, minor] : {std::pair{4, 5}, std::pair{3, 3}}) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              major,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              minor,
                              0};
    result->context_ = create_context(attributes, nullptr);
    if (result->context_ != nullptr) break;
  }
  if (result->context_ == nullptr) return absent(fmt::format("{} has no OpenGL 3.3 core profile", kLibrary));
  result->window_.resize(std::size_t{4} * kWindowSize * kWindowSize);
  if (make_current(result->context_, result->window_.data(), GL_UNSIGNED_BYTE, kWindowSize, kWindowSize) == GL_FALSE) {
    return tl::unexpected(Error{ErrorKind::subject, "OSMesa cannot make its context current"});
  }
  const char* missing = nullptr;
#define EDGECASE_GL_LOAD(name)                                                              \
  result->gl_.name = reinterpret_cast<decltype(result->gl_.name)>(get_address("gl" #name)); \
  if (result->gl_.name == nullptr) missing = "gl" #name;
  EDGECASE_GL_FUNCTIONS(EDGECASE_GL_LOAD)
#undef EDGECASE_GL_LOAD
  if (missing != nullptr) return absent(fmt::format("{} has no {}", kLibrary, missing));
  return result;
}

OsmesaContext::~OsmesaContext() {
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  if (context_ != nullptr && load(library_, "OSMesaDestroyContext", destroy)) destroy(context_);
}

int OsmesaContext::integer(GLenum name) const {
  GLint value = 0;
  gl_.GetIntegerv(name, &value);
  return value;
}

std::string OsmesaContext::text(GLenum name) const {
  const GLubyte* value = gl_.GetString(name);
  return value == nullptr ? "" : reinterpret_cast<const char*>(value);
}

bool OsmesaContext::has_extension(const std::string& name) const {
  const int count = integer(GL_NUM_EXTENSIONS);
  for (int i = 0; i < count; ++i) {
    if (name == reinterpret_cast<const char*>(gl_.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)))) return true;
  }
  return false;
}

}  // namespace edgecase::conformance
