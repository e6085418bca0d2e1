// The exported GLSL, run by OpenGL ES 3 without a window; names of all three languages.
#include "export/formats.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#include <cstring>

#include "export/networks.h"
#include "network/rounded_network.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using Texel = std::array<float, 4>;

constexpr int kWidth = 64;  // of the textures

// A context of OpenGL ES 3 that draws to textures only; null display if there is none to be had.
class Context {
 public:
  Context() {
    const auto platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (platform_display == nullptr) return;
    display_ = platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) return;
    const EGLint config_wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,  // not a window, the default
                                    EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE};
    EGLConfig config;
    EGLint found = 0;
    eglBindAPI(EGL_OPENGL_ES_API);
    eglChooseConfig(display_, config_wanted, &config, 1, &found);
    if (found == 0) return;
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    works_ = context_ != EGL_NO_CONTEXT &&
             eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) &&
             HasExtension("GL_EXT_color_buffer_float");
  }
  ~Context() {
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  bool works() const { return works_; }

 private:
  static bool HasExtension(const std::string& name) {
    const auto* all = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
    return all != nullptr && std::string(all).find(name) != std::string::npos;
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  bool works_ = false;
};

GLuint FloatTexture(const std::vector<Texel>& texels) {
  GLuint texture;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  const auto height = static_cast<GLsizei>(texels.size() / kWidth);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kWidth, height, 0, GL_RGBA, GL_FLOAT, texels.data());
  return texture;
}

GLuint Compiled(GLenum type, const std::string& source) {
  const GLuint shader = glCreateShader(type);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint done = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  std::array<char, 4096> log = {};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  EXPECT_TRUE(done) << log.data();
  return shader;
}

// A program that draws one triangle over everything; each pixel is a pair's value.
GLuint LinkedProgram(const std::string& functions, const std::string& name) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, Compiled(GL_VERTEX_SHADER,
                                   "#version 300 es\nvoid main() {\n"
                                   "  vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                   "  gl_Position = vec4(4.0 * p - 1.0, 0.0, 1.0);\n}\n"));
  // The precision is what the functions need, whatever was declared before.
  glAttachShader(program,
                 Compiled(GL_FRAGMENT_SHADER,
                          "#version 300 es\nprecision mediump float;\n" + functions +
                              "\nuniform highp sampler2D wi, wo;\nout highp vec4 value;\n"
                              "void main() {\n  ivec2 at = ivec2(gl_FragCoord.xy);\n"
                              "  value = vec4(" +
                              name +
                              "_eval(texelFetch(wi, at, 0).xyz, texelFetch(wo, at, 0).xyz), 1.0);\n"
                              "}\n"));
  glLinkProgram(program);
  GLint done = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  EXPECT_TRUE(done);
  return program;
}

// The values at the pairs of a shader that GlslSource wrote.
std::vector<Texel> Draw(const std::string& functions, const std::string& name,
                        const std::vector<FloatPair>& pairs) {
  const std::size_t size = (pairs.size() + kWidth - 1) / kWidth * kWidth;
  std::vector<Texel> wi(size), wo(size), values(size);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const FloatPair& p = pairs[n];
    wi[n] = {p[0], p[1], p[2], 0}, wo[n] = {p[3], p[4], p[5], 0};
  }
  const GLuint program = LinkedProgram(functions, name);
  const GLuint textures[3] = {FloatTexture(wi), FloatTexture(wo), FloatTexture(values)};
  GLuint frame;
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[2], 0);
  const auto height = static_cast<GLsizei>(size / kWidth);
  glViewport(0, 0, kWidth, height);
  glUseProgram(program);
  for (int n = 0; n < 2; ++n) {
    glActiveTexture(GL_TEXTURE0 + n);
    glBindTexture(GL_TEXTURE_2D, textures[n]);
    glUniform1i(glGetUniformLocation(program, n == 0 ? "wi" : "wo"), n);
  }
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glReadPixels(0, 0, kWidth, height, GL_RGBA, GL_FLOAT, values.data());
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  glDeleteFramebuffers(1, &frame);
  glDeleteTextures(3, textures);
  glDeleteProgram(program);
  values.resize(pairs.size());
  return values;
}

// As formats.h promises.
double Allowed(const NeuralBrdf& network, double f) {
  const Encoding encoding = network.shape().encoding();
  const bool bends = encoding == Encoding::kMerl;
  return bends ? 1e-4 * (1.0 + f) : 1e-5 * f + 1e-6;
}

TEST(GlslSource, AgreesWithTheLibrary) {
  const Context context;
  if (!context.works()) GTEST_SKIP() << "needs OpenGL ES 3 with float targets, e.g. Mesa's";
  const std::vector<FloatPair> pairs = HardPairs();
  double worst = 0.0;
  for (const auto& [name, network] : NetworksOfAllKinds()) {
    const std::vector<Rgb> expected = LibraryValues(network, pairs);
    const std::vector<Texel> values = Draw(GlslSource(network, name), name, pairs);
    double worst_here = 0.0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      for (int c = 0; c < 3; ++c) {
        const double f = expected[p][c];
        const double error = std::abs(values[p][c] - f) / Allowed(network, f);
        EXPECT_LE(error, 1.0) << name << " pair " << p << ": " << values[p][c] << " " << f;
        worst_here = std::max(worst_here, error);
      }
      if (HasFailure()) return;
    }
    RecordProperty(name, FormatNumber(worst_here));
    worst = std::max(worst, worst_here);
  }
  RecordProperty("worst_error_over_bound", FormatNumber(worst));
}

TEST(GlslSource, WeightsOfHalfPrecisionAreThoseOfTheNetwork) {
  const Context context;
  if (!context.works()) GTEST_SKIP() << "needs OpenGL ES 3 with float targets, e.g. Mesa's";
  const std::vector<FloatPair> pairs = HardPairs();
  for (const auto& [name, network] : NetworksOfAllKinds()) {
    const NeuralBrdf rounded = RoundedOneByOne(network);
    const std::vector<Rgb> expected = LibraryValues(rounded, pairs);
    const std::vector<Texel> values =
        Draw(GlslSource(rounded, name, WeightStorage::kHalf), name, pairs);
    double worst = 0.0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      for (int c = 0; c < 3; ++c) {
        const double f = expected[p][c];
        worst = std::max(worst, std::abs(values[p][c] - f) / Allowed(rounded, f));
      }
    }
    EXPECT_LE(worst, 1.0) << name;
    EXPECT_THAT(ErrorOf([&] { GlslSource(network, name, WeightStorage::kHalf); }),
                HasSubstr("isn't of half precision"));
  }
}

TEST(GlslSource, IsReciprocalToTheBit) {
  const Context context;
  if (!context.works()) GTEST_SKIP() << "needs OpenGL ES 3 with float targets, e.g. Mesa's";
  const std::vector<FloatPair> pairs = HardPairs();
  std::vector<FloatPair> swapped;
  for (const FloatPair& pair : pairs) swapped.push_back(Swapped(pair));
  for (const auto& [name, network] : NetworksOfAllKinds()) {
    const std::string functions = GlslSource(network, name);
    const std::vector<Texel> there = Draw(functions, name, pairs),
                             back = Draw(functions, name, swapped);
    std::size_t differ = 0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      differ += std::memcmp(&there[p], &back[p], sizeof(Texel)) != 0;
    }
    if (IsReciprocal(network)) {
      EXPECT_EQ(differ, 0u) << name;
    } else {
      EXPECT_GT(differ, pairs.size() / 2) << name;  // the comparison can fail
    }
  }
}

TEST(GlslSource, NamesThatLanguagesReserveAreRefused) {
  const NeuralBrdf network = RandomNetwork(Encoding::kMerl, Activation::kTanh, {2}, 1);
  for (const char* name : {"gl_gold", "gold__paint", "gold_"}) {
    EXPECT_THAT(ErrorOf([&] { GlslSource(network, name); }), HasSubstr("is reserved in GLSL"));
  }
  for (const char* name : {"_", "__gold"}) {
    EXPECT_THAT(ErrorOf([&] { WgslSource(network, name); }), HasSubstr("is reserved in WGSL"));
  }
  EXPECT_THAT(HlslSource(network, "gl_gold__"), HasSubstr("float3 gl_gold___eval("));
  std::vector<double> weights = network.weights();
  weights[3] = 1e39;
  EXPECT_THAT(ErrorOf([&] { GlslSource(NeuralBrdf(network.shape(), weights), "gold"); }),
              HasSubstr("weight 1e+39 is beyond single precision"));
}

}  // namespace
}  // namespace pbnbrdf
