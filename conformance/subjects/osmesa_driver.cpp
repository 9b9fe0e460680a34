#include "conformance/subjects/osmesa_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>
#include <utility>

#include "conformance/scene/mask.h"
#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/enclosing_viewport.h"
#include "conformance/subjects/osmesa_context.h"
#include "shaders/coverage_frag_glsl.h"
#include "shaders/coverage_vert_glsl.h"

namespace edgecase::conformance {
namespace {

constexpr const char* kNeededExtensions[] = {"GL_ARB_clear_buffer_object",          "GL_ARB_framebuffer_no_attachments",
                                             "GL_ARB_separate_shader_objects",      "GL_ARB_gpu_shader5",
                                             "GL_ARB_shader_storage_buffer_object", "GL_ARB_shading_language_420pack"};

tl::unexpected<Error> failure(std::string message) {
  return tl::unexpected(Error{ErrorKind::subject, std::move(message)});
}

// As the inputs of coverage.vert.
struct Vertex {
  ClipPosition position;
  GLuint triangle = 0;
};

class OsmesaDriver final : public Driver {
 public:
  explicit OsmesaDriver(std::unique_ptr<OsmesaContext> context) : context_(std::move(context)), gl_(context_->gl()) {}

  tl::expected<void, Error> set_up(bool snaps);

  const SubjectInfo& info() const override { return info_; }
  std::size_t max_mask_bytes() const override { return max_mask_bytes_; }
  tl::expected<double, Error> draw(const Setting& setting, const Primitives& primitives,
                                   std::span<std::uint32_t> masks) override;

 private:
  // A linked program, and what its uniforms are set to.
  struct Program {
    GLuint name = 0;
    std::optional<MaskLayout> layout;
  };

  tl::expected<GLuint, Error> compile(GLenum stage, const char* source, bool primitive_id) const;
  tl::expected<void, Error> make_program(bool primitive_id, Program& program) const;
  void make_buffers();
  void describe(bool snaps);
  tl::expected<void, Error> use(const MaskLayout& layout, Program& program);
  void set_state(const Setting& setting, const Viewport& viewport) const;
  void upload(const Primitives& primitives, std::size_t mask_bytes);
  void submit(const Primitives& primitives) const;
  bool shape_framebuffer(Extent target, int samples) const;
  bool has_standard_locations(int samples) const;

  std::unique_ptr<OsmesaContext> context_;
  const GlFunctions& gl_;
  SubjectInfo info_;
  std::size_t max_mask_bytes_ = 0;
  EnclosingViewport viewport_{1};
  Program by_vertex_;     // numbers triangles by an attribute
  Program by_primitive_;  // numbers them by gl_PrimitiveID
  GLuint framebuffer_ = 0;
  std::size_t vertex_capacity_ = 0;
  std::size_t index_capacity_ = 0;
  std::size_t mask_capacity_ = 0;
  std::optional<MaskLayout> current_;  // what the framebuffer is set to
  std::vector<Vertex> vertices_;
};

tl::expected<void, Error> OsmesaDriver::set_up(bool snaps) {
  for (const char* extension : kNeededExtensions) {
    if (!context_->has_extension(extension)) {
      return tl::unexpected(Error{ErrorKind::absent, fmt::format("OSMesa's driver has no {}", extension)});
    }
  }
  describe(snaps);
  make_buffers();
  for (const int count : {2, 4, 8, 16}) {
    if (has_standard_locations(count)) info_.sample_counts.push_back(count);
  }
  if (auto made = make_program(false, by_vertex_); !made) return made;
  if (info_.assembly) {
    if (auto made = make_program(true, by_primitive_); !made) return made;
  }
  if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) {
    return failure(fmt::format("OpenGL cannot be set up: error 0x{:x}", error));
  }
  return {};
}

void OsmesaDriver::describe(bool snaps) {
  info_.device = fmt::format("{}, OpenGL {}", context_->text(GL_RENDERER), context_->text(GL_VERSION));
  // softpipe rasterizes unsnapped floats; the 4 it reports is only the least that OpenGL allows. A snap to 8 bits
  // leaves vertices on the 1/256 grid, the usual ones, as they are, and so describes what it is given.
  if (snaps) info_.rules.subpixel_bits = context_->integer(GL_SUBPIXEL_BITS);
  info_.max_target = std::min(
      {context_->integer(GL_MAX_FRAMEBUFFER_WIDTH), context_->integer(GL_MAX_FRAMEBUFFER_HEIGHT), kMaxTargetExtent});
  GLint extent[2] = {0, 0};
  gl_.GetIntegerv(GL_MAX_VIEWPORT_DIMS, extent);
  viewport_ = EnclosingViewport::within(static_cast<unsigned>(std::min(extent[0], extent[1])));
  info_.max_coordinate = static_cast<double>(viewport_.half());
  // Nothing of this is asked of softpipe: its model tells what it covers without any of them.
  GLfloat bounds[2] = {0, 0};
  gl_.GetFloatv(GL_VIEWPORT_BOUNDS_RANGE, bounds);
  info_.scissor = info_.cull = info_.assembly = snaps;
  info_.clip = snaps && context_->has_extension("GL_ARB_viewport_array");
  info_.max_viewport = static_cast<float>(std::min(extent[0], extent[1]));
  info_.viewport_bound = std::min(-bounds[0], bounds[1]);
  max_mask_bytes_ = static_cast<std::size_t>(context_->integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE));
}

tl::expected<GLuint, Error> OsmesaDriver::compile(GLenum stage, const char* source, bool primitive_id) const {
  std::string head = "#version 330\n";
  for (const char* extension : kNeededExtensions) {
    // Not every needed extension is one of the shading language.
    if (std::string_view(extension) != "GL_ARB_clear_buffer_object" &&
        std::string_view(extension) != "GL_ARB_framebuffer_no_attachments") {
      head += fmt::format("#extension {} : require\n", extension);
    }
  }
  if (info_.sample_counts == std::vector{1}) head += "#define NO_SAMPLE_MASK\n";
  if (primitive_id) head += "#define PRIMITIVE_ID\n";
  const char* parts[] = {head.c_str(), source};
  const GLuint shader = gl_.CreateShader(stage);
  gl_.ShaderSource(shader, 2, parts, nullptr);
  gl_.CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl_.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  char log[500] = "";
  gl_.GetShaderInfoLog(shader, sizeof log, nullptr, log);
  return failure(fmt::format("OpenGL does not compile the coverage shader: {}", log));
}

tl::expected<void, Error> OsmesaDriver::make_program(bool primitive_id, Program& program) const {
  const auto vertex = compile(GL_VERTEX_SHADER, coverage_vert_glsl, primitive_id);
  if (!vertex) return tl::unexpected(vertex.error());
  const auto fragment = compile(GL_FRAGMENT_SHADER, coverage_frag_glsl, primitive_id);
  if (!fragment) return tl::unexpected(fragment.error());
  program.name = gl_.CreateProgram();
  gl_.AttachShader(program.name, *vertex);
  gl_.AttachShader(program.name, *fragment);
  gl_.LinkProgram(program.name);
  GLint linked = GL_FALSE;
  gl_.GetProgramiv(program.name, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return {};
  char log[500] = "";
  gl_.GetProgramInfoLog(program.name, sizeof log, nullptr, log);
  return failure(fmt::format("OpenGL does not link the coverage shaders: {}", log));
}

// One vertex, one index and one storage buffer and one framebuffer, bound for good.
void OsmesaDriver::make_buffers() {
  GLuint vertex_array = 0;
  GLuint buffers[3] = {0, 0, 0};
  gl_.GenVertexArrays(1, &vertex_array);
  gl_.BindVertexArray(vertex_array);
  gl_.GenBuffers(3, buffers);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl_.EnableVertexAttribArray(0);
  gl_.VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  gl_.EnableVertexAttribArray(1);
  gl_.VertexAttribIPointer(1, 1, GL_UNSIGNED_INT, sizeof(Vertex),
                           reinterpret_cast<const void*>(offsetof(Vertex, triangle)));
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[1]);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
  gl_.PrimitiveRestartIndex(kRestartIndex);
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
}

// Sets the framebuffer's default parameters; its completeness says whether the driver can.
bool OsmesaDriver::shape_framebuffer(Extent target, int samples) const {
  gl_.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, target.width);
  gl_.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, target.height);
  gl_.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_SAMPLES, samples == 1 ? 0 : samples);
  gl_.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_FIXED_SAMPLE_LOCATIONS, GL_TRUE);
  return gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

// Drivers may round the sample count up and place samples as they like: both are asked for, of a framebuffer with an
// attachment, because Mesa does not answer for one without.
bool OsmesaDriver::has_standard_locations(int samples) const {
  if (samples > context_->integer(GL_MAX_FRAMEBUFFER_SAMPLES)) return false;
  GLuint framebuffer = 0;
  GLuint renderbuffer = 0;
  gl_.GenFramebuffers(1, &framebuffer);
  gl_.GenRenderbuffers(1, &renderbuffer);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, 16, 16);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
  bool standard = context_->integer(GL_SAMPLES) == samples;
  GLuint index = 0;
  for (const SampleLocation wanted : standard_sample_locations(samples)) {
    GLfloat location[2] = {-1, -1};
    if (standard) gl_.GetMultisamplefv(GL_SAMPLE_POSITION, index++, location);
    standard = standard && location[0] * 16 == static_cast<float>(wanted.x) &&
               location[1] * 16 == static_cast<float>(wanted.y);
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.DeleteRenderbuffers(1, &renderbuffer);
  gl_.DeleteFramebuffers(1, &framebuffer);
  return standard;
}

tl::expected<void, Error> OsmesaDriver::use(const MaskLayout& layout, Program& program) {
  gl_.UseProgram(program.name);
  if (current_ != layout) {
    current_.reset();
    if (!shape_framebuffer(layout.target, layout.samples)) {
      return failure(fmt::format("OpenGL has no framebuffer of {}x{} pixels and {} samples", layout.target.width,
                                 layout.target.height, layout.samples));
    }
    current_ = layout;
  }
  if (program.layout == layout) return {};
  const auto set = [&](const char* name, std::size_t value) {
    gl_.Uniform1ui(gl_.GetUniformLocation(program.name, name), static_cast<GLuint>(value));
  };
  set("samples", static_cast<std::size_t>(layout.samples));
  set("row_words", layout.driver_row_words());
  set("rows", static_cast<std::size_t>(layout.target.height));
  set("columns", static_cast<std::size_t>(layout.target.width));
  program.layout = layout;
  return {};
}

// OpenGL's y is up and ours is down: row y is row y nevertheless, so that everything is seen in a mirror, and what is
// clockwise to us is counter-clockwise to OpenGL.
void OsmesaDriver::set_state(const Setting& setting, const Viewport& viewport) const {
  const auto enable = [this](GLenum what, bool on) { on ? gl_.Enable(what) : gl_.Disable(what); };
  if (info_.clip) {
    gl_.ViewportIndexedf(0, viewport.x, viewport.y, viewport.width, viewport.height);
  } else {
    // Nothing but the enclosing viewport comes here, which is whole.
    gl_.Viewport(static_cast<GLint>(viewport.x), static_cast<GLint>(viewport.y), static_cast<GLsizei>(viewport.width),
                 static_cast<GLsizei>(viewport.height));
  }
  const Rect drawn = drawn_rectangle(setting);
  enable(GL_SCISSOR_TEST, setting.scissor.has_value());
  gl_.Scissor(drawn.x, drawn.y, drawn.width, drawn.height);
  enable(GL_CULL_FACE, setting.cull != CullMode::none);
  gl_.CullFace(setting.cull == CullMode::front ? GL_FRONT : GL_BACK);
  gl_.FrontFace(setting.front_face == FrontFace::clockwise ? GL_CCW : GL_CW);
}

void OsmesaDriver::upload(const Primitives& primitives, std::size_t mask_bytes) {
  vertices_.clear();
  for (std::size_t i = 0; i < primitives.vertices(); ++i) {
    vertices_.push_back({primitives.vertex(i), static_cast<GLuint>(i / 3)});
  }
  const auto put = [this](GLenum buffer, const void* data, std::size_t bytes, std::size_t& capacity) {
    if (capacity < bytes) {
      capacity = std::bit_ceil(bytes);
      gl_.BufferData(buffer, static_cast<GLsizeiptr>(capacity), nullptr, GL_STREAM_DRAW);
    }
    gl_.BufferSubData(buffer, 0, static_cast<GLsizeiptr>(bytes), data);
  };
  put(GL_ARRAY_BUFFER, vertices_.data(), vertices_.size() * sizeof(Vertex), vertex_capacity_);
  put(GL_ELEMENT_ARRAY_BUFFER, primitives.indices.data(), primitives.indices.size_bytes(), index_capacity_);
  if (mask_capacity_ < mask_bytes) {
    mask_capacity_ = std::min(std::bit_ceil(mask_bytes), max_mask_bytes_);
    gl_.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(mask_capacity_), nullptr, GL_DYNAMIC_READ);
  }
}

void OsmesaDriver::submit(const Primitives& primitives) const {
  const GLenum mode = primitives.topology == Topology::list    ? GL_TRIANGLES
                      : primitives.topology == Topology::strip ? GL_TRIANGLE_STRIP
                                                               : GL_TRIANGLE_FAN;
  if (primitives.indices.empty()) {
    gl_.DrawArrays(mode, 0, static_cast<GLsizei>(primitives.vertices()));
    return;
  }
  gl_.Enable(GL_PRIMITIVE_RESTART);
  gl_.DrawElements(mode, static_cast<GLsizei>(primitives.indices.size()), GL_UNSIGNED_INT, nullptr);
  gl_.Disable(GL_PRIMITIVE_RESTART);
}

tl::expected<double, Error> OsmesaDriver::draw(const Setting& setting, const Primitives& primitives,
                                               std::span<std::uint32_t> masks) {
  if (primitives.triangles == 0) return 0;
  Program& program = primitives.plain_list() ? by_vertex_ : by_primitive_;
  if (auto used = use(MaskLayout(setting), program); !used) return tl::unexpected(used.error());
  set_state(setting, primitives.viewport);
  upload(primitives, masks.size_bytes());
  const auto mask_bytes = static_cast<GLsizeiptr>(masks.size_bytes());
  gl_.Finish();
  const auto start = std::chrono::steady_clock::now();
  gl_.ClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, mask_bytes, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  submit(primitives);
  gl_.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gl_.Finish();
  const auto end = std::chrono::steady_clock::now();
  gl_.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, mask_bytes, masks.data());
  if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) {
    return failure(fmt::format("OpenGL refused a draw: error 0x{:x}", error));
  }
  return std::chrono::duration<double>(end - start).count();
}

}  // namespace

tl::expected<std::unique_ptr<Driver>, Error> open_osmesa_driver(const std::string& gallium) {
  auto context = OsmesaContext::create();
  if (!context) return tl::unexpected(context.error());
  if (const std::string running = (*context)->text(GL_RENDERER); !running.starts_with(gallium)) {
    return tl::unexpected(
        Error{ErrorKind::absent, fmt::format("OSMesa runs {} where GALLIUM_DRIVER asks for {}", running, gallium)});
  }
  auto driver = std::make_unique<OsmesaDriver>(std::move(*context));
  if (auto ready = driver->set_up(gallium != "softpipe"); !ready) return tl::unexpected(ready.error());
  return driver;
}

}  // namespace edgecase::conformance
