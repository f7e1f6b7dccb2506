// The verifier's model of Vulkan's memory: what each past operation is ordered before, where its
// writes are available and to whom they are visible. Knows nothing of how plans are made.
//
// An operation is cut into one piece for each pipeline stage. A piece carries, for each queue, the
// stages of later commands that it happens before (`after`), the same with its writes available
// (`available`), and the stages and accesses that see it (`grants`).
#pragma once

#include <cstdint>
#include <vector>

#include "alcove/framegraph/plan.h"

namespace alcove::framegraph::verifier {

using Stages = VkPipelineStageFlags2;
using Accesses = VkAccessFlags2;

// Meta stages and accesses as the sets of plain ones that they stand for.
Stages expand_stages(Stages stages);
Accesses expand_accesses(Accesses accesses);
bool is_write(Accesses accesses);
Accesses reads_of(Accesses accesses);

struct Grant {
  std::uint8_t queue = 0;
  Stages stages = 0;
  Accesses accesses = 0;
};

// That an operation came before the set of an event: by which transition of its batch, and whether
// with its writes available, by what was so before or (`direct`) by the transition's memory side.
struct Capture {
  std::uint32_t transition = 0;
  bool available = false;
  bool direct = false;
};

struct Piece {
  std::uint8_t queue = 0;
  Stages stage = 0;     // one bit; 0 for a layout change, which is ordered by `after` alone
  Accesses writes = 0;  // 0 for a read, and for what is available by itself
  Stages after[kQueueClasses] = {};
  Stages available[kQueueClasses] = {};
  std::vector<Grant> grants;
  std::vector<std::uint32_t> signalled;  // submissions whose signal comes after it
  std::vector<Capture> captures;         // by events that are set and not yet waited for
};

// The pieces of a command's access.
void append_pieces(std::vector<Piece>& pieces, std::uint8_t queue, Stages stages,
                   Accesses accesses);
// A layout change by a barrier whose second scope is given.
Piece change_piece(std::uint8_t queue, Stages stages, Accesses accesses);

// A barrier's scopes, expanded.
struct Scopes {
  std::uint8_t queue = 0;
  Stages src = 0;
  Accesses src_access = 0;
  Stages dst = 0;
  Accesses dst_access = 0;
};
Scopes scopes_of(const Transition& transition, QueueClass queue);

// How a piece stands to the first scope of a barrier: whether it comes before what the barrier
// does, and whether with its writes available. `memory`: the barrier's memory side covers the
// piece's resource.
struct Reach {
  bool before = false;
  bool available = false;
};
Reach reach(const Piece& piece, const Scopes& barrier, bool memory);
// The same for a barrier by event: as it was when the event was set.
void capture(Piece& piece, const Scopes& barrier, std::uint32_t transition);
Reach captured(const Piece& piece, std::uint32_t transition, bool memory);
// What the barrier adds to a piece that it reaches.
void apply(Piece& piece, const Scopes& barrier, const Reach& reached, bool memory);

// Signals and waits of submissions.
void signal(Piece& piece, std::uint8_t queue, std::uint32_t submission);
void wait(Piece& piece, std::uint8_t queue, std::uint32_t submission, Stages stages);
// Everything later on every queue comes after the piece, and sees it.
void join(Piece& piece);

// Whether a command of these stages (and accesses) comes after the piece; with its writes
// available; and sees it.
bool ordered(const Piece& piece, std::uint8_t queue, Stages stages);
bool available(const Piece& piece, std::uint8_t queue, Stages stages);
bool visible(const Piece& piece, std::uint8_t queue, Stages stages, Accesses accesses);

}  // namespace alcove::framegraph::verifier
