#include "graph/graph_work.h"

#include "work/shader_table.h"

namespace alcove::passes {

using framegraph::Access;
using framegraph::Contents;
using framegraph::Graph;
using framegraph::Range;
using framegraph::RecordContext;
using framegraph::Texture;

namespace {

bool is_image(const AlcoveWorkBinding& binding) {
  return binding.type == ALCOVE_BINDING_TYPE_FETCHED_IMAGE ||
         binding.type == ALCOVE_BINDING_TYPE_STORAGE_IMAGE;
}

bool same_mips(const AlcoveWorkBinding& a, const AlcoveWorkBinding& b) {
  return a.resource == b.resource && a.mip == b.mip && a.mip_count == b.mip_count;
}

Access access_of(const AlcoveWorkBinding& binding) {
  if (binding.type != ALCOVE_BINDING_TYPE_STORAGE_IMAGE) return framegraph::access::sampled_compute;
  if (binding.access == ALCOVE_WORK_ACCESS_READ) return framegraph::access::storage_read_compute;
  return binding.access == ALCOVE_WORK_ACCESS_WRITE
             ? framegraph::access::storage_write_compute
             : framegraph::access::storage_read_write_compute;
}

Range range_of(const AlcoveWorkBinding& binding, const AlcoveWork& work) {
  if (binding.mip == 0 && binding.mip_count == work.resources[binding.resource].mip_count)
    return {};
  return {static_cast<std::uint16_t>(binding.mip), static_cast<std::uint16_t>(binding.mip_count)};
}

// Returns whether a pass that overwrites `texture` must keep its earlier contents: those of an
// import, of which the pass may write a part, as may earlier passes of the frame.
bool has_other_contents(const Graph& graph, Texture texture) {
  const framegraph::GraphDescription& declared = graph.description();
  if (texture.index >= declared.resources.size()) return false;
  const framegraph::ResourceRecord& record = declared.resources[texture.index];
  return record.origin == framegraph::Origin::imported &&
         (texture.version > 0 || declared.externals[record.external].has_contents != 0);
}

// The callback of a pass: one dispatch.
struct Dispatch {
  struct Image {
    Texture texture;
    Range range;
  };
  Kernels* kernels = nullptr;
  Kernel kernel;
  std::array<std::uint32_t, 3> groups{};
  std::uint32_t image_count = 0;
  std::uint32_t parameter_bytes = 0;
  std::array<Image, ALCOVE_MAX_WORK_BINDINGS> images;
  std::array<std::byte, ALCOVE_MAX_WORK_PARAMETER_BYTES> parameters;

  void operator()(RecordContext& context) const {
    std::array<VkImageView, ALCOVE_MAX_WORK_BINDINGS> views;
    for (std::uint32_t i = 0; i < image_count; ++i)
      views[i] = context.view(images[i].texture, images[i].range);
    kernels->dispatch(context, kernel, std::span<const VkImageView>(views).first(image_count),
                      std::span(parameters).first(parameter_bytes), groups);
  }
};

WorkFrame work_frame(const Frame& frame, Histories histories) {
  WorkFrame result{frame.view,          frame.index,        frame.previous_view,
                   frame.static_frames, frame.largest_size, frame.previous_size,
                   frame.areas};
  if (frame.prepare) {  // the previous frame is not read
    result.previous_view = frame.view;
    result.previous_size = {};
    result.static_frames = histories == Histories::unchanged ? 1 : 0;
  }
  if (histories == Histories::moving) {
    float& x = result.previous_view.view_from_world[12];
    x = x == 0.0f ? 1.0f : 0.0f;
  }
  return result;
}

}  // namespace

HistoryName::HistoryName(std::string_view view, HistoryRole role) {
  constexpr std::array<std::string_view, ALCOVE_MAX_WORK_HISTORIES> kSuffixes{
      "", " depth", " bent normal", " specular"};
  const std::string_view suffix = kSuffixes.at(static_cast<std::size_t>(role));
  text_.reserve(view.size() + suffix.size());
  text_.append(view).append(suffix);
}

GraphWork::GraphWork(const Frame& frame, std::string_view history_name, Histories histories)
    : frame_(frame),
      history_name_(history_name),
      histories_(histories),
      work_frame_(work_frame(frame, histories)),
      list_(work_) {
  list_.set_history_source({[](void* user, HistoryRole role, const WorkList::History& history) {
                              return static_cast<GraphWork*>(user)->declare_history(role, history);
                            },
                            this});
}

Texture GraphWork::import(Texture texture) {
  if (!texture) return {};
  for (std::uint32_t i = 0; i < work_.resource_count; ++i)
    if (textures_[i] == texture) return {i};
  const VkExtent3D size = frame_.graph.extent(texture);
  const auto& resources = frame_.graph.description().resources;
  const Texture listed =
      list_.add(ALCOVE_RESOURCE_KIND_INPUT, "texture", frame_.graph.format(texture),
                {size.width, size.height},
                texture.index < resources.size() ? resources[texture.index].mips : 1u,
                texture.index < resources.size() ? resources[texture.index].samples : 1u);
  if (listed) textures_[listed.index] = texture;
  return listed;
}

Texture GraphWork::texture(Texture listed) const {
  return listed ? textures_[listed.index] : Texture{};
}

bool GraphWork::declare_history(HistoryRole role, const WorkList::History& history) {
  declared_.at(static_cast<std::size_t>(role)) = true;
  if (histories_ != Histories::of_graph) return true;
  const VkExtent2D size = list_.size(history.current);
  const framegraph::TextureHistory made = frame_.graph.create_texture_history(
      HistoryName(history_name_, role),
      {list_.format(history.current), framegraph::Extent::absolute(size.width, size.height)});
  textures_[history.previous.index] = made.previous();
  textures_[history.current.index] = made.current;
  return made.validity == framegraph::HistoryValidity::valid;
}

tl::expected<void, Error> GraphWork::create_pipelines() {
  for (std::uint32_t i = 0; i < work_.dispatch_count; ++i) {
    const AlcoveWorkDispatch& dispatch = work_.dispatches[i];
    auto kernel = frame_.kernels.get(shader_of_name(dispatch.shader),
                                     std::span(dispatch.constants).first(dispatch.constant_count));
    if (!kernel) return tl::unexpected(std::move(kernel.error()));
    kernels_[i] = *kernel;
  }
  return {};
}

void GraphWork::add() {
  for (std::uint32_t i = 0; i < work_.resource_count; ++i) {
    const AlcoveWorkResource& resource = work_.resources[i];
    if (resource.kind == ALCOVE_RESOURCE_KIND_TRANSIENT) {
      textures_[i] = frame_.graph.create_texture(
          resource.name,
          {static_cast<VkFormat>(resource.format),
           framegraph::Extent::absolute(resource.width, resource.height), resource.mip_count});
    }
  }
  // A history that is not wanted in this frame will be out of date when it is wanted again.
  for (const HistoryRole role : kHistoryRoles)
    if (!history_name_.empty() && !declared_.at(static_cast<std::size_t>(role)))
      frame_.graph.reset_history(HistoryName(history_name_, role));
  for (std::uint32_t i = 0; i < work_.dispatch_count; ++i) add(work_.dispatches[i], kernels_[i]);
}

void GraphWork::add(const AlcoveWorkDispatch& dispatch, Kernel kernel) {
  auto pass = frame_.graph.add_pass(dispatch.label);
  declare_accesses(pass, dispatch);
  Dispatch callback;
  callback.kernels = &frame_.kernels;
  callback.kernel = kernel;
  std::ranges::copy(dispatch.groups, callback.groups.begin());
  for (const AlcoveWorkBinding& binding :
       std::span(dispatch.bindings).first(dispatch.binding_count)) {
    if (is_image(binding)) {
      callback.images[callback.image_count++] = {textures_[binding.resource],
                                                 range_of(binding, work_)};
    }
  }
  callback.parameter_bytes = dispatch.parameter_bytes;
  std::ranges::copy(std::as_bytes(std::span(dispatch.parameters).first(dispatch.parameter_bytes)),
                    callback.parameters.begin());
  pass.record(callback);
}

// Declares one access for each resource and range, which combines all bindings of it.
void GraphWork::declare_accesses(framegraph::PassBuilder& pass,
                                 const AlcoveWorkDispatch& dispatch) {
  const auto bindings = std::span(dispatch.bindings).first(dispatch.binding_count);
  for (auto binding = bindings.begin(); binding != bindings.end(); ++binding) {
    const auto is_same = [&](const AlcoveWorkBinding& other) { return same_mips(*binding, other); };
    if (!is_image(*binding) || std::any_of(bindings.begin(), binding, is_same)) continue;
    Access access = access_of(*binding);
    std::uint32_t ways = binding->access;
    for (auto other = binding + 1; other != bindings.end(); ++other) {
      if (is_same(*other)) {
        access = access | access_of(*other);
        ways |= other->access;
      }
    }
    Texture& texture = textures_[binding->resource];
    const Range range = range_of(*binding, work_);
    if ((ways & ALCOVE_WORK_ACCESS_WRITE) == 0) {
      pass.read(texture, access, range);
      continue;
    }
    const bool keeps =
        (ways & ALCOVE_WORK_ACCESS_READ) != 0 || has_other_contents(frame_.graph, texture);
    texture = pass.write(texture, access, range, keeps ? Contents::keep : Contents::discard);
  }
}

}  // namespace alcove::passes
