// The extension module _pbnbrdf, on which python/pbnbrdf builds: arrays of N x 3, of float or double.
#include <glog/logging.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "measure/measures.h"
#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/importance_sampler.h"
#include "pbnbrdf/brdf/reciprocal.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/export/export.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/solve/half_weights.h"
#include "pbnbrdf/solve/problem_file.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "solve/fit_fields.h"
#include "sources/sample_weights.h"

namespace nb = nanobind;

namespace pbnbrdf::python {
namespace {

template <typename T>
using Rows = nb::ndarray<const T, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <typename T>
using Result = nb::ndarray<nb::numpy, T>;

constexpr std::size_t kChunk = 1024;     // pairs that one thread evaluates at a time, in its cache
constexpr double kUnitTolerance = 1e-3;  // of the square of a direction's length

// An array that owns its values.
template <typename T>
Result<T> MakeResult(std::unique_ptr<T[]> values, std::initializer_list<std::size_t> shape) {
  T* data = values.release();
  nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  return Result<T>(data, shape, owner);
}

bool IsUnit(const Vec3& v) { return std::abs(Dot(v, v) - 1.0) <= kUnitTolerance; }

// Row n of the array as a direction. Throws ValueError unless it is a unit vector.
template <typename T>
Vec3 DirectionAt(const Rows<T>& rows, std::size_t n, const char* name) {
  const T* v = rows.data() + 3 * n;
  const Vec3 direction = {double(v[0]), double(v[1]), double(v[2])};
  if (!IsUnit(direction)) {
    throw nb::value_error(StrCat(name, ": row ", n, " is not a unit vector: (", direction.x, ", ",
                                 direction.y, ", ", direction.z, ")")
                              .c_str());
  }
  return direction;
}

template <typename T>
void CheckSizes(const Rows<T>& wi, std::size_t size, const char* name) {
  if (wi.shape(0) != size) {
    throw nb::value_error(StrCat(name, ": ", size, " rows, where wi has ", wi.shape(0)).c_str());
  }
}

// Pairs of the rows from `first` on. Throws ValueError unless they are unit vectors.
template <typename T>
void CopyPairs(const Rows<T>& wi, const Rows<T>& wo, std::size_t first,
               std::span<DirectionPair> pairs) {
  const T *from_wi = wi.data() + 3 * first, *from_wo = wo.data() + 3 * first;
  bool are_unit = true;  // without a branch for each row
  for (DirectionPair& pair : pairs) {
    pair = {{double(from_wi[0]), double(from_wi[1]), double(from_wi[2])},
            {double(from_wo[0]), double(from_wo[1]), double(from_wo[2])}};
    are_unit &= IsUnit(pair.wi) & IsUnit(pair.wo);
    from_wi += 3;
    from_wo += 3;
  }
  for (std::size_t n = 0; !are_unit && n < pairs.size(); ++n) {
    DirectionAt(wi, first + n, "wi");
    DirectionAt(wo, first + n, "wo");
  }
}

// f at each pair, on all cores; in single precision where the arrays are.
template <typename T>
Result<T> Evaluate(const Brdf& brdf, const Rows<T>& wi, const Rows<T>& wo) {
  CheckSizes(wi, wo.shape(0), "wo");
  const std::size_t count = wi.shape(0);
  auto values = std::make_unique_for_overwrite<T[]>(3 * count);
  {
    const nb::gil_scoped_release release;
    const auto single = std::is_same_v<T, float> ? brdf.SinglePrecision() : nullptr;
    const Brdf& evaluated = single ? *single : brdf;
    ParallelFor((count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
      const std::size_t first = chunk * kChunk, last = std::min(first + kChunk, count);
      thread_local std::vector<DirectionPair> pairs;
      thread_local std::vector<Rgb> rgb;
      pairs.resize(last - first);
      rgb.resize(last - first);
      CopyPairs<T>(wi, wo, first, pairs);
      evaluated.Evaluate(pairs, rgb);
      T* value = values.get() + 3 * first;
      for (const Rgb& f : rgb) {
        for (const double channel : f) *value++ = static_cast<T>(channel);
      }
    });
  }
  return MakeResult(std::move(values), {count, 3});
}

Result<double> Albedo(const Brdf& brdf, const Rows<double>& wi) {
  const std::size_t count = wi.shape(0);
  auto values = std::make_unique<double[]>(3 * count);
  {
    const nb::gil_scoped_release release;
    ParallelFor(count, [&](std::size_t n) {
      const Rgb albedo = DirectionalAlbedo(brdf, DirectionAt(wi, n, "wi"));
      std::copy(albedo.begin(), albedo.end(), &values[3 * n]);
    });
  }
  return MakeResult(std::move(values), {count, 3});
}

// (wo, pdf) for each wi and two uniform numbers.
nb::tuple Sample(
    const ImportanceSampler& sampler, const Rows<double>& wi,
    const nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>& u) {
  CheckSizes(wi, u.shape(0), "u");
  const std::size_t count = wi.shape(0);
  std::vector<Vec3> from(count), to(count);
  std::vector<std::array<double, 2>> uniform(count);
  for (std::size_t n = 0; n < count; ++n) {
    from[n] = DirectionAt(wi, n, "wi");
    uniform[n] = {u.data()[2 * n], u.data()[2 * n + 1]};
    for (const double x : uniform[n]) {
      if (!(x >= 0.0 && x < 1.0))
        throw nb::value_error(StrCat("u: row ", n, " has ", x, ", not in [0, 1)").c_str());
    }
  }
  auto wo = std::make_unique<double[]>(3 * count);
  auto pdf = std::make_unique<double[]>(count);
  {
    const nb::gil_scoped_release release;
    sampler.Sample(from, uniform, to, {pdf.get(), count});
    for (std::size_t n = 0; n < count; ++n) {
      wo[3 * n] = to[n].x;
      wo[3 * n + 1] = to[n].y;
      wo[3 * n + 2] = to[n].z;
    }
  }
  return nb::make_tuple(MakeResult(std::move(wo), {count, 3}), MakeResult(std::move(pdf), {count}));
}

Result<double> Pdf(const ImportanceSampler& sampler, const Rows<double>& wi,
                   const Rows<double>& wo) {
  CheckSizes(wi, wo.shape(0), "wo");
  const std::size_t count = wi.shape(0);
  std::vector<DirectionPair> pairs(count);
  for (std::size_t n = 0; n < count; ++n) {
    pairs[n] = {DirectionAt(wi, n, "wi"), DirectionAt(wo, n, "wo")};
  }
  auto pdf = std::make_unique<double[]>(count);
  {
    const nb::gil_scoped_release release;
    sampler.Pdf(pairs, {pdf.get(), count});
  }
  return MakeResult(std::move(pdf), {count});
}

// Measurements of the caller's own.
std::shared_ptr<Brdf> FromArrays(const Rows<double>& wi, const Rows<double>& wo,
                                 const Rows<double>& rgb, const std::optional<Numbers>& sigma,
                                 bool isotropic, int channels) {
  CheckSizes(wi, wo.shape(0), "wo");
  CheckSizes(wi, rgb.shape(0), "rgb");
  if (sigma && sigma->shape(0) != wi.shape(0)) {
    throw nb::value_error(
        StrCat("sigma: ", sigma->shape(0), " numbers, where wi has ", wi.shape(0), " rows")
            .c_str());
  }
  ScatteredData data = {.kind = "arrays", .channels = channels, .isotropic = isotropic};
  for (std::size_t n = 0; n < wi.shape(0); ++n) {
    const double* value = rgb.data() + 3 * n;
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(value[c]))
        throw nb::value_error(StrCat("rgb: row ", n, " is not finite").c_str());
    }
    data.samples.push_back(
        {{DirectionAt(wi, n, "wi"), DirectionAt(wo, n, "wo")}, {value[0], value[1], value[2]}});
  }
  if (sigma) {
    for (std::size_t n = 0; n < sigma->shape(0); ++n) {
      if (!(std::isfinite(sigma->data()[n]) && sigma->data()[n] >= 0.0)) {
        throw nb::value_error(StrCat("sigma: number ", n, " is not finite and >= 0").c_str());
      }
    }
    SetWeights({sigma->data(), sigma->shape(0)}, data.samples);
  }
  return std::make_shared<ScatteredBrdf>(std::move(data));
}

// The solver's view of Python: the callback, and Ctrl-C. Exceptions wait until the fit has ended.
class Listener {
 public:
  explicit Listener(nb::object callback) : callback_(std::move(callback)) {}

  bool Hear(const FitProgress& progress) {
    const nb::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) {
      error_ = std::make_exception_ptr(nb::python_error());
      return false;
    }
    if (callback_.is_none()) return true;
    try {
      const nb::object answer =
          callback_(progress.iteration, progress.seconds, progress.cost, progress.heldout_error);
      return answer.is_none() || nb::cast<bool>(nb::bool_(answer));
    } catch (...) {
      error_ = std::current_exception();
      return false;
    }
  }

  void Rethrow() {
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

  bool WantsErrors() const { return !callback_.is_none(); }

 private:
  nb::object callback_;
  std::exception_ptr error_;
};

// (network, summary as JSON). fields: texts of problem fields, after those of the file `problem`, if it isn't "".
nb::tuple FitNetwork(const Brdf& material, const std::string& problem,
                     const std::vector<std::pair<std::string, std::string>>& fields, int threads,
                     nb::object callback) {
  FitSetup setup = problem.empty() ? FitSetup{} : ReadProblem(problem);
  const Fields table = FitFields(&setup.problem, &setup.options);
  for (const auto& [name, text] : fields) table.Set(name, text);
  table.Check();
  Listener listener(std::move(callback));
  setup.options.threads = threads;
  setup.options.reports_heldout_error = listener.WantsErrors();
  setup.options.limits_wall_time = true;
  setup.options.on_iteration = [&](const FitProgress& progress) { return listener.Hear(progress); };
  std::optional<Fit> fit;
  {
    const nb::gil_scoped_release release;
    fit.emplace(FitBrdf(material, setup.problem, setup.options));
  }
  listener.Rethrow();
  const FitSummary& summary = fit->summary;
  Json history = Json::array();
  for (const FitMoment& moment : summary.history) {
    history.push_back({moment.iteration, moment.seconds, moment.error});
  }
  const std::string problem_text = ProblemText({fit->problem, setup.options});
  const Json json = {{"iterations", summary.iterations},
                     {"seconds", summary.seconds},
                     {"cost", summary.final_cost},
                     {"samples_used", summary.samples},
                     {"termination", NameOf(kTerminations, summary.termination)},
                     {"message", summary.message},
                     {"max_albedo", summary.energy.max_albedo},
                     {"history", history},
                     {"problem", problem_text}};
  NeuralBrdf::Metadata metadata = {
      {"version", PBNBRDF_VERSION},
      {"material", material.Description()},
      {"problem", problem_text},
      {"termination", std::string(NameOf(kTerminations, summary.termination))}};
  auto network = std::make_shared<NeuralBrdf>(fit->network.shape(), fit->network.weights(),
                                              std::move(metadata));
  return nb::make_tuple(std::move(network), JsonLine(json));
}

std::string Measure(const Brdf& material, const Brdf& fit, std::uint64_t samples,
                    std::uint64_t seed) {
  std::size_t parameters = 0;
  if (const auto* network = dynamic_cast<const NeuralBrdf*>(&fit))
    parameters = network->weights().size();
  if (const auto* model = dynamic_cast<const AnalyticBrdf*>(&fit))
    parameters = model->parameters().size();
  const nb::gil_scoped_release release;
  return JsonLine(MeasureFit(material, fit, parameters, {.samples = samples, .seed = seed}));
}

// The matrices [W | b] of the layers, out x (in + 1), as they lie in the network.
nb::list Weights(const std::shared_ptr<NeuralBrdf>& network) {
  nb::list arrays;
  for (const LayerWeights& layer : network->Layers()) {
    nb::capsule owner(new std::shared_ptr<NeuralBrdf>(network), [](void* p) noexcept {
      delete static_cast<std::shared_ptr<NeuralBrdf>*>(p);
    });
    arrays.append(nb::ndarray<nb::numpy, const double>(
        layer.block, {std::size_t(layer.out), std::size_t(layer.in + 1)}, owner));
  }
  return arrays;
}

// The network with its weights rounded, if the format wants that.
NeuralBrdf ForFormat(const NeuralBrdf& network, const std::string& format) {
  const bool half =
      FindNamed(ExportFormats(), "format=", format).source == ExportSource::kHalfNetwork;
  return half ? ToHalfWeights(network).network : network;
}

}  // namespace

NB_MODULE(_pbnbrdf, m) {
  google::InitGoogleLogging("pbnbrdf");
  google::SetStderrLogging(google::GLOG_FATAL);
  for (int severity = google::GLOG_INFO; severity <= google::GLOG_FATAL; ++severity) {
    google::SetLogDestination(severity, "");
  }
  m.attr("version") = PBNBRDF_VERSION;
  nb::exception<Error>(m, "Error", PyExc_ValueError);
  nb::class_<Brdf>(m, "Brdf")
      .def("evaluate", &Evaluate<double>, nb::arg("wi"), nb::arg("wo"))
      .def("evaluate", &Evaluate<float>, nb::arg("wi"), nb::arg("wo"))
      .def("albedo", &Albedo, nb::arg("wi"))
      .def_prop_ro("description", [](const Brdf& brdf) { return brdf.Description(); })
      .def_prop_ro("is_isotropic", &Brdf::IsIsotropic)
      .def_prop_ro("is_reciprocal", &Brdf::IsReciprocal);
  nb::class_<NeuralBrdf, Brdf>(m, "Network")
      .def("weights",
           [](nb::handle self) { return Weights(nb::cast<std::shared_ptr<NeuralBrdf>>(self)); })
      .def("metadata",
           [](const NeuralBrdf& network) {
             nb::dict dict;
             for (const auto& [key, value] : network.metadata()) dict[key.c_str()] = value;
             return dict;
           })
      .def("save", &NeuralBrdf::Write, nb::arg("path"))
      .def(
          "export",
          [](const NeuralBrdf& network, const std::string& format, const std::string& path,
             const std::string& name) { Export(ForFormat(network, format), format, path, name); },
          nb::arg("format"), nb::arg("path"), nb::arg("name") = "")
      .def("source",
           [](const NeuralBrdf& network, const std::string& format, const std::string& name) {
             return ExportedFiles(ForFormat(network, format), format, name, name).at(0).content;
           });
  nb::class_<ImportanceSampler>(m, "Sampler")
      .def(nb::init<const Brdf&>())
      .def("sample", &Sample)
      .def("pdf", &Pdf);
  m.def("open",
        [](const std::string& source) -> std::shared_ptr<Brdf> { return OpenBrdf(source); });
  m.def("symmetrized", [](const std::string& source) -> std::shared_ptr<Brdf> {
    return std::make_shared<ReciprocalBrdf>(OpenBrdf(source));
  });
  m.def("from_arrays", &FromArrays, nb::arg("wi"), nb::arg("wo"), nb::arg("rgb"),
        nb::arg("sigma").none(), nb::arg("isotropic"), nb::arg("channels"));
  m.def(
      "fit",
      [](const Brdf& material, const std::string& problem, const nb::list& fields, int threads,
         nb::object callback) {
        std::vector<std::pair<std::string, std::string>> texts;
        for (const nb::handle item : fields) {
          const auto pair = nb::cast<std::vector<std::string>>(item);
          texts.push_back({pair.at(0), pair.at(1)});
        }
        return FitNetwork(material, problem, texts, threads, std::move(callback));
      },
      nb::arg("material"), nb::arg("problem"), nb::arg("fields"), nb::arg("threads"),
      nb::arg("callback").none());
  m.def("measure", &Measure);
}

}  // namespace pbnbrdf::python
