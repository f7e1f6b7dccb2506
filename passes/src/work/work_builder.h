// Fills a list of work (alcove_work.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "alcove/alcove_work.h"
#include "alcove/passes/error.h"
#include "work/shader_table.h"

namespace alcove::passes {

// The histories of a view.
enum class HistoryRole : std::uint8_t { visibility, depth, bent_normal, lobe };
inline constexpr std::array kHistoryNames{"visibility history", "depth history",
                                          "bent-normal history", "lobe history"};

// A resource of the list, by its index, or null.
struct ResourceHandle {
  std::uint32_t index = ALCOVE_WORK_NONE;
  explicit constexpr operator bool() const { return index != ALCOVE_WORK_NONE; }
  bool operator==(const ResourceHandle&) const = default;
};

// An image for a binding of a shader, by the variable's name in GLSL.
struct NamedImage {
  std::string_view name;
  ResourceHandle texture;
};

// A request of a pass to run a shader. Constants and images that only other shaders have are
// ignored, so that all variants of a shader can be given the same lists.
struct DispatchRequest {
  const char* label = "";  // static
  Shader shader = Shader::count;
  std::span<const NamedConstant> constants = {};
  std::span<const NamedImage> images = {};
  std::span<const std::byte> parameters = {};
  VkExtent3D size{};  // invocations
};

// Fills an AlcoveWork. It refers to the list, which must outlive it, and allocates nothing.
class WorkBuilder {
 public:
  // The slots of a history, and whether the contents of `previous` can be read.
  struct History {
    ResourceHandle previous;
    ResourceHandle current;
    bool valid = false;
  };
  // Decides about a history instead of `previous`. It is called when the history has been added.
  struct HistorySource {
    bool (*is_valid)(void* user, HistoryRole role, const History& history) = nullptr;
    void* user = nullptr;
  };

  // Begins an empty list. The histories continue those of `previous`, the list of the last executed
  // frame, which may be `work` itself, or null.
  explicit WorkBuilder(AlcoveWork& work, const AlcoveWork* previous = nullptr);

  // Adds an image. Returns a null handle if the list is full.
  ResourceHandle add(AlcoveResourceKind kind, const char* name, VkFormat format, VkExtent2D size,
                     std::uint32_t samples = 1, std::uint32_t role = ALCOVE_WORK_NONE);
  ResourceHandle add_transient(const char* name, VkFormat format, VkExtent2D size) {
    return add(ALCOVE_RESOURCE_KIND_TRANSIENT, name, format, size);
  }
  // Adds the two slots of a history.
  History add_history(HistoryRole role, VkFormat format, VkExtent2D size);
  void set_history_source(const HistorySource& source) { source_ = source; }

  // Adds a dispatch. The accesses follow from the shader's interface. A constant or an image of the
  // shader that is missing, or a full list, is an error, which result() returns.
  void dispatch(const DispatchRequest& info);
  // Returns the first error of dispatch().
  [[nodiscard]] tl::expected<void, Error> result() const { return result_; }

  VkExtent2D size(ResourceHandle texture) const;
  VkFormat format(ResourceHandle texture) const;
  std::uint32_t samples(ResourceHandle texture) const;  // per pixel
  AlcoveWork& work() const { return work_; }

 private:
  struct KnownHistory {
    const char* name = nullptr;
    std::uint32_t format = 0;
    VkExtent2D size{};
  };
  const AlcoveWorkResource* find(ResourceHandle texture) const;
  std::uint32_t add_table(const char* name, std::span<const std::uint32_t> words);
  tl::expected<void, Error> add_dispatch(const DispatchRequest& info);
  bool bind(AlcoveWorkDispatch& dispatch, const struct ShaderBinding& binding, ResourceHandle given,
            std::span<const std::uint32_t> table);

  AlcoveWork& work_;
  HistorySource source_;
  KnownHistory previous_[ALCOVE_MAX_WORK_HISTORIES];  // of the last frame
  tl::expected<void, Error> result_;
};

// Returns the list as text: its resources, and its dispatches with all that they bind.
[[nodiscard]] std::string print_work(const AlcoveWork& work);

}  // namespace alcove::passes
