#include <fmt/format.h>
#include <iostream>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/report.h"
#include "evaluate/error_split.h"
#include "evaluate/indirect_errors.h"
#include "evaluate/indirect_truths.h"
#include "evaluate/lit_errors.h"
#include "evaluate/truths.h"
#include "support/image_io.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

struct Errors {
  ErrorSummary scene;
  ErrorSummary height_field;
  ErrorSummary limit;  // error of the height-field truth against scene truth
  AngleSummary bent_normal;
  AngleSummary surface_normal;  // the surface normal as the bent normal
  OpenSurfaceSummary open;
};

Errors measure_errors(const Rendering& rendering, const Truths& truths,
                      const HeightFieldTruth& height_field) {
  const FrameImages& images = rendering.images;
  const Image<float>& scene = truths.scene.visibility;
  return {compare_images(images.visibility, scene, truths.surfaces),
          compare_images(images.visibility, height_field.visibility, truths.surfaces),
          compare_images(height_field.visibility, scene, truths.surfaces),
          compare_directions(images.bent_normal_ws, truths.scene.bent_normal_ws, truths.surfaces),
          compare_directions(images.normal_ws, truths.scene.bent_normal_ws, truths.surfaces),
          open_surfaces(images.visibility, scene, truths.surfaces)};
}

nlohmann::ordered_json errors_json(const Errors& errors) {
  return {{"scene_truth", to_json(errors.scene)},
          {"height_field_truth", to_json(errors.height_field)},
          {"height_field_limit", to_json(errors.limit)},
          {"bent_normal", to_json(errors.bent_normal)},
          {"surface_normal", to_json(errors.surface_normal)},
          {"open_surfaces", to_json(errors.open)}};
}

std::string error_table(const Errors& errors) {
  return fmt::format("RMSE of visibility over {} pixels\n", errors.scene.count) +
         error_row("against ray-traced scene truth", errors.scene.rmse, errors.scene.bias) +
         error_row("against height-field truth", errors.height_field.rmse,
                   errors.height_field.bias) +
         error_row("height-field truth against scene truth", errors.limit.rmse, errors.limit.bias) +
         fmt::format(
             "Angle between bent normal and truth: mean {:.2f} degrees, 95 % within {:.2f} (of the "
             "surface normal: {:.2f} and {:.2f})\n"
             "Open surfaces: mean visibility {:.4f}, {:.2f} % of pixels below 0.95\n",
             errors.bent_normal.mean_degrees, errors.bent_normal.percentile_95_degrees,
             errors.surface_normal.mean_degrees, errors.surface_normal.percentile_95_degrees,
             errors.open.mean_visibility, 100.0 * errors.open.fraction_below_95);
}

Result<void> write_truths(const Rendering& rendering, const Truths& truths,
                          const HeightFieldTruth& height_field,
                          const std::filesystem::path& folder) {
  const Image<float>& scene = truths.scene.visibility;
  const Image<float>& result = rendering.images.visibility;
  ALCOVE_TRY_VOID(write_exr(folder / "truth_scene.exr", scene));
  ALCOVE_TRY_VOID(write_png(folder / "truth_scene.png", scene));
  ALCOVE_TRY_VOID(write_exr(folder / "truth_height_field.exr", height_field.visibility));
  ALCOVE_TRY_VOID(write_exr(folder / "truth_bent_normal.exr", truths.scene.bent_normal_ws));
  return write_png(folder / "error.png", error_colours(result, scene));
}

// Splits the error, writes its pictures and returns its table. Adds it to `report`.
Result<std::string> split_table(const Options& options, const Rendering& rendering,
                                const Truths& truths, nlohmann::ordered_json& report) {
  ALCOVE_TRY(const auto gpu, open_gpu({options.device, options.validation}));
  ALCOVE_TRY(const ErrorSplit split,
             split_error(*gpu, rendering.scene, {options.view, rendering.camera},
                         rendering.settings, truths.scene.visibility, truths.surfaces));
  report["split"] = to_json(split);
  ALCOVE_TRY_VOID(check_validation(*gpu));
  ALCOVE_TRY_VOID(write_pictures(split, options.out));
  return format_table(split);
}

}  // namespace

Result<void> run_compare(const Options& options) {
  // The folder is created first, because the comparison takes minutes.
  ALCOVE_TRY_VOID(create_folder(options.out));
  ALCOVE_TRY(const auto rendering, render(options));
  const FrameImages& images = rendering.images;
  const TruthFrame frame{rendering.scene, rendering.camera, rendering.settings.radius,
                         images.depth_ndc, images.normal_ws};
  ALCOVE_TRY(const auto truths, compute_truths(frame, truth_options(options)));
  const HeightFieldTruth height_field = compute_height_field_truth(frame, truth_options(options));
  ALCOVE_TRY(const auto light, compute_indirect_truths(rendering, truth_options(options)));
  const Errors errors = measure_errors(rendering, truths, height_field);
  const IndirectErrors indirect_errors = measure_indirect_errors(rendering, truths, light);
  nlohmann::ordered_json report = rendering_report(rendering, options);
  report["spp"] = options.occlusion.spp;
  report["errors"] = errors_json(errors);
  report["errors"].update(to_json(indirect_errors));
  std::string lit_table;
  if (light.lit) {
    const LitErrors lit_errors = measure_lit_errors(rendering, light);
    report["errors"].update(to_json(lit_errors));
    lit_table = lit_error_table(lit_errors);
  }
  std::string causes;
  if (options.split) {
    ALCOVE_TRY(causes, split_table(options, rendering, truths, report));
  }
  ALCOVE_TRY_VOID(write_images(rendering, options.out));
  ALCOVE_TRY_VOID(write_truths(rendering, truths, height_field, options.out));
  if (light.lit) ALCOVE_TRY_VOID(write_lit_steps(rendering, light, options.out));
  ALCOVE_TRY_VOID(write_text(options.out / "report.json", report.dump(2) + "\n"));
  std::cout << time_table(rendering) << error_table(errors) << indirect_error_table(indirect_errors)
            << lit_table << causes << "Images and report.json are in " << options.out.string()
            << "; in error.png red is too dark and blue too bright\n";
  return {};
}

}  // namespace alcove::sample
