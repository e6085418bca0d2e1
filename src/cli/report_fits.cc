#include "report_fits.h"

#include <iostream>

#include "base/about.h"
#include "base/timer.h"
#include "command_line.h"
#include "fit_record.h"
#include "opened_fit.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "progress.h"
#include "render/studio.h"
#include "render_summary.h"
#include "report/light_set.h"
#include "report/material_report.h"
#include "report/page.h"
#include "sphere_text.h"

namespace pbnbrdf::cli {
namespace {

constexpr int kLights = 48;

// What a fit takes of the page; less if there are many.
struct Detail {
  int film_width;  // pixels
  ValueTableSize table;
};

Detail DetailFor(std::size_t fits) {
  constexpr std::size_t kMany = 8;
  return fits > kMany ? Detail{112, {24, 12, 12}} : Detail{320, {64, 32, 32}};
}

Scene SceneOf(const ReportRequest& request, int default_width) {
  const SceneChanges changes = {request.environment};
  Scene scene = request.scene.empty() ? ParseScene(kSphereSceneText, "", changes)
                                      : ReadSceneAndTell(request.scene, changes);
  if (scene.materials.size() != 1)
    Fail(request.scene, ": must have one material, for each in turn");
  scene.film = WithWidth(scene.film, request.film_width > 0 ? request.film_width : default_width);
  if (std::min(scene.film.width, scene.film.height) < kSsimWindow) {
    Fail("--film_width=", request.film_width, ": pictures need at least ", kSsimWindow,
         " pixels each way");
  }
  return scene;
}

class Reporter {
 public:
  Reporter(const ReportRequest& request, std::size_t fits)
      : request_(request), detail_(DetailFor(fits)), scene_(SceneOf(request, detail_.film_width)) {}

  Json Report(const FitOfMaterial& subject) const {
    const OpenedFit fit = OpenFit(subject.file);
    const std::unique_ptr<Brdf> material = subject.material.Open();
    return About(subject.material.source, [&] {
      const Json measures = MeasuresOf(subject, *material, fit);
      const Studio studio(scene_, *material, request_.samples_per_pixel, request_.threads);
      const Image of_material = studio.Photograph([&] { return subject.material.Open(); });
      const Image of_fit = studio.Photograph([&] { return OpenFit(subject.file).brdf; });
      const Json history = subject.summary.is_null() ? Json() : subject.summary.at("history");
      return MaterialReport({subject.name, subject.material.source, subject.file, *material,
                             *fit.brdf, subject.command, WithMeanings(measures),
                             measures.at("cautions"), history, of_material, of_fit, detail_.table});
    });
  }

  std::string Page(const std::vector<Json>& reports) const {
    std::vector<DistantLight> lights;
    if (const auto& environment = scene_.environment) {
      lights = LightSet([&](const Vec3& to) { return environment->Radiance(to); }, kLights);
    }
    return ReportPage(reports, lights, PBNBRDF_VERSION);
  }

 private:
  Json MeasuresOf(const FitOfMaterial& subject, const Brdf& material, const OpenedFit& fit) const {
    if (!request_.which.fits.empty() && HasMeasures(subject.summary)) return subject.summary;
    return MeasureFit(material, *fit.brdf, fit.parameters);
  }

  static bool HasMeasures(const Json& summary) {
    if (summary.is_null() || summary.value("version", "") != PBNBRDF_VERSION) return false;
    const auto meanings = MeasureMeanings();
    return summary.contains("cautions") &&
           std::all_of(meanings.begin(), meanings.end(), [&](const MeasureMeaning& measure) {
             return summary.contains(measure.key);
           });
  }

  static Json WithMeanings(const Json& measures) {
    Json json = Json::array();
    for (const auto& [key, meaning] : MeasureMeanings()) {
      json.push_back({{"key", key}, {"value", measures.at(key)}, {"meaning", meaning}});
    }
    return json;
  }

  const ReportRequest& request_;
  Detail detail_;
  Scene scene_;
};

}  // namespace

void WriteReport(const ReportRequest& request) {
  const std::vector<Output> outputs = {{"out", request.out}};
  CheckOutputs(outputs);
  const Timer timer;
  const std::vector<FitOfMaterial> fits = FindFits(request.which);
  const Reporter reporter(request, fits.size());
  const ProgressLine line(request.quiet);
  std::vector<Json> reports;
  for (const FitOfMaterial& fit : fits) {
    line.Show(StrCat("page: ", reports.size(), " of ", fits.size(), " done  ", fit.name));
    reports.push_back(reporter.Report(fit));
  }
  line.Clear();
  const std::string page = reporter.Page(reports);
  WriteFile(request.out, page);
  if (request.quiet || UseStandardOutput(outputs)) return;
  std::cout << request.out << ": " << fits.size() << (fits.size() == 1 ? " fit, " : " fits, ")
            << (page.size() + 500) / 1000 << " kB, " << SecondsText(timer.Seconds())
            << "; open it in a browser\n";
}

}  // namespace pbnbrdf::cli
