// The render graph: declares a frame with its resources, its passes, their reads and writes, and
// the frame's outputs.
//
//   Graph graph;
//   Texture depth = graph.import_texture("depth", engine_depth);
//   Texture ao = graph.create_texture("ao", {VK_FORMAT_R8_UNORM, {width, height}});
//   PassBuilder pass = graph.add_pass("gtao", QueueClass::compute);
//   pass.read(depth, access::depth_read_compute);
//   ao = pass.write(ao, access::storage_write_compute);
//   pass.record([=](RecordContext& context) { ... context.view(ao) ... });
//   graph.output(ao);
//
// Declaring never fails. Errors of the declaration are kept, and compiling returns all of them. The
// order of declaration is the program order: a pass reads what earlier passes wrote. Only one
// thread may declare. A graph may be used with one executor only; an executor may run several
// graphs. The memory of a graph's histories is freed some frames after the graph is destroyed. From
// the second reset() on, declaring a frame that equals the previous one allocates nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "alcove/framegraph/access.h"
#include "alcove/framegraph/description.h"
#include "alcove/framegraph/error.h"
#include "alcove/framegraph/history.h"
#include "alcove/framegraph/plan.h"
#include "alcove/framegraph/record_context.h"
#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

class Graph;

// One pass while it is declared: from add_pass to the next add_pass.
class PassBuilder {
 public:
  // Declares that the pass reads the version of the texture or buffer that the handle stands for.
  // It may read one texture in several ranges. To read and write the same subresource, declare a
  // single write whose access also reads.
  void read(Texture texture, const Access& access, Range range = {});
  void read(Buffer buffer, const Access& access);

  // Declares that the pass writes the texture or buffer. Returns the handle of the next version;
  // the given handle becomes invalid.
  [[nodiscard]] Texture write(Texture texture, const Access& access, Range range = {},
                              Contents contents = Contents::keep);
  [[nodiscard]] Buffer write(Buffer buffer, const Access& access,
                             Contents contents = Contents::keep);

  // Marks the pass as one with effects outside the graph. It is never culled.
  void side_effect();

  // Sets the callback that records the pass's commands. It is called with a RecordContext& once in
  // each frame in which the pass is not culled. The callable is moved into the graph's own memory
  // and lives until reset(). It must not throw if the library is built without exceptions.
  // Otherwise an exception propagates out of Executor::record or submit, and the frame counts as
  // failed.
  template <typename Callable>
  void record(Callable&& callable);

  std::uint32_t index() const { return pass_; }

 private:
  friend class Graph;
  PassBuilder(Graph& graph, std::uint32_t pass, std::uint32_t tag)
      : graph_(graph), pass_(pass), tag_(tag) {}
  // Returns whether the frame to which this builder belongs is still being declared. If it is not,
  // because reset() was called, adds an error to the new frame.
  bool is_current() const;

  Graph& graph_;
  std::uint32_t pass_;
  std::uint32_t tag_;  // Graph::tag_ of the frame
};

// A texture that keeps contents from frame to frame. `current` is written in this frame.
// previous(k) is what was `current` k frames ago; frames in which no pass wrote `current` do not
// count. A frame that changes only a part of the contents may write previous() with Contents::keep
// instead of `current`, which updates the older slot in place.
struct TextureHistory {
  Texture current;
  std::uint32_t slots = 0;
  HistoryValidity validity = HistoryValidity::first_frame;  // of previous(1)
  // Returns the slot of that age. The graph reports an error if age is 0 or not below `slots`.
  Texture previous(std::uint32_t age = 1) const {
    if (age == 0 || age >= slots) return {};
    return {current.index + age, 0, current.graph};
  }
};

// The caller's Vulkan handles for one frame. They are not part of the plan.
struct ImportHandles {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  std::uint32_t history = kNone;  // for a history slot: index into the graph's histories
  std::uint32_t layer = 0;        // the layer of the image that is the texture's first
  std::uint32_t layers = 1;       // number of layers of the texture
  std::uint32_t next = kNone;     // the next import with a handle of the same hash
};

class Graph {
 public:
  Graph();
  ~Graph();
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  // Create or import textures and buffers. Created ones are transient: the executor provides memory
  // for them during the frame if a pass that is not culled uses them. Imported ones belong to the
  // caller. Names are copied. They need not be unique, except those of histories.
  Texture create_texture(std::string_view name, const TextureDesc& desc);
  Buffer create_buffer(std::string_view name, const BufferDesc& desc);
  Texture import_texture(std::string_view name, const ImportedTexture& import);
  Buffer import_buffer(std::string_view name, const ImportedBuffer& import);
  // Creates a history, or finds the one with this name from the previous frames. `slots`, 2 to 8,
  // includes the slot of the current frame: 2 keeps the contents of one earlier frame.
  TextureHistory create_texture_history(std::string_view name, const TextureDesc& desc,
                                        std::uint32_t slots = 2);
  // Discards the contents of the named history, or of all histories, when they are next declared.
  void reset_history(std::string_view name);
  void reset_histories();
  // Forgets the named history, unless this frame declared it. The executor frees its memory in one
  // of the next frames, after the device has finished with it.
  void drop_history(std::string_view name);

  PassBuilder add_pass(std::string_view name, QueueClass queue = QueueClass::graphics);

  // Returns the handle of the latest version of a texture of this frame.
  Texture latest(Texture texture) const {
    texture.version = texture.index < versions_.size() ? versions_[texture.index] : texture.version;
    return texture;
  }

  // Marks this version as an output of the frame, so that the passes that produce it are not
  // culled. The contents of a transient can be read after the frame, until the next frame reuses
  // its memory.
  template <ResourceKind kKind>
  void output(Handle<kKind> handle) {
    add_output(handle.index, handle.version, handle.graph);
  }

  // Forgets the declared frame. Keeps allocated memory and histories.
  void reset();

  // Returns the absolute extent of mip 0, as known at declaration.
  VkExtent3D extent(Texture texture) const;
  VkFormat format(Texture texture) const;

  const GraphDescription& description() const { return description_; }
  bool has_callback(std::uint32_t pass) const { return callbacks_[pass].call != nullptr; }
  // Returns the error of a pass that runs and has no callback.
  Error missing_callback(std::uint32_t pass) const;

  // Functions for callers that compile a frame without an executor, or that declare a frame and do
  // not record it. histories() returns the state of the histories. leave_histories() advances that
  // state as if a frame that ends in these final states had run.
  HistoryTable& histories() { return histories_; }
  const HistoryTable& histories() const { return histories_; }
  void leave_histories(std::span<const FinalState> finals);

 private:
  friend class PassBuilder;
  // Execution reads imports_ and callbacks_.
  friend class Executor;
  friend class RecordContext;
  friend class Recorder;
  static constexpr std::size_t kAlignment = alignof(std::max_align_t);
  struct Callback {
    void (*call)(void*, RecordContext&) = nullptr;
    void* object = nullptr;
  };
  struct Cleanup {
    void (*destroy)(void*) = nullptr;
    void* object = nullptr;
  };
  struct Block {
    std::unique_ptr<std::byte[]> bytes;
    std::size_t size = 0;
  };

  // Appends a record of the declaration. If it differs from the record at the same place in the
  // previous frame, the frame is no repetition of that frame.
  template <typename Record>
  void add(Records<Record>& records, const Record& record) {
    if (records.add(record)) change();
  }
  void change() {
    description_.edition = frame_;
    repeating_tag_ = 0;
  }
  std::string_view keep_name(std::string_view name);
  void grow_passes();
  std::uint32_t add_resource(std::string_view name, const ResourceRecord& record);
  static ResourceRecord texture_record(const TextureDesc& desc);
  static bool is_transient(const ResourceRecord& record, const TextureDesc& desc);
  static ResourceRecord buffer_record(const BufferDesc& desc);
  template <typename Import>
  std::uint32_t add_import(std::string_view name, const Import& import, ResourceRecord record,
                           ImportHandles handles, bool has_contents);
  std::uint32_t find_same(std::uint32_t import);
  static Range resolved_range(Range range, const ResourceRecord& resource);
  template <ResourceKind kKind>
  std::uint32_t add_access(PassBuilder pass, const Handle<kKind>& handle, const Access& access,
                           Range range, std::uint32_t flags);
  std::uint32_t add_any_access(PassBuilder pass, std::uint32_t index, std::uint32_t version,
                               std::uint32_t tag, const Access& access, Range range,
                               std::uint32_t flags);
  void add_output(std::uint32_t index, std::uint32_t version, std::uint32_t tag);
  bool lost_executor() const;
  void* allocate(std::size_t size, std::size_t alignment);
  void* allocate_in_next_block(std::size_t size, std::size_t alignment);
  void destroy_callables();
  static ExternalRecord external_of(const HistoryEntry& entry, std::uint32_t slot);
  void add_stale_builder();

  GraphDescription description_;
  // Arrays that run parallel to others may be longer than these, but never shorter.
  std::vector<std::uint32_t> versions_;  // of resources, at this point
  std::vector<Callback> callbacks_;      // of passes
  std::vector<ImportHandles> imports_;   // of externals
  std::vector<std::uint32_t> buckets_;   // first import of each hash of a handle
  std::vector<Cleanup> cleanups_;
  std::vector<Block> blocks_;
  std::size_t block_ = 0;      // index of the next block
  std::byte* next_ = nullptr;  // the free bytes of the current block: [next_, end_)
  std::byte* end_ = nullptr;
  std::uint64_t frame_ = 0;  // number of the frame, unique among all graphs
  std::uint32_t tag_ = 0;    // lower half of frame_; handles of this frame carry it
  // It is tag_ while all records so far equal those of the previous frame, and then 0.
  std::uint32_t repeating_tag_ = 0;
  HistoryTable histories_;
  std::weak_ptr<const char> executor_;  // Tells which executor the graph was last recorded by.
  bool recorded_ = false;               // the declared frame
};

}  // namespace alcove::framegraph

#include "alcove/framegraph/graph_inline.h"
