#include "random_graph.h"

#include <algorithm>

#include "fake_handle.h"

namespace alcove::framegraph {
namespace {

constexpr Access kReads[] = {access::sampled_compute, access::storage_read_compute,
                             access::sampled_fragment, access::transfer_source,
                             access::sampled_general(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT)};
constexpr Access kWrites[] = {access::storage_write_compute, access::storage_read_write_compute,
                              access::color_attachment, access::transfer_destination,
                              access::clear};
constexpr Access kBufferReads[] = {buffer_access::storage_read_compute,
                                   buffer_access::uniform(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT),
                                   buffer_access::vertex_buffer,
                                   buffer_access::transfer_source,
                                   buffer_access::indirect,
                                   buffer_access::uniform(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT)};
constexpr Access kBufferWrites[] = {buffer_access::storage_write_compute,
                                    buffer_access::storage_read_write_compute,
                                    buffer_access::transfer_destination, buffer_access::fill};

// Returns an index into a table of accesses, chosen at random from the list of indices that the
// class of the queue supports.
std::uint32_t pick(Dice& dice, QueueClass queue, std::initializer_list<std::uint32_t> graphics,
                   std::initializer_list<std::uint32_t> compute,
                   std::initializer_list<std::uint32_t> transfer) {
  const auto& list = queue == QueueClass::graphics  ? graphics
                     : queue == QueueClass::compute ? compute
                                                    : transfer;
  return *(list.begin() + dice.roll(static_cast<std::uint32_t>(list.size())));
}

std::string numbered(char letter, std::size_t number) {
  return std::string(1, letter).append(std::to_string(number));
}

struct Resource {
  bool texture = true;
  Texture handle;
  Buffer buffer;
  std::uint32_t mips = 1;
  std::uint32_t layers = 1;
  std::vector<bool> written;  // for each subresource
  bool old = false;           // an older history slot
  std::uint32_t last_pass = kNone;

  bool has(bool value) const {
    return std::find(written.begin(), written.end(), value) != written.end();
  }
  Range one(std::uint32_t sub) const {
    return {static_cast<std::uint16_t>(sub % mips), 1, static_cast<std::uint16_t>(sub / mips), 1};
  }
};

class Declarer {
 public:
  Declarer(Graph& graph, Dice& dice, const RandomOptions& options)
      : graph_(graph), dice_(dice), options_(options) {}

  void run() {
    const std::uint32_t passes = 1 + dice_.roll(options_.most_passes);
    if (options_.imports && dice_.chance(160)) add_import();
    if (options_.imports && dice_.chance(90)) add_import();
    if (options_.histories && dice_.chance(100)) add_history();
    for (std::uint32_t i = 0; i < passes; ++i) add_pass(i);
    for (Resource& resource : resources_) {
      if (resource.old || resource.has(false) || !dice_.chance(90)) continue;
      if (resource.texture)
        graph_.output(resource.handle);
      else
        graph_.output(resource.buffer);
    }
  }

 private:
  // Returns an extent whose sides are at least `least`.
  Extent extent(std::uint32_t least = 1) {
    const std::uint32_t height = least + dice_.roll(options_.most_side);
    return Extent::absolute(least + dice_.roll(options_.most_side), height);
  }

  TextureDesc texture_desc() {
    TextureDesc desc;
    constexpr VkFormat kFormats[] = {VK_FORMAT_R8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
                                     VK_FORMAT_R32_SFLOAT, VK_FORMAT_R8G8B8A8_UNORM};
    desc.format = kFormats[dice_.roll(4)];
    desc.extent = extent();
    if (dice_.chance(60)) {
      desc.extent = extent(17);
      desc.mips = 1 + dice_.roll(4);
    }
    if (dice_.chance(30)) desc.layers = 1 + dice_.roll(3);
    if (options_.mistakes && dice_.chance(6)) desc.extent.width = dice_.roll(2) * 70000;
    if (options_.mistakes && dice_.chance(6)) desc.mips = dice_.roll(40);
    return desc;
  }

  void keep(Resource resource, bool full) {
    resource.written.assign(std::size_t{resource.mips} * resource.layers, full);
    resources_.push_back(std::move(resource));
  }

  void add_transient() {
    Resource resource;
    resource.texture = !dice_.chance(70) || !options_.transient_buffers;
    if (resource.texture) {
      const TextureDesc desc = texture_desc();
      resource.mips = std::clamp(desc.mips, 1u, 64u);
      resource.layers = desc.layers;
      resource.handle = graph_.create_texture(numbered('t', resources_.size()), desc);
    } else {
      resource.buffer = graph_.create_buffer(numbered('b', resources_.size()),
                                             {VkDeviceSize{4} * (1 + dice_.roll(5000))});
    }
    keep(std::move(resource), false);
  }

  // Returns a state that reads or writes in some stages, in the layout of a texture or for a
  // buffer.
  State any_state(bool texture) {
    constexpr VkPipelineStageFlags2 kStages[] = {
        VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COPY_BIT};
    const VkPipelineStageFlags2 stages = kStages[dice_.roll(5)];
    const bool copies = stages == VK_PIPELINE_STAGE_2_COPY_BIT;
    const bool all = stages == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    const VkAccessFlags2 reads = copies                     ? VK_ACCESS_2_TRANSFER_READ_BIT
                                 : all && dice_.chance(128) ? VK_ACCESS_2_MEMORY_READ_BIT
                                                            : VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    const VkAccessFlags2 writes =
        copies ? VK_ACCESS_2_TRANSFER_WRITE_BIT : VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    const std::uint32_t kind = dice_.roll(4);
    constexpr VkImageLayout kLayouts[] = {VK_IMAGE_LAYOUT_GENERAL,
                                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    return {stages,
            kind == 0   ? writes
            : kind == 1 ? reads | writes
                        : reads,
            texture ? kLayouts[dice_.roll(3)] : VK_IMAGE_LAYOUT_UNDEFINED};
  }

  template <typename Import>
  void set_any_states(Import& import, bool full, bool departs, bool texture) {
    if (full) import.initial_state = any_state(texture);
    if (departs) import.final_state = any_state(texture);
  }

  void add_import() {
    const bool full = dice_.chance(128);
    const bool departs = dice_.chance(140);
    Resource resource;
    resource.texture = dice_.chance(160);
    if (resource.texture) {
      ImportedTexture import;
      import.image = fake_handle<VkImage>(resources_.size());
      import.desc = {VK_FORMAT_R8G8B8A8_UNORM, extent(), 1, 1, VK_SAMPLE_COUNT_1_BIT};
      import.usage = ~VkImageUsageFlags{0};
      if (full)
        import.initial_state =
            dice_.chance(128)
                ? State{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}
                : State{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                        dice_.chance(128) ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT : VkAccessFlags2{0},
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      if (departs)
        import.final_state = {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                              VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      if (options_.any_states) set_any_states(import, full, departs, true);
      resource.handle = graph_.import_texture(numbered('i', resources_.size()), import);
    } else {
      ImportedBuffer import;
      import.buffer = fake_handle<VkBuffer>(resources_.size());
      import.desc.size = 1024;
      import.usage = ~VkBufferUsageFlags{0};
      import.has_contents = full;
      if (full)
        import.initial_state = {
            VK_PIPELINE_STAGE_2_COPY_BIT,
            dice_.chance(128) ? VK_ACCESS_2_TRANSFER_WRITE_BIT : VK_ACCESS_2_TRANSFER_READ_BIT,
            VK_IMAGE_LAYOUT_UNDEFINED};
      if (departs) import.final_state = buffer_access::host_read;
      if (options_.any_states) set_any_states(import, full, departs, false);
      resource.buffer = graph_.import_buffer(numbered('i', resources_.size()), import);
    }
    keep(std::move(resource), full);
  }

  void add_history() {
    // All histories have one size, so that the next frame can use what this one leaves.
    TextureDesc desc{VK_FORMAT_R32_SFLOAT, Extent::absolute(16, 16), 1 + dice_.roll(2)};
    const TextureHistory history = graph_.create_texture_history("h", desc, 2 + dice_.roll(2));
    Resource current;
    current.mips = desc.mips;
    current.handle = history.current;
    keep(current, false);
    Resource previous;
    previous.handle = history.previous(1);
    previous.mips = desc.mips;
    previous.old = true;
    history_ = resources_.size();
    keep(previous, history.validity == HistoryValidity::valid);
  }

  void add_pass(std::uint32_t index) {
    QueueClass queue = QueueClass::graphics;
    if (options_.queues) queue = static_cast<QueueClass>(dice_.roll(3));
    PassBuilder pass = graph_.add_pass(numbered('p', index), queue);
    pass.record([](RecordContext&) {});
    const std::uint32_t reads = dice_.roll(4);
    for (std::uint32_t i = 0; i < reads && !resources_.empty(); ++i) read(pass, index, queue);
    const std::uint32_t writes = 1 + dice_.roll(3);
    for (std::uint32_t i = 0; i < writes; ++i) write(pass, index, queue);
    if (dice_.chance(options_.side_effects)) pass.side_effect();
  }

  // Returns the index of a resource resource: in half of the cases one of the last few, otherwise
  // any.
  std::size_t choose() {
    const auto count = static_cast<std::uint32_t>(resources_.size());
    const std::uint32_t window = dice_.chance(128) ? std::min(count, 4u) : count;
    return count - 1 - dice_.roll(window);
  }

  void read(PassBuilder& pass, std::uint32_t index, QueueClass queue) {
    const std::size_t chosen = choose();
    Resource& resource = resources_[chosen];
    if (resource.last_pass == index) return;
    const bool old = resource.old;
    // A frame may read a history that has no contents yet only if it also writes the history. This
    // read of the older slot must then come after the write.
    if (old && !resource.written[0] && !resources_[history_ - 1].written[0]) return;
    Range range;
    if (!old && (resource.has(false) || (resource.written.size() > 1 && dice_.chance(100)))) {
      const auto start = dice_.roll(static_cast<std::uint32_t>(resource.written.size()));
      if (!resource.written[start]) return;
      range = resource.one(start);
    }
    resource.last_pass = index;
    if (options_.mistakes && dice_.chance(4)) range.base_mip = 40;
    if (resource.texture) {
      Texture handle = resource.handle;
      if (options_.mistakes && dice_.chance(4)) handle.version += 1;
      if (options_.mistakes && dice_.chance(4)) handle.graph += 1;
      pass.read(handle, kReads[pick(dice_, queue, {0, 1, 2, 3, 4}, {0, 1, 3, 4}, {3})], range);
    } else {
      pass.read(resource.buffer,
                kBufferReads[pick(dice_, queue, {0, 1, 2, 3, 4, 5}, {0, 3, 4, 5}, {3})]);
    }
  }

  void write(PassBuilder& pass, std::uint32_t index, QueueClass queue) {
    if (resources_.empty() || dice_.chance(150)) add_transient();
    const std::size_t chosen = choose();
    Resource& resource = resources_[chosen];
    // An older slot is updated in place.
    if ((resource.old && !resource.written[0]) || resource.last_pass == index) return;
    resource.last_pass = index;
    const bool had_any = resource.has(true);
    Contents contents = !resource.old && dice_.chance(80) ? Contents::discard : Contents::keep;
    if (!resource.texture) {
      std::uint32_t way = pick(dice_, queue, {0, 1, 2, 3}, {0, 1, 2, 3}, {2});
      // A read-modify-write needs contents.
      if (way == 1 && !resource.written[0] && contents != Contents::discard) way = 0;
      if (!had_any) contents = Contents::discard;
      resource.buffer = pass.write(resource.buffer, kBufferWrites[way], contents);
      resource.written[0] = true;
      return;
    }
    Range range;
    bool had_contents = true;
    bool had_any_in_range = had_any;
    if (resource.written.size() > 1 && dice_.chance(150)) {
      const auto start = dice_.roll(static_cast<std::uint32_t>(resource.written.size()));
      range = resource.one(start);
      had_any_in_range = had_contents = resource.written[start];
      resource.written[start] = true;
    } else {
      had_contents = !resource.has(false);
      resource.written.assign(resource.written.size(), true);
    }
    std::uint32_t way = pick(dice_, queue, {0, 1, 2, 3, 4}, {0, 1, 3, 4}, {3});
    // A second attachment in the same pass is avoided, because attachments must have the same size.
    if (way == 2 && drawn_in_ == index) way = 4;
    if (way == 2) drawn_in_ = index;
    if (way == 1 && !had_contents && contents != Contents::discard) way = 0;
    // A write that is no attachment keeps contents only if there are some.
    if (way != 2 && !had_any_in_range) contents = Contents::discard;
    resource.handle = pass.write(resource.handle, kWrites[way], range, contents);
  }

  Graph& graph_;
  Dice& dice_;
  const RandomOptions& options_;
  std::vector<Resource> resources_;
  std::size_t history_ = 0;
  std::uint32_t drawn_in_ = kNone;  // the last pass with an attachment
};

}  // namespace

void declare_random(Graph& graph, Dice& dice, const RandomOptions& options) {
  Declarer(graph, dice, options).run();
}

void declare_sizes(Graph& graph, Dice& dice, std::uint32_t passes, std::uint32_t width) {
  std::vector<Texture> textures;
  for (std::uint32_t i = 0; i < passes; ++i) {
    PassBuilder pass = graph.add_pass("pass");
    pass.side_effect();
    Texture used[3];
    for (std::uint32_t reads = dice.roll(4); reads > 0 && !textures.empty(); --reads) {
      const auto count = static_cast<std::uint32_t>(textures.size());
      const std::uint32_t window = std::min(count, dice.chance(128) ? 4u : 16u);
      const Texture from = textures[count - 1 - dice.roll(window)];
      if (std::find(std::begin(used), std::end(used), from) != std::end(used)) continue;
      used[reads - 1] = from;
      pass.read(from, access::sampled_compute);
    }
    const std::uint32_t writes = 1 + dice.roll(2);
    for (std::uint32_t w = 0; w < writes; ++w) {
      const std::uint32_t height =
          1 + dice.roll(1080);  // separately: the order of arguments is unspecified
      Extent extent = Extent::absolute(1 + dice.roll(2048), height);
      if (i == passes / 2 && w == 0 && width != 0) extent.width = width;
      const Texture texture = graph.create_texture("texture", {VK_FORMAT_R8_UNORM, extent});
      textures.push_back(pass.write(texture, access::storage_write_compute, {}, Contents::discard));
    }
  }
}

}  // namespace alcove::framegraph
