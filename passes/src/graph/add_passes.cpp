// The functions that add passes to a render graph: each adds what the description of its name
// lists.
#include "graph/add_view.h"
#include "graph/graph_work.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

// Calls `visit` with each texture of the inputs or the results of a pass.
template <typename Visit>
void for_each_texture(Texture& texture, const Visit& visit) {
  visit(texture);
}
template <typename Visit>
void for_each_texture(RawOcclusionTextures& of, const Visit& visit) {
  visit(of.raw_occlusion);
  visit(of.bent);
}
template <typename Visit>
void for_each_texture(Occlusion& of, const Visit& visit) {
  visit(of.visibility);
  visit(of.bent_normal);
  visit(of.specular);
}
template <typename Visit>
void for_each_texture(MultiBounceInputs& of, const Visit& visit) {
  for (Texture* texture : {&of.visibility, &of.albedo, &of.into}) visit(*texture);
}
template <typename Visit>
void for_each_texture(GtsoInputs& of, const Visit& visit) {
  for (Texture* texture :
       {&of.visibility, &of.bent_normal, &of.normals, &of.depth, &of.roughness, &of.into})
    visit(*texture);
}
template <typename Visit>
void for_each_texture(OcclusionInputs& of, const Visit& visit) {
  for (Texture* texture : {&of.depth_ndc, &of.normals, &of.motion, &of.roughness,
                           &of.back_depth_ndc, &of.second_depth_ndc, &of.mask})
    visit(*texture);
  for_each_texture(of.into, visit);
}
template <typename Visit>
void for_each_texture(GtaoInputs& of, const Visit& visit) {
  for_each_texture(static_cast<OcclusionInputs&>(of), visit);
  visit(of.receiver_depth_ndc);
}
template <typename Visit>
void for_each_texture(ReconstructInputs& of, const Visit& visit) {
  for_each_texture(static_cast<OcclusionInputs&>(of), visit);
  for_each_texture(of.raw_occlusion, visit);
}
template <typename Visit>
void for_each_texture(ViewInputs& of, const Visit& visit) {
  for_each_texture(of.occlusion, visit);
  visit(of.albedo);
  visit(of.multi_bounce);
}
template <typename Visit>
void for_each_texture(OcclusionOutputs& of, const Visit& visit) {
  for (Texture* texture :
       {&of.visibility, &of.bent_normal, &of.specular, &of.linear_depth, &of.normals})
    visit(*texture);
}
// Describes passes with `describe(list, frame, inputs)`, where the textures of `inputs` and of the
// result are handles of the list, and adds them to the graph. Returns the result with textures of
// the graph.
template <typename Inputs, typename Describe>
auto add_described(const Frame& frame, const Inputs& given, const Describe& describe,
                   std::string_view history_name = {}, Histories histories = Histories::of_graph)
    -> decltype(describe(std::declval<WorkList&>(), std::declval<const WorkFrame&>(), given)) {
  GraphWork work(frame, history_name, histories);
  Inputs inputs = given;
  for_each_texture(inputs, [&](Texture& texture) { texture = work.import(texture); });
  auto result = describe(work.list(), work.frame(), inputs);
  if (!result) return result;
  if (auto created = work.create_pipelines(); !created)
    return tl::unexpected(std::move(created.error()));
  if (histories == Histories::of_graph) {
    work.add();
    for_each_texture(*result, [&](Texture& texture) { texture = work.texture(texture); });
  }
  return result;
}

// Adds passes with a history. With Frame::prepare it also creates the pipelines of the
// frames that have a history.
template <typename Inputs, typename Describe>
auto add_with_history(const Frame& frame, const Inputs& inputs, const OcclusionSettings& settings,
                      std::string_view history_name, const Describe& describe) {
  if (frame.prepare && settings.history_frames > 0) {
    for (const Histories histories : {Histories::moving, Histories::unchanged})
      if (auto made = add_described(frame, inputs, describe, history_name, histories); !made)
        return made;
  }
  return add_described(frame, inputs, describe, history_name);
}

}  // namespace

tl::expected<Texture, Error> add_linear_depth(const Frame& frame, Texture depth_ndc) {
  return add_described(frame, depth_ndc, describe_linear_depth);
}

tl::expected<Texture, Error> add_normals(const Frame& frame, Texture depth) {
  return add_described(frame, depth, describe_normals);
}

tl::expected<RawOcclusionTextures, Error> add_gtao(const Frame& frame, const GtaoInputs& inputs,
                                                   const OcclusionSettings& settings) {
  return add_described(frame, inputs, [&](WorkList& list, const WorkFrame& of, const auto& listed) {
    return describe_gtao(list, of, listed, settings);
  });
}

tl::expected<Occlusion, Error> add_reconstruct(const Frame& frame, const ReconstructInputs& inputs,
                                               const OcclusionSettings& settings,
                                               std::string_view history_name) {
  return add_with_history(frame, inputs, settings, history_name,
                          [&](WorkList& list, const WorkFrame& of, const auto& listed) {
                            return describe_reconstruct(list, of, listed, settings);
                          });
}

tl::expected<Texture, Error> add_multi_bounce(const Frame& frame, const MultiBounceInputs& inputs,
                                              Precision precision) {
  return add_described(frame, inputs, [&](WorkList& list, const WorkFrame& of, const auto& listed) {
    return describe_multi_bounce(list, of, listed, precision);
  });
}

tl::expected<Texture, Error> add_gtso(const Frame& frame, const GtsoInputs& inputs,
                                      const OcclusionSettings& settings) {
  return add_described(frame, inputs, [&](WorkList& list, const WorkFrame& of, const auto& listed) {
    return describe_gtso(list, of, listed, settings);
  });
}

tl::expected<OcclusionOutputs, Error> add_occlusion(const Frame& frame,
                                                    const OcclusionInputs& inputs,
                                                    const OcclusionSettings& settings,
                                                    std::string_view history_name) {
  auto outputs = add_with_history(frame, inputs, settings, history_name,
                                  [&](WorkList& list, const WorkFrame& of, const auto& listed) {
                                    return describe_occlusion(list, of, listed, settings);
                                  });
  if (!outputs || outputs->normals ||
      frame.graph.description().resources[inputs.depth_ndc.index].samples > 1)
    return outputs;
  // For the caller. The graph culls these passes if nothing reads them.
  auto depth = outputs->linear_depth ? tl::expected<Texture, Error>(outputs->linear_depth)
                                     : add_linear_depth(frame, inputs.depth_ndc);
  auto normals = depth.and_then([&](Texture linear) { return add_normals(frame, linear); });
  if (!normals) return tl::unexpected(std::move(normals.error()));
  outputs->linear_depth = *depth;
  outputs->normals = *normals;
  return outputs;
}

tl::expected<OcclusionOutputs, Error> add_view(const Frame& frame, const ViewInputs& inputs,
                                               const OcclusionSettings& settings,
                                               std::string_view history_name) {
  return add_with_history(frame, inputs, settings, history_name,
                          [&](WorkList& list, const WorkFrame& of, const auto& listed) {
                            return describe_view(list, of, listed, settings);
                          });
}

void drop_reconstruct_history(framegraph::Graph& graph, std::string_view history_name) {
  for (const HistoryRole role : kHistoryRoles) graph.drop_history(HistoryName(history_name, role));
}

}  // namespace alcove::passes
