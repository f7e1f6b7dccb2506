// Tests random frames on the device. Their passes mix what they read into what they write; some
// passes write two textures and update one of them. The contents must be those that a simple model
// of the frame computes on the CPU. A history must be valid, and hold its contents, exactly if the
// model says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "alcove/framegraph/verify.h"
#include "checksum_kernels.h"
#include "gpu.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

// Returns the number of frames of each test: 400, or the value of ALCOVE_RANDOM_FRAMES, which the
// soak tests set.
std::uint32_t frame_count() {
  const char* const text = std::getenv("ALCOVE_RANDOM_FRAMES");
  return text == nullptr ? 400 : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}
constexpr VkDeviceSize kHostWords = 1 << 16;

// A resource and the words that it must hold.
struct ResourceModel {
  bool texture = true;
  Texture handle;
  Buffer buffer;
  std::uint32_t width = 1;  // of a buffer: its number of words
  std::uint32_t height = 1;
  std::vector<std::uint32_t> words;
  bool read_only = false;  // an older history slot
  struct HistoryModel* history = nullptr;
};

// Contents that the history must hold in the next frame, if it is valid then.
struct HistoryModel {
  bool valid = false;
  bool ran = false;  // the pass that writes it was recorded in this frame
  std::uint32_t side = 8;
  std::vector<std::uint32_t> words;
};

class FrameMaker {
 public:
  FrameMaker(Graph& graph, ChecksumKernels& kernels, const HostBuffer& host, HistoryModel& history,
             std::uint64_t seed)
      : graph_(graph), kernels_(kernels), host_(host), history_(history), dice_(seed) {}

  // Declares a frame, and sets `expected` to the contents that the host buffer must have after it.
  void declare() {
    graph_.reset();
    clear();
    fill();
    clear();
    declare_history(history_);
    const std::uint32_t passes = 4 + dice_.roll(20);
    for (std::uint32_t i = 0; i < passes; ++i) {
      switch (dice_.roll(10)) {
        case 0:
          clear();
          break;
        case 1:
          fill();
          break;
        case 2:
        case 3:
          mix_buffer();
          break;
        case 4:
        case 5:
          update_and_mix();
          break;
        default:
          mix_texture();
      }
    }
    Buffer out = graph_.import_buffer("host", Gpu::imported(host_));
    for (const ResourceModel& model : all_)
      if (dice_.chance(90)) out = copy_out(model, out);
    out = copy_out(all_.back(), out);
  }

  // Moves the model of the history on to the next frame, after this one has run.
  void finish() {
    for (const ResourceModel& model : all_) {
      if (model.history == nullptr || !model.history->ran) continue;
      model.history->valid = true;
      model.history->words = model.words;
    }
  }

  std::vector<std::uint32_t> expected;

 private:
  // Declares the history, whose validity must be that of the model. A pass may write it, and other
  // passes may read its older slot. It may be reset or change its size.
  void declare_history(HistoryModel& history) {
    history.ran = false;
    if (dice_.chance(20)) {
      history.valid = false;
      graph_.reset_history("history");
    }
    if (dice_.chance(20)) {
      const std::uint32_t side = 1 + dice_.roll(30);
      if (side != history.side) history.valid = false;
      history.side = side;
    }
    const TextureDesc desc{VK_FORMAT_R32_UINT, Extent::absolute(history.side, history.side)};
    const TextureHistory slots = graph_.create_texture_history("history", desc);
    EXPECT_EQ(slots.validity == HistoryValidity::valid, history.valid);
    ResourceModel model;
    model.width = model.height = history.side;
    model.words = history.words;
    model.words.resize(std::size_t{history.side} * history.side);
    if (history.valid && dice_.chance(200)) {
      model.read_only = true;
      model.handle = slots.previous();
      all_.push_back(model);
    }
    if (history.valid && dice_.chance(60)) return;
    const ResourceModel sampled = all_[dice_.roll(1)];
    const ResourceModel storage = all_[2];
    const std::uint32_t seed = any();
    model.read_only = false;
    model.history = &history;
    mix(model, seed, sampled, storage, false);
    PassBuilder pass = graph_.add_pass("write history", queue());
    pass.read(sampled.handle, access::sampled_compute);
    pass.read(storage.handle, access::storage_read_compute);
    model.handle = pass.write(slots.current, access::storage_write_compute, {}, Contents::discard);
    pass.record([=, this, &history, from = sampled.handle, and_from = storage.handle,
                 to = model.handle](RecordContext& c) {
      history.ran = true;
      kernels_.mix_texture(c, c.view(from), c.view(and_from), c.view(to), c.extent(to), seed,
                           false);
    });
    all_.push_back(std::move(model));
  }

  std::uint32_t any() { return static_cast<std::uint32_t>(dice_.roll(1u << 30)); }
  ResourceModel* choose(bool texture) {
    std::vector<ResourceModel*> fitting;
    for (ResourceModel& model : all_)
      if (model.texture == texture) fitting.push_back(&model);
    const auto count = static_cast<std::uint32_t>(fitting.size());
    return fitting[count - 1 - dice_.roll(std::min(count, 5u))];
  }

  QueueClass queue() { return dice_.chance(128) ? QueueClass::compute : QueueClass::graphics; }

  ResourceModel new_texture() {
    ResourceModel model;
    model.width = 1 + dice_.roll(40);
    model.height = 1 + dice_.roll(40);
    model.handle = graph_.create_texture(
        "texture", {VK_FORMAT_R32_UINT, Extent::absolute(model.width, model.height)});
    model.words.resize(std::size_t{model.width} * model.height);
    return model;
  }

  ResourceModel new_buffer() {
    ResourceModel model;
    model.texture = false;
    model.width = 1 + dice_.roll(2000);
    model.buffer = graph_.create_buffer("buffer", {4 * VkDeviceSize{model.width}});
    model.words.resize(model.width);
    return model;
  }

  void clear() {
    ResourceModel model = new_texture();
    const std::uint32_t value = any();
    std::fill(model.words.begin(), model.words.end(), value);
    PassBuilder pass = graph_.add_pass("clear");
    model.handle = pass.write(model.handle, access::clear, {}, Contents::discard);
    pass.record([handle = model.handle, value](RecordContext& c) {
      clear_image(c, c.image(handle), value);
    });
    all_.push_back(std::move(model));
  }

  void fill() {
    ResourceModel model = new_buffer();
    const std::uint32_t value = any();
    std::fill(model.words.begin(), model.words.end(), value);
    PassBuilder pass = graph_.add_pass("fill");
    model.buffer = pass.write(model.buffer, buffer_access::fill, Contents::discard);
    pass.record([handle = model.buffer, value](RecordContext& c) {
      vkCmdFillBuffer(c.commands, c.buffer(handle), 0, VK_WHOLE_SIZE, value);
    });
    all_.push_back(std::move(model));
  }

  // Mixes two textures into a new texture, or into an existing one whose contents are then part of
  // the result.
  void mix_texture() {
    const ResourceModel sampled = *choose(true);
    const ResourceModel storage = *choose(true);
    const bool keep = dice_.chance(100);
    ResourceModel result = keep ? *choose(true) : new_texture();
    if (sampled.handle == storage.handle || result.handle == sampled.handle ||
        result.handle == storage.handle || result.read_only)
      return;
    const std::uint32_t seed = any();
    mix(result, seed, sampled, storage, keep);
    PassBuilder pass = graph_.add_pass("mix texture", queue());
    pass.read(sampled.handle, access::sampled_compute);
    pass.read(storage.handle, access::storage_read_compute);
    const Texture before = result.handle;
    result.handle = pass.write(
        before, keep ? access::storage_read_write_compute : access::storage_write_compute, {},
        keep ? Contents::keep : Contents::discard);
    pass.record([=, this, from = sampled.handle, and_from = storage.handle,
                 to = result.handle](RecordContext& c) {
      kernels_.mix_texture(c, c.view(from), c.view(and_from), c.view(to), c.extent(to), seed, keep);
    });
    replace(std::move(result), before.index);
  }

  // Adds a pass with two outputs: a new texture model from the contents of an old one, and the
  // updated old one. A reader of the new texture alone still needs the contents of the old one.
  void update_and_mix() {
    const ResourceModel sampled = *choose(true);
    const ResourceModel storage = *choose(true);
    ResourceModel updated = *choose(true);
    if (sampled.handle == storage.handle || updated.handle == sampled.handle ||
        updated.handle == storage.handle || updated.read_only)
      return;
    const std::uint32_t seed = any();
    ResourceModel model = new_texture();
    mix(model, seed, sampled, updated, false);
    mix(updated, ~seed, sampled, storage, true);
    PassBuilder pass = graph_.add_pass("update and mix", queue());
    pass.read(sampled.handle, access::sampled_compute);
    pass.read(storage.handle, access::storage_read_compute);
    const std::uint32_t index = updated.handle.index;
    updated.handle = pass.write(updated.handle, access::storage_read_write_compute);
    model.handle = pass.write(model.handle, access::storage_write_compute, {}, Contents::discard);
    pass.record([=, this, from = sampled.handle, and_from = storage.handle, old = updated.handle,
                 to = model.handle](RecordContext& c) {
      kernels_.mix_texture(c, c.view(from), c.view(old), c.view(to), c.extent(to), seed, false);
      order(c, access::storage_read_write_compute);
      kernels_.mix_texture(c, c.view(from), c.view(and_from), c.view(old), c.extent(old), ~seed,
                           true);
    });
    replace(std::move(updated), index);
    all_.push_back(std::move(model));
  }

  // Computes the result of the kernel that mixes textures.
  static void mix(ResourceModel& result, std::uint32_t seed, const ResourceModel& sampled,
                  const ResourceModel& storage, bool keep) {
    for (std::uint32_t y = 0; y < result.height; ++y) {
      for (std::uint32_t x = 0; x < result.width; ++x) {
        std::uint32_t& word = result.words[y * result.width + x];
        std::uint32_t value = mix_in(seed, y * result.width + x);
        value = mix_in(value, at(sampled, x, y));
        value = mix_in(value, at(storage, x, y));
        word = keep ? mix_in(value, word) : value;
      }
    }
  }

  void mix_buffer() {
    const ResourceModel sampled = *choose(true);
    const ResourceModel from = *choose(false);
    const bool keep = dice_.chance(100);
    ResourceModel result = keep ? *choose(false) : new_buffer();
    if (result.buffer == from.buffer) return;
    const std::uint32_t seed = any();
    for (std::uint32_t i = 0; i < result.width; ++i) {
      std::uint32_t value = mix_in(seed, i);
      value = mix_in(value, at(sampled, i % sampled.width, i / sampled.width));
      value = mix_in(value, from.words[i % from.width]);
      result.words[i] = keep ? mix_in(value, result.words[i]) : value;
    }
    PassBuilder pass = graph_.add_pass("mix buffer", queue());
    pass.read(sampled.handle, access::sampled_compute);
    pass.read(from.buffer, buffer_access::storage_read_compute);
    const Buffer before = result.buffer;
    result.buffer = pass.write(
        before,
        keep ? buffer_access::storage_read_write_compute : buffer_access::storage_write_compute,
        keep ? Contents::keep : Contents::discard);
    pass.record([=, this, texture = sampled.handle, words = result.width, in = from.buffer,
                 to = result.buffer](RecordContext& c) {
      kernels_.mix_buffer(c, c.view(texture), c.buffer(in), c.buffer(to), words, seed, keep);
    });
    replace(std::move(result), before.index);
  }

  static std::uint32_t at(const ResourceModel& m, std::uint32_t x, std::uint32_t y) {
    return m.words[(y % m.height) * m.width + x % m.width];
  }

  void replace(ResourceModel model, std::uint32_t index) {
    for (ResourceModel& there : all_) {
      const std::uint32_t its = there.texture ? there.handle.index : there.buffer.index;
      if (its != index) continue;
      there = std::move(model);
      return;
    }
    all_.push_back(std::move(model));
  }

  Buffer copy_out(const ResourceModel& model, Buffer out) {
    const VkDeviceSize offset = 4 * expected.size();
    if (expected.size() + model.words.size() > kHostWords) return out;
    expected.insert(expected.end(), model.words.begin(), model.words.end());
    PassBuilder pass =
        graph_.add_pass("copy out", dice_.chance(60) ? QueueClass::transfer : QueueClass::graphics);
    if (model.texture)
      pass.read(model.handle, access::transfer_source);
    else
      pass.read(model.buffer, buffer_access::transfer_source);
    out = pass.write(out, buffer_access::transfer_destination,
                     out.version == 0 ? Contents::discard : Contents::keep);
    pass.record([offset, out, texture = model.texture, image = model.handle,
                 buffer = model.buffer](RecordContext& c) {
      if (!texture) {
        const VkBufferCopy copy{0, offset, c.size(buffer)};
        vkCmdCopyBuffer(c.commands, c.buffer(buffer), c.buffer(out), 1, &copy);
        return;
      }
      copy_image(c, c.image(image), c.buffer(out), offset, c.extent(image));
    });
    return out;
  }

  Graph& graph_;
  ChecksumKernels& kernels_;
  const HostBuffer& host_;
  HistoryModel& history_;
  Dice dice_;
  std::vector<ResourceModel> all_;
};

// Returns the messages of the validation layers, without those that are known to be false in
// version 1.3.239. That version does not follow timeline semaphores from one queue to another. If a
// layout change and the write that it waits for are in different command buffers, it also reports a
// hazard unless the barrier waits for the write directly and not by way of another barrier. The
// same barriers in one command buffer give no message.
std::string messages(const Gpu& gpu, std::uint32_t queues) {
  if (queues > 1) return gpu.messages({"vkQueueSubmit2: Hazard"});
  return gpu.messages({"Recorded access info (recorded_usage: SYNC_IMAGE_LAYOUT_TRANSITION"});
}

// Submits random frames. One queue serves all queue classes: submissions and semaphores are the
// same as with several queues.
void expect_contents(std::uint32_t queues, std::uint64_t seed) {
  Gpu gpu;
  ASSERT_EQ(gpu.problem(), "");
  {
    DeviceHandles handles = gpu.handles();
    for (std::uint32_t queue = 1; queue < queues; ++queue)
      handles.queues[queue] = handles.queues[0];
    auto executor = Executor::create(handles, {.verify = verify, .check_uses = true});
    ASSERT_TRUE(executor) << to_string(executor.error());
    ChecksumKernels kernels(gpu);
    const HostBuffer host = gpu.make_host_buffer(4 * kHostWords);
    Graph graph;
    HistoryModel history;
    VkDeviceSize saved = 0;
    const std::uint32_t frames = frame_count();
    for (std::uint32_t i = 0; i < frames; ++i) {
      SCOPED_TRACE("seed " + std::to_string(seed + i));
      kernels.reset();
      FrameMaker maker(graph, kernels, host, history, seed + i);
      maker.declare();
      const auto report = executor->submit(graph);
      ASSERT_TRUE(report) << to_string(report.error());
      ASSERT_TRUE(executor->wait());
      ASSERT_EQ(std::memcmp(host.words, maker.expected.data(), 4 * maker.expected.size()), 0);
      maker.finish();
      if (queues == 1) {
        ASSERT_EQ(messages(gpu, queues), "") << print_text(graph.description(), *report->plan);
      }
      saved += report->memory.unaliased - report->memory.aliased;
      // The validation layer does not follow timeline semaphores and keeps the accesses of all
      // frames until the device is idle, so that each frame would take longer than the one before.
      if (i % 16 == 15) vkDeviceWaitIdle(gpu.device().device());
      if (i % 1000 == 999) std::cerr << i + 1 << " frames\n";
    }
    EXPECT_GT(saved, 0u) << "transients share no memory";
  }
  EXPECT_EQ(messages(gpu, queues), "");
}

TEST(Contents, RandomFramesOnOneQueueGiveTheContentsOfACpuModel) { expect_contents(1, 2000); }
TEST(Contents, RandomFramesOverTwoQueueClassesGiveTheContentsOfACpuModel) {
  expect_contents(2, 4000);
}
TEST(Contents, RandomFramesOverThreeQueueClassesGiveTheContentsOfACpuModel) {
  expect_contents(3, 3000);
}

}  // namespace
}  // namespace alcove::framegraph
