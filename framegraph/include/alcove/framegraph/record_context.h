// The argument of a recording callback: the command buffer and the Vulkan objects of its handles.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "alcove/framegraph/types.h"
#include "alcove/framegraph/vulkan_functions.h"

namespace alcove::framegraph {

// Selects the view type by the covered range: 3D for a 3D texture, a 2D array if the range has more
// than one layer, and 2D otherwise.
inline constexpr VkImageViewType kViewTypeByRange = VK_IMAGE_VIEW_TYPE_MAX_ENUM;

// A texture as an attachment of a rendering. The pass must have declared it as an attachment.
struct Attachment {
  Texture texture = {};
  // The value that the texture is cleared to if no earlier contents are loaded. If null, the
  // contents are then undefined.
  const VkClearValue* clear = nullptr;
  // The texture with one sample that a multisampled texture is resolved to, if any.
  Texture resolve = {};
  // NONE stands for AVERAGE, or for SAMPLE_ZERO of a depth attachment.
  VkResolveModeFlagBits resolve_mode = VK_RESOLVE_MODE_NONE;
  // The mip and layers, if the pass draws to several parts of the texture. By default, it is the
  // range of the first access that declares the texture as an attachment.
  Range range = {};
};

// How a rendering covers its attachments. By default it covers all texels, and all layers of the
// range that the pass declared.
struct Rendering {
  VkRenderingFlags flags = 0;  // for example, the commands come from secondary command buffers
  VkRect2D area = {};          // the texels that are drawn to; all of them if the width is 0
  // If not 0, one bit for each layer to which the pass draws as a view of its own. This needs the
  // feature multiview.
  std::uint32_t view_mask = 0;
};

// The argument of a recording callback. It is valid only during the callback. Any version of a
// handle refers to the same image or buffer.
//
// A frame of an unchanged declaration gets the same buffers, and the same views except of
// histories, whose slots swap. A descriptor set may be kept as long as the handles that it was
// written with are those of this frame and `handle_epoch` is that of then. Imported handles are
// those that the caller gave in this frame.
//
// If uses are checked (ExecutorOptions::check_uses, on in debug builds), a texture or buffer that
// the pass did not declare gives a null handle, and Executor::record() returns an error.
class RecordContext {
 public:
  VkCommandBuffer commands = VK_NULL_HANDLE;
  const VulkanFunctions& vk;  // the few functions that the libraries call
  // A number that changes before a view or buffer that passes have got is destroyed, except for
  // imported ones. While it stays, equal handles are the same object. Two executors never have the
  // same number.
  std::uint64_t handle_epoch = 0;
  // FrameInfo::slot, for objects that a pass keeps per frame in flight.
  std::uint32_t frame_slot = 0;

  // Returns a view of `range`, which must lie within what the pass declared for this texture.
  // Without `range`, the view covers the range of the first access that names the texture. Unless
  // `type` is given, the view is 3D for a 3D texture, a 2D array if it covers several layers, and
  // 2D otherwise. For a format with depth and stencil it shows depth. A different `format` needs
  // VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT in TextureDesc::flags, and a cube view needs
  // VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT.
  VkImageView view(Texture texture) const;
  VkImageView view(Texture texture, Range range, VkImageViewType type = kViewTypeByRange,
                   VkFormat format = VK_FORMAT_UNDEFINED) const;
  // Returns whether view() has returned a view that the caller imported (ImportedTexture::view).
  // The caller may destroy such a view after the frame, and another view may get the same handle,
  // in the same handle_epoch.
  bool gave_imported_view() const { return gave_imported_view_; }
  // Returns the attachment for vkCmdBeginRendering. Earlier contents are loaded if there are any
  // and the access keeps them. The result is stored if a later pass or frame needs it.
  VkRenderingAttachmentInfo attachment(const Attachment& attachment) const;
  // Begins a rendering to the attachments' mips and layers. `depth` is bound for all aspects of its
  // format. Returns false, and record() returns an error, if the
  // attachments' sizes or samples differ, the rendering covers more than they have, or the device
  // lacks dynamic rendering.
  bool begin_rendering(std::span<const Attachment> colors, const Attachment& depth = {},
                       const Rendering& rendering = {}) const;
  void end_rendering() const { vk.vkCmdEndRendering(commands); }
  VkImage image(Texture texture) const;
  VkBuffer buffer(Buffer buffer) const;
  // Returns the layout in which the pass finds a range of a texture, for descriptors and commands.
  // Without `range`, it is that of the first access that names the texture.
  VkImageLayout layout(Texture texture, Range range = {}) const;
  // Returns the size of a mip in texels.
  VkExtent3D extent(Texture texture, std::uint32_t mip = 0) const;
  VkDeviceSize size(Buffer buffer) const;
  VkFormat format(Texture texture) const;
  // Returns whether a slot of a history has contents, and if not, why. If uses are checked, a pass
  // that uses an older slot without contents and has not asked for its validity before is an error.
  HistoryValidity validity(Texture texture) const;
  std::string_view pass_name() const;
  // Tells the executor that an object which the pass needs could not be created: record() then
  // returns an error whose sentence contains `what`, and the frame must not be submitted.
  void fail(std::string_view what, VkResult result) const;

 private:
  friend class Recorder;
  VkRenderingAttachmentInfo attachment(const Attachment& attachment, std::uint32_t access) const;
  std::uint32_t attachment_access(const Attachment& attachment) const;
  // Returns the physical resource of a texture or buffer that the pass declared, or null.
  struct Physical* physical(std::uint32_t resource, std::uint32_t version) const;
  RecordContext(VkCommandBuffer command_buffer, const VulkanFunctions& functions,
                const class Recorder& recorder, std::uint32_t pass)
      : commands(command_buffer), vk(functions), recorder_(recorder), pass_(pass) {}
  const class Recorder& recorder_;
  std::uint32_t pass_;
  mutable bool gave_imported_view_ = false;
  mutable std::uint64_t asked_ = 0;  // textures whose validity the pass knows: bit index % 64
};

}  // namespace alcove::framegraph
