#include <iostream>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/report.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
Result<void> run_render(const Options& options) {
  ALCOVE_TRY_VOID(create_folder(options.out));
  ALCOVE_TRY(const auto rendering, render(options));
  return write_images(rendering, options.out)
      .and_then([&] {
        return write_text(options.out / "report.json",
                          rendering_report(rendering, options).dump(2) + "\n");
      })
      .map([&] {
        std::cout << time_table(rendering) << "Images and report.json are in "
                  << options.out.string() << "\n";
      });
}

}  // namespace alcove::sample
