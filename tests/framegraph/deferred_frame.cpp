#include "deferred_frame.h"

#include <initializer_list>

#include "fake_handle.h"

namespace alcove::framegraph {
namespace {

class DeferredFrame {
 public:
  DeferredFrame(Graph& graph, std::uint32_t width, std::uint32_t height)
      : graph_(graph), width_(width), height_(height) {}

  void declare() {
    draw_geometry();
    sort_lights();
    const Texture ao = occlude();
    const Texture lit = light(ao);
    const Texture smooth =
        compute("antialiasing", VK_FORMAT_R16G16B16A16_SFLOAT, 1, {lit, motion_});
    const Texture bloom = bloom_of(smooth);
    const Texture mapped = compute("tonemap", VK_FORMAT_R8G8B8A8_UNORM, 1, {smooth, bloom});
    present(mapped);
  }

 private:
  Texture make(const char* name, VkFormat format, std::uint32_t divisor) {
    const auto side = [divisor](std::uint32_t size) { return (size + divisor - 1) / divisor; };
    return graph_.create_texture(name, {format, Extent::absolute(side(width_), side(height_))});
  }

  void draw_geometry() {
    depth_ = make("depth", VK_FORMAT_D32_SFLOAT, 1);
    albedo_ = make("albedo", VK_FORMAT_R8G8B8A8_UNORM, 1);
    normal_ = make("normal", VK_FORMAT_R16G16B16A16_SFLOAT, 1);
    emission_ = make("emission", VK_FORMAT_R16G16B16A16_SFLOAT, 1);
    motion_ = make("motion", VK_FORMAT_R16G16B16A16_SFLOAT, 1);
    PassBuilder pass = graph_.add_pass("g-buffer");
    depth_ = pass.write(depth_, access::depth_attachment);
    for (Texture* target : {&albedo_, &normal_, &emission_, &motion_})
      *target = pass.write(*target, access::color_attachment);
    pass.record([](RecordContext&) {});
  }

  // Adds the pass that writes one bit for each of 128 lights in each tile of 16x16 pixels.
  void sort_lights() {
    const VkDeviceSize tiles = VkDeviceSize{(width_ + 15) / 16} * ((height_ + 15) / 16);
    light_tiles_ = graph_.create_buffer("light tiles", {16 * tiles});
    PassBuilder pass = graph_.add_pass("light tiles");
    pass.read(depth_, access::depth_read_compute);
    light_tiles_ =
        pass.write(light_tiles_, buffer_access::storage_write_compute, Contents::discard);
    pass.record([](RecordContext&) {});
  }

  Texture light(Texture ao) {
    Texture lit = make("lighting", VK_FORMAT_R16G16B16A16_SFLOAT, 1);
    PassBuilder pass = graph_.add_pass("lighting");
    pass.read(depth_, access::depth_read_compute);
    pass.read(light_tiles_, buffer_access::storage_read_compute);
    for (const Texture& read : {albedo_, normal_, emission_, ao})
      pass.read(read, access::sampled_compute);
    lit = pass.write(lit, access::storage_write_compute, {}, Contents::discard);
    pass.record([](RecordContext&) {});
    return lit;
  }

  Texture compute(const char* name, VkFormat format, std::uint32_t divisor,
                  std::initializer_list<Texture> from) {
    Texture to = make(name, format, divisor);
    PassBuilder pass = graph_.add_pass(name);
    for (const Texture& read : from)
      pass.read(read, read == depth_ ? access::depth_read_compute : access::sampled_compute);
    to = pass.write(to, access::storage_write_compute, {}, Contents::discard);
    pass.record([](RecordContext&) {});
    return to;
  }

  Texture occlude() {
    const Texture half = compute("half depth", VK_FORMAT_R32_SFLOAT, 2, {depth_});
    const Texture ao = compute("occlusion", VK_FORMAT_R8_UNORM, 2, {half, normal_});
    const Texture across = compute("blur across", VK_FORMAT_R8_UNORM, 2, {ao, half});
    return compute("blur down", VK_FORMAT_R8_UNORM, 2, {across, half});
  }

  Texture bloom_of(Texture from) {
    constexpr VkFormat kFormat = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    Texture down[6];
    for (std::uint32_t mip = 1; mip <= 6; ++mip) {
      from = compute("bloom down", kFormat, 1u << mip, {from});
      down[mip - 1] = from;
    }
    Texture up = down[5];
    for (std::uint32_t mip = 5; mip >= 1; --mip)
      up = compute("bloom up", kFormat, 1u << mip, {up, down[mip - 1]});
    return up;
  }

  void present(Texture from) {
    const Texture back_buffer = graph_.import_texture(
        "back buffer", {.image = fake_handle<VkImage>(),
                        .desc = {VK_FORMAT_R8G8B8A8_UNORM, Extent::absolute(width_, height_)},
                        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                        .final_state = access::present});
    PassBuilder pass = graph_.add_pass("present");
    pass.read(from, access::transfer_source);
    (void)pass.write(back_buffer, access::transfer_destination, {}, Contents::discard);
    pass.record([](RecordContext&) {});
  }

  Graph& graph_;
  std::uint32_t width_;
  std::uint32_t height_;
  Texture depth_, albedo_, normal_, emission_, motion_;
  Buffer light_tiles_;
};

// Rounds up to pages of 64 KiB.
MemoryRequirements paged_requirements(const void*, const ResourceRecord& record, VkFlags, bool) {
  constexpr VkDeviceSize kPage = 65536;
  const VkDeviceSize texel = record.format == VK_FORMAT_R8_UNORM              ? 1
                             : record.format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8
                                                                              : 4;
  MemoryRequirements needed{record.size + texel * record.width * record.height};
  needed.size = (needed.size + kPage - 1) / kPage * kPage;
  needed.alignment = kPage;
  return needed;
}

}  // namespace

void declare_deferred_frame(Graph& graph, std::uint32_t width, std::uint32_t height) {
  DeferredFrame(graph, width, height).declare();
}

tl::expected<Plan, Errors> compile_deferred_frame(Graph& graph, Limits& limits) {
  declare_deferred_frame(graph, 1920, 1080);
  limits.memory.query = paged_requirements;
  return compile(graph.description(), limits);
}

}  // namespace alcove::framegraph
