// Uses both libraries without a device: compiles a plan, makes settings, and checks that creating
// pipelines on a null device returns an error.
#include <alcove/framegraph/framegraph.h>
#include <alcove/passes/graph.h>

#include <cstdio>

int main() {
  using namespace alcove;
  AlcoveSettings settings{.struct_size = sizeof settings};
  const bool filled = alcoveGetSettings(ALCOVE_QUALITY_HIGH, 2.0f, &settings) == ALCOVE_SUCCESS;

  framegraph::Graph graph;
  const framegraph::Texture texture =
      graph.create_texture("texture", {VK_FORMAT_R8_UNORM, framegraph::Extent::absolute(64, 64)});
  auto pass = graph.add_pass("pass");
  graph.output(pass.write(texture, framegraph::access::storage_write_compute, {},
                          framegraph::Contents::discard));
  pass.record([](framegraph::RecordContext&) {});
  const auto plan = framegraph::compile(graph);

  const auto pipelines = passes::Pipelines::create({}, 1);
  const bool good =
      filled && settings.radius == 2.0f && plan && plan->passes.size() == 1 && !pipelines;
  std::printf("%s\n",
              pipelines ? "Pipelines were made on no device." : pipelines.error().message.c_str());
  return good ? 0 : 1;
}
