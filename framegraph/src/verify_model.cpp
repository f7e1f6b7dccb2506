#include "verify_model.h"

#include <algorithm>

namespace alcove::framegraph::verifier {
namespace {

constexpr Stages kVertexInput =
    VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT;
constexpr Stages kPreRasterization = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                     VK_PIPELINE_STAGE_2_TESSELLATION_CONTROL_SHADER_BIT |
                                     VK_PIPELINE_STAGE_2_TESSELLATION_EVALUATION_SHADER_BIT |
                                     VK_PIPELINE_STAGE_2_GEOMETRY_SHADER_BIT;
constexpr Stages kTransfer = VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT |
                             VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;
constexpr Stages kGraphics =
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | kVertexInput | kPreRasterization |
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr Stages kCommands = kGraphics | kTransfer | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr Stages kMeta =
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT |
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT |
    VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT | VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT |
    VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT;

constexpr Accesses kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                             VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                             VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                             VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;
constexpr Accesses kReads =
    VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT |
    VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT |
    VK_ACCESS_2_INPUT_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
    VK_ACCESS_2_HOST_READ_BIT;

}  // namespace

Stages expand_stages(Stages stages) {
  Stages plain = stages & ~kMeta;
  if (stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) plain |= kCommands;
  if (stages & VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT) plain |= kGraphics;
  if (stages & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) plain |= kTransfer;
  if (stages & VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT) plain |= kVertexInput;
  if (stages & VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT) plain |= kPreRasterization;
  return plain;
}

Accesses expand_accesses(Accesses accesses) {
  Accesses plain = accesses & (kWrites | kReads);
  if (accesses & VK_ACCESS_2_MEMORY_READ_BIT) plain |= kReads;
  if (accesses & VK_ACCESS_2_MEMORY_WRITE_BIT) plain |= kWrites;
  if (accesses & VK_ACCESS_2_SHADER_READ_BIT)
    plain |= VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
  if (accesses & VK_ACCESS_2_SHADER_WRITE_BIT) plain |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  return plain;
}

bool is_write(Accesses accesses) { return (expand_accesses(accesses) & kWrites) != 0; }

Accesses reads_of(Accesses accesses) { return expand_accesses(accesses) & kReads; }

void append_pieces(std::vector<Piece>& pieces, std::uint8_t queue, Stages stages,
                   Accesses accesses) {
  for (Stages left = expand_stages(stages); left != 0; left &= left - 1) {
    Piece piece;
    piece.queue = queue;
    piece.stage = left & (~left + 1);
    piece.writes = expand_accesses(accesses) & kWrites;
    pieces.push_back(piece);
  }
}

Piece change_piece(std::uint8_t queue, Stages stages, Accesses accesses) {
  Piece piece;
  piece.queue = queue;
  piece.after[queue] = piece.available[queue] = stages;
  piece.grants.push_back({queue, stages, accesses});
  return piece;
}

Scopes scopes_of(const Transition& t, QueueClass queue) {
  return {static_cast<std::uint8_t>(queue), expand_stages(t.src_stages),
          expand_accesses(t.src_access), expand_stages(t.dst_stages),
          expand_accesses(t.dst_access)};
}

namespace {

bool comes_before(const Piece& piece, const Scopes& barrier) {
  return (piece.queue == barrier.queue && (piece.stage & barrier.src) != 0) ||
         (piece.after[barrier.queue] & barrier.src) != 0;
}

bool is_made_available(const Piece& piece, const Scopes& barrier, bool memory) {
  if ((piece.available[barrier.queue] & barrier.src) != 0) return true;
  if (piece.writes == 0 && piece.stage != 0) return comes_before(piece, barrier);
  return memory && piece.queue == barrier.queue && (piece.stage & barrier.src) != 0 &&
         (piece.writes & ~barrier.src_access) == 0;
}

}  // namespace

Reach reach(const Piece& piece, const Scopes& barrier, bool memory) {
  return {comes_before(piece, barrier), is_made_available(piece, barrier, memory)};
}

void capture(Piece& piece, const Scopes& barrier, std::uint32_t transition) {
  std::erase_if(piece.captures, [&](const Capture& c) { return c.transition == transition; });
  if (!comes_before(piece, barrier)) return;
  piece.captures.push_back({transition, is_made_available(piece, barrier, false),
                            is_made_available(piece, barrier, true)});
}

Reach captured(const Piece& piece, std::uint32_t transition, bool memory) {
  for (const Capture& capture : piece.captures) {
    if (capture.transition == transition)
      return {true, capture.available || (memory && capture.direct)};
  }
  return {};
}

void apply(Piece& piece, const Scopes& barrier, const Reach& reached, bool memory) {
  if (!reached.before) return;
  piece.after[barrier.queue] |= barrier.dst;
  if (!reached.available) return;
  piece.available[barrier.queue] |= barrier.dst;
  if (memory && barrier.dst_access != 0)
    piece.grants.push_back({barrier.queue, barrier.dst, barrier.dst_access});
}

void signal(Piece& piece, std::uint8_t queue, std::uint32_t submission) {
  const bool before = (piece.queue == queue && piece.stage != 0) || piece.after[queue] != 0;
  if (before) piece.signalled.push_back(submission);
}

void wait(Piece& piece, std::uint8_t queue, std::uint32_t submission, Stages stages) {
  if (std::find(piece.signalled.begin(), piece.signalled.end(), submission) ==
      piece.signalled.end())
    return;
  const Stages plain = expand_stages(stages);
  piece.after[queue] |= plain;
  piece.available[queue] |= plain;
  piece.grants.push_back({queue, plain, kReads | kWrites});
}

void join(Piece& piece) {
  for (std::uint8_t queue = 0; queue < kQueueClasses; ++queue) {
    piece.after[queue] = piece.available[queue] = ~Stages{0};
    piece.grants.push_back({queue, ~Stages{0}, ~Accesses{0}});
  }
}

bool ordered(const Piece& piece, std::uint8_t queue, Stages stages) {
  return (expand_stages(stages) & ~piece.after[queue]) == 0;
}

bool available(const Piece& piece, std::uint8_t queue, Stages stages) {
  if (piece.writes == 0 && piece.stage != 0) return ordered(piece, queue, stages);
  return (expand_stages(stages) & ~piece.available[queue]) == 0;
}

bool visible(const Piece& piece, std::uint8_t queue, Stages stages, Accesses accesses) {
  const Accesses wanted = expand_accesses(accesses);
  for (Stages left = expand_stages(stages); left != 0; left &= left - 1) {
    const Stages stage = left & (~left + 1);
    Accesses seen = 0;
    for (const Grant& grant : piece.grants) {
      if (grant.queue == queue && (grant.stages & stage)) seen |= grant.accesses;
    }
    if (wanted & ~seen) return false;
  }
  return true;
}

}  // namespace alcove::framegraph::verifier
