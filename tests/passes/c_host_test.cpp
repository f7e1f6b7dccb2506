// Tests the engine's own allocators and log callback. Everything that is allocated through an
// allocator must be freed, a refused allocation must be an error with a message, and images must
// not depend on the allocator.
#include <gmock/gmock.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::StartsWith;

// VkAllocationCallbacks that call malloc and count allocations and frees.
struct HostMemory {
  std::size_t allocations = 0;
  std::map<void*, std::size_t> alive;  // and their sizes

  VkAllocationCallbacks callbacks() {
    return {
        .pUserData = this,
        .pfnAllocation =
            [](void* user, std::size_t size, std::size_t alignment, VkSystemAllocationScope) {
              return static_cast<HostMemory*>(user)->allocate(size, alignment);
            },
        .pfnReallocation = [](void* user, void* original, std::size_t size, std::size_t alignment,
                              VkSystemAllocationScope) -> void* {
          auto& self = *static_cast<HostMemory*>(user);
          void* const copy = size == 0 ? nullptr : self.allocate(size, alignment);
          if (copy != nullptr && original != nullptr)
            std::memcpy(copy, original, std::min(size, self.alive.at(original)));
          self.free(original);
          return copy;
        },
        .pfnFree = [](void* user, void* memory) { static_cast<HostMemory*>(user)->free(memory); }};
  }
  void* allocate(std::size_t size, std::size_t alignment) {
    ++allocations;
    const std::size_t unit = std::max(alignment, sizeof(void*));
#ifdef _WIN32
    void* const memory = _aligned_malloc(size, unit);
#else
    void* const memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit);
#endif
    alive[memory] = size;
    return memory;
  }
  void free(void* memory) {
    EXPECT_EQ(alive.erase(memory), memory == nullptr ? 0u : 1u) << "freed what was not allocated";
#ifdef _WIN32
    _aligned_free(memory);
#else
    std::free(memory);
#endif
  }
};

// AlcoveMemoryFunctions that allocate a separate device memory object for each request and return a
// range that does not start at its beginning. A library that ignores the offset of the range then
// fails the test.
struct DeviceMemory {
  const sample::VulkanDevice& device;
  int fails_at = 0;  // the allocation, counted from 1, that fails; 0: none
  int calls = 0;
  std::set<std::pair<VkDeviceMemory, VkDeviceSize>> alive{};
  std::vector<VkMemoryPropertyFlags> required{};
  // By AlcoveMemoryLifetime.
  std::array<int, 2> device_local{};
  std::array<int, 2> host_visible{};

  AlcoveMemoryFunctions functions() {
    return {[](void* user, const AlcoveMemoryRequest* request, AlcoveMemoryRange* range) {
              return static_cast<DeviceMemory*>(user)->allocate(*request, *range);
            },
            [](void* user, const AlcoveMemoryRange* range) {
              static_cast<DeviceMemory*>(user)->free(*range);
            },
            this};
  }
  VkResult allocate(const AlcoveMemoryRequest& request, AlcoveMemoryRange& range) {
    if (++calls == fails_at) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    required.push_back(request.required);
    ++((request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0 ? host_visible : device_local)
          .at(request.lifetime);
    const VkMemoryRequirements& needs = request.requirements;
    const VkMemoryAllocateInfo info{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size + needs.alignment,
        .memoryTypeIndex =
            device.memory_type(needs.memoryTypeBits, request.required | request.preferred)};
    EXPECT_EQ(vkAllocateMemory(device.device(), &info, nullptr, &range.memory), VK_SUCCESS);
    range.offset = needs.alignment;
    if ((request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
      EXPECT_EQ(
          vkMapMemory(device.device(), range.memory, range.offset, VK_WHOLE_SIZE, 0, &range.mapped),
          VK_SUCCESS);
    }
    range.handle = this;
    alive.insert({range.memory, range.offset});
    return VK_SUCCESS;
  }
  void free(const AlcoveMemoryRange& range) {
    EXPECT_EQ(range.handle, this);
    EXPECT_EQ(alive.erase({range.memory, range.offset}), 1u) << "freed what was not allocated";
    vkFreeMemory(device.device(), range.memory, nullptr);
  }
};

// AlcoveLog that collects the sentences.
struct SentenceLog {
  std::vector<std::pair<AlcoveSeverity, std::string>> sentences;

  AlcoveLog log() {
    return {[](void* user, AlcoveSeverity severity, const char* sentence) {
              static_cast<SentenceLog*>(user)->sentences.emplace_back(severity, sentence);
            },
            this};
  }
};

class CAllocators : public CInterface {
 protected:
  // A view with outputs that need every kind of memory: histories, transients and a table.
  static HostView draw_outputs(std::uint32_t width, std::uint32_t height) {
    HostView view = draw_view(width, height);
    view.settings.bent_normal = true;
    view.settings.specular = ALCOVE_SPECULAR_TABLE;
    return view;
  }
  AlcoveResult record_alone(AlcoveContext& context, const AlcoveView& view, std::uint32_t index) {
    return record(context, make_frame({&view, 1}, index));
  }
};

TEST_F(CAllocators, EverythingAllocatedThroughTheEnginesAllocatorsIsFreed) {
  if (std::getenv("ALCOVE_LAYERS_OF_THE_HOST") != nullptr)
    GTEST_SKIP() << "Wine gives allocation callbacks to no driver.";
  HostMemory host;
  const VkAllocationCallbacks callbacks = host.callbacks();
  DeviceMemory memory{gpu().device()};
  {
    AlcoveContextInfo info = engine().context_info();
    info.allocation_callbacks = &callbacks;
    info.memory_functions = memory.functions();
    const Context context = create_context(info);
    const HostView from = draw_outputs(33, 17);
    for (std::uint32_t i = 0; i < 3; ++i)
      expect_equal(run_views(*context, {&from, 1}, i)[0], run_plainly(from, i));
    EXPECT_EQ(alcoveDropView(context.get(), 0), ALCOVE_SUCCESS);
  }
  EXPECT_GT(host.allocations, 20u);
  EXPECT_THAT(host.alive, IsEmpty());
  EXPECT_GT(memory.calls, 5);
  EXPECT_THAT(memory.alive, IsEmpty());
  EXPECT_GT(memory.device_local[ALCOVE_MEMORY_LIFETIME_FRAME], 0) << "intermediate images";
  EXPECT_GE(memory.device_local[ALCOVE_MEMORY_LIFETIME_PERSISTENT], 2) << "slots of the history";
  EXPECT_EQ(memory.host_visible[ALCOVE_MEMORY_LIFETIME_FRAME], 0);
}

// One allocation of the first, then of the second frame is refused, and so on.
TEST_F(CAllocators, AllocationThatTheEngineRefusesIsAnErrorAndTheNextFrameWorks) {
  const AlcoveView view = create_view(draw_outputs(16, 12));
  DeviceMemory memory{gpu().device()};
  AlcoveContextInfo info = engine().context_info();
  info.memory_functions = memory.functions();
  memory.fails_at = 1;
  char message[ALCOVE_MAX_MESSAGE];
  AlcoveContext* handle = nullptr;
  EXPECT_EQ(alcoveCreateContext(&info, &handle, message), ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_THAT(message, HasSubstr("The device is out of memory."));
  {
    const Context context = create_context(info);
    bool failed = true;
    for (int call = 1; failed; ++call) {
      SCOPED_TRACE(call);
      EXPECT_EQ(alcoveDropView(context.get(), view.info.id), ALCOVE_SUCCESS);
      memory.fails_at = call;
      memory.calls = 0;
      const AlcoveResult result = record_alone(*context, view, 0);
      failed = memory.calls >= call;
      EXPECT_EQ(result, failed ? ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY : ALCOVE_SUCCESS);
      if (failed) {
        EXPECT_STRNE(alcoveGetMessage(context.get()), "");
      }
      memory.fails_at = 0;
      EXPECT_EQ(record_alone(*context, view, 0), ALCOVE_SUCCESS) << alcoveGetMessage(context.get());
      ASSERT_LT(call, 100);
    }
    engine().wait();
  }
  EXPECT_THAT(memory.alive, IsEmpty());
}

TEST_F(CAllocators, LogCallbackGetsErrorsWarningsAndInformation) {
  SentenceLog log;
  AlcoveContextInfo info = engine().context_info();
  info.log = log.log();
  info.frames_in_flight = 0;
  AlcoveContext* handle = nullptr;
  EXPECT_EQ(alcoveCreateContext(&info, &handle, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(log.sentences,
              testing::ElementsAre(Pair(ALCOVE_SEVERITY_ERROR, HasSubstr("frames_in_flight"))));
  log.sentences.clear();
  info.frames_in_flight = TestEngine::kSlots;
  const Context context = create_context(info);
  const AlcoveView view = create_view(draw_outputs(16, 12));
  EXPECT_EQ(record_alone(*context, view, 0), ALCOVE_SUCCESS);
  EXPECT_THAT(log.sentences,
              AllOf(Contains(Pair(ALCOVE_SEVERITY_WARNING, HasSubstr("alcovePrepareFrame"))),
                    Contains(Pair(ALCOVE_SEVERITY_INFO, StartsWith("The render graph has "))),
                    Contains(Pair(ALCOVE_SEVERITY_INFO, HasSubstr("pipeline")))));
  EXPECT_EQ(record_alone(*context, view, 1), ALCOVE_SUCCESS);
  log.sentences.clear();
  for (std::uint32_t i = 2; i < 6; ++i) EXPECT_EQ(record_alone(*context, view, i), ALCOVE_SUCCESS);
  EXPECT_THAT(log.sentences, IsEmpty()) << "a steady frame";
  engine().wait();
}

}  // namespace
}  // namespace alcove::passes
