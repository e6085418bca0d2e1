// pbnbrdf report
#include "command_line.h"
#include "opened_fit.h"
#include "report_fits.h"

namespace pbnbrdf::cli {
namespace {

Fields ReportFields(ReportRequest* request) {
  Fields fields;
  fields.AddCommon(FitField(&request->which.fit));
  fields.AddCommon(
      Text("fits", &request->which.fits, "folder of fits, DIR/NAME.safetensors, for one page"));
  fields.AddRequired(Text("out", &request->out, "HTML file to write"));
  fields.AddCommon(Text("material", &request->which.material.source,
                        "source of reflectance, see below; if absent, the one that the fit's file "
                        "names"));
  fields.AddCommon(ScaleField(&request->which.material));
  fields.AddCommon(SymmetrizeField(&request->which.material.symmetrize));
  fields.AddCommon(Text("summary", &request->which.summary,
                        "what fit --summary wrote, for the plot of error against time; if absent, "
                        "NAME.json beside the fit"));
  fields.Add(Switch("any_material", &request->which.any_material,
                    "show the fit beside a material that it wasn't fitted to"));
  fields.AddCommon(Text("scene", &request->scene,
                        "scene file (JSON) of one material, for the pictures; if absent, a sphere "
                        "under a sky"));
  fields.AddCommon(Text("environment", &request->environment,
                        "OpenEXR file (latitude-longitude) that replaces the scene's environment "
                        "light"));
  fields.Add(Integer("film_width", &request->film_width, Between(0, 4096),
                     "pixels; 0: 320, and 112 for more than 8 fits"));
  fields.Add(Integer("samples_per_pixel", &request->samples_per_pixel, Between(1, 1e6),
                     "of the pictures"));
  fields.Add(Integer("threads", &request->threads, AtLeast(0),
                     "threads for the pictures; 0: one for each core"));
  fields.AddCommon(Switch("quiet", &request->quiet, "print nothing"));
  return fields;
}

int RunReport(const ReportRequest& request, const Arguments&) {
  WriteReport(request);
  return 0;
}

}  // namespace

Command ReportCommand() {
  return Command{
      .name = "report",
      .summary = "makes a page that shows fits beside their materials, to look at in a browser",
      .usage = R"(  pbnbrdf report --fit=gold.safetensors --material=gold.binary --out=gold.html
  pbnbrdf report --fits=fits --out=fits.html
)",
      .notes = StrCat(
          R"(The page is one file that needs nothing else: pictures of material and fit with a divider, and their
difference (FLIP); a sphere to light and to turn; slices of the BRDF, with what was measured;
directional albedo; error against time; all measures; the command that repeats the fit; of several
fits a table, too. All that it shows is in it as JSON, in the element of id report-data.

)",
          kSourceNotes)}
      .With(ReportFields, RunReport);
}

}  // namespace pbnbrdf::cli
