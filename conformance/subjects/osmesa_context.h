// An OSMesa context with an OpenGL core profile, loaded at run time so that nothing links OSMesa.
#pragma once

#define GL_GLEXT_PROTOTYPES  // declares the functions whose types GlFunctions takes; none is linked
#include <GL/osmesa.h>

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"

namespace edgecase::conformance {

/// The OpenGL entry points in use, each under its name without the `gl`. A context that lacks one is refused.
// clang-format off
#define EDGECASE_GL_FUNCTIONS(X)                                                                                      \
  X(AttachShader) X(BindBuffer) X(BindBufferBase) X(BindFramebuffer) X(BindRenderbuffer) X(BindVertexArray)           \
  X(BufferData) X(BufferSubData) X(CheckFramebufferStatus) X(ClearBufferSubData) X(CompileShader)                     \
  X(CreateProgram) X(CreateShader) X(CullFace) X(DeleteFramebuffers) X(DeleteRenderbuffers) X(Disable)                \
  X(DrawArrays) X(DrawElements) X(Enable) X(EnableVertexAttribArray) X(Finish) X(FramebufferParameteri)               \
  X(FramebufferRenderbuffer) X(FrontFace) X(GenBuffers) X(GenFramebuffers) X(GenRenderbuffers)                        \
  X(GenVertexArrays) X(GetBufferSubData) X(GetError) X(GetFloatv) X(GetIntegerv) X(GetMultisamplefv)                  \
  X(GetProgramInfoLog) X(GetProgramiv) X(GetShaderInfoLog) X(GetShaderiv) X(GetString) X(GetStringi)                  \
  X(GetUniformLocation) X(LinkProgram) X(MemoryBarrier) X(PrimitiveRestartIndex)                                      \
  X(RenderbufferStorageMultisample) X(Scissor) X(ShaderSource) X(Uniform1ui) X(UseProgram)                            \
  X(VertexAttribIPointer) X(VertexAttribPointer) X(Viewport) X(ViewportIndexedf)
// clang-format on

struct GlFunctions {
#define EDGECASE_GL_DECLARE(name) decltype(&::gl##name) name = nullptr;
  EDGECASE_GL_FUNCTIONS(EDGECASE_GL_DECLARE)
#undef EDGECASE_GL_DECLARE
};

/// The context stays current for the thread that made it. Which gallium driver runs is read from the environment
/// variable GALLIUM_DRIVER, once per process.
class OsmesaContext {
 public:
  /// ErrorKind::absent if libOSMesa is not installed, or has no context with the needed extensions.
  static tl::expected<std::unique_ptr<OsmesaContext>, Error> create();
  ~OsmesaContext();
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  const GlFunctions& gl() const { return gl_; }
  int integer(GLenum name) const;
  std::string text(GLenum name) const;
  bool has_extension(const std::string& name) const;

 private:
  OsmesaContext() = default;

  void* library_ = nullptr;
  OSMesaContext context_ = nullptr;
  /// OSMesa wants a window-system buffer, which nothing is drawn to.
  std::vector<GLubyte> window_;
  GlFunctions gl_;
};

}  // namespace edgecase::conformance
