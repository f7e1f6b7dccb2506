#include <iostream>

#include "commands/commands.h"
#include "commands/report.h"
#include "support/image_io.h"

namespace alcove::sample {

tl::expected<void, std::string> run_render(const Options& options) {
  if (auto made = create_folder(options.out); !made) {
    return made;
  }
  const auto rendering = render(options);
  if (!rendering) {
    return tl::unexpected(rendering.error());
  }
  return write_images(*rendering, options.out)
      .and_then([&] {
        return write_text(options.out / "report.json",
                          report_of(*rendering, options).dump(2) + "\n");
      })
      .map([&] {
        std::cout << time_table(*rendering) << "Images and report.json are in "
                  << options.out.string() << "\n";
      });
}

}  // namespace alcove::sample
