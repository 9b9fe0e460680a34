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
  Position ndc;
  GLuint triangle = 0;
};

class OsmesaDriver final : public Driver {
 public:
  explicit OsmesaDriver(std::unique_ptr<OsmesaContext> context) : context_(std::move(context)), gl_(context_->gl()) {}

  tl::expected<void, Error> set_up(bool snaps);

  const SubjectInfo& info() const override { return info_; }
  std::size_t max_mask_bytes() const override { return max_mask_bytes_; }
  tl::expected<double, Error> draw(const Setting& setting, std::span<const Triangle> triangles,
                                   std::span<std::uint64_t> masks) override;

 private:
  tl::expected<GLuint, Error> compile(GLenum stage, const char* source) const;
  tl::expected<void, Error> make_program();
  void make_buffers();
  void describe(bool snaps);
  tl::expected<void, Error> use(const MaskLayout& layout);
  bool shape_framebuffer(Extent target, int samples) const;
  bool has_standard_locations(int samples) const;

  std::unique_ptr<OsmesaContext> context_;
  const GlFunctions& gl_;
  SubjectInfo info_;
  std::size_t max_mask_bytes_ = 0;
  EnclosingViewport viewport_{1};
  GLuint program_ = 0;
  GLuint framebuffer_ = 0;
  std::size_t vertex_capacity_ = 0;
  std::size_t mask_capacity_ = 0;
  std::optional<MaskLayout> current_;  // what framebuffer and uniforms are set to
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
  if (auto made = make_program(); !made) return made;
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
  max_mask_bytes_ = static_cast<std::size_t>(context_->integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE));
}

tl::expected<GLuint, Error> OsmesaDriver::compile(GLenum stage, const char* source) const {
  std::string head = "#version 330\n";
  for (const char* extension : kNeededExtensions) {
    // Not every needed extension is one of the shading language.
    if (std::string_view(extension) != "GL_ARB_clear_buffer_object" &&
        std::string_view(extension) != "GL_ARB_framebuffer_no_attachments") {
      head += fmt::format("#extension {} : require\n", extension);
    }
  }
  if (info_.sample_counts == std::vector{1}) head += "#define NO_SAMPLE_MASK\n";
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

tl::expected<void, Error> OsmesaDriver::make_program() {
  const auto vertex = compile(GL_VERTEX_SHADER, coverage_vert_glsl);
  if (!vertex) return tl::unexpected(vertex.error());
  const auto fragment = compile(GL_FRAGMENT_SHADER, coverage_frag_glsl);
  if (!fragment) return tl::unexpected(fragment.error());
  program_ = gl_.CreateProgram();
  gl_.AttachShader(program_, *vertex);
  gl_.AttachShader(program_, *fragment);
  gl_.LinkProgram(program_);
  GLint linked = GL_FALSE;
  gl_.GetProgramiv(program_, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) {
    gl_.UseProgram(program_);
    return {};
  }
  char log[500] = "";
  gl_.GetProgramInfoLog(program_, sizeof log, nullptr, log);
  return failure(fmt::format("OpenGL does not link the coverage shaders: {}", log));
}

// One vertex buffer, one storage buffer and one framebuffer, bound for good.
void OsmesaDriver::make_buffers() {
  GLuint vertex_array = 0;
  GLuint buffers[2] = {0, 0};
  gl_.GenVertexArrays(1, &vertex_array);
  gl_.BindVertexArray(vertex_array);
  gl_.GenBuffers(2, buffers);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl_.EnableVertexAttribArray(0);
  gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  gl_.EnableVertexAttribArray(1);
  gl_.VertexAttribIPointer(1, 1, GL_UNSIGNED_INT, sizeof(Vertex),
                           reinterpret_cast<const void*>(offsetof(Vertex, triangle)));
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[1]);
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const int half = static_cast<int>(viewport_.half());
  gl_.Viewport(-half, -half, 2 * half, 2 * half);
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

tl::expected<void, Error> OsmesaDriver::use(const MaskLayout& layout) {
  if (current_ == layout) return {};
  current_.reset();
  if (!shape_framebuffer(layout.target, layout.samples)) {
    return failure(fmt::format("OpenGL has no framebuffer of {}x{} pixels and {} samples", layout.target.width,
                               layout.target.height, layout.samples));
  }
  const auto set = [this](const char* name, std::size_t value) {
    gl_.Uniform1ui(gl_.GetUniformLocation(program_, name), static_cast<GLuint>(value));
  };
  set("samples", static_cast<std::size_t>(layout.samples));
  set("row_words", layout.row_words() * 2);
  set("rows", static_cast<std::size_t>(layout.target.height));
  current_ = layout;
  return {};
}

tl::expected<double, Error> OsmesaDriver::draw(const Setting& setting, std::span<const Triangle> triangles,
                                               std::span<std::uint64_t> masks) {
  if (auto used = use(MaskLayout(setting)); !used) return tl::unexpected(used.error());
  vertices_.clear();
  for (GLuint t = 0; t < triangles.size(); ++t) {
    for (const Position& p : triangles[t]) vertices_.push_back({{viewport_.ndc(p.x), viewport_.ndc(p.y)}, t});
  }
  const std::size_t vertex_bytes = vertices_.size() * sizeof(Vertex);
  if (vertex_capacity_ < vertex_bytes) {
    vertex_capacity_ = std::bit_ceil(vertex_bytes);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex_capacity_), nullptr, GL_STREAM_DRAW);
  }
  if (mask_capacity_ < masks.size_bytes()) {
    mask_capacity_ = std::min(std::bit_ceil(masks.size_bytes()), max_mask_bytes_);
    gl_.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(mask_capacity_), nullptr, GL_DYNAMIC_READ);
  }
  const auto mask_bytes = static_cast<GLsizeiptr>(masks.size_bytes());
  gl_.BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(vertex_bytes), vertices_.data());
  gl_.Finish();
  const auto start = std::chrono::steady_clock::now();
  gl_.ClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, mask_bytes, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  gl_.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * triangles.size()));
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
