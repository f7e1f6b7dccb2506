// The state of a graph's histories, which are textures that are kept from frame to frame.
//
// A history has N slots. In each frame, slot 0 ("current") may be written, and slot k holds what
// was current k frames ago. Slots rotate at the end of a frame in which a live pass wrote slot 0. A
// frame in which that pass is culled leaves all contents where they are. A frame that instead
// writes an older slot and keeps its contents updates that slot in place. If a pass that runs uses
// a slot, all passes that write the history run, because a later frame may read it. A changed
// description or a reset makes every slot invalid and keeps the reason. A slot becomes valid again
// when it is written. A frame that does not declare the history leaves it unchanged.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

inline constexpr std::uint32_t kMaxHistorySlots = 8;

struct HistorySlot {
  State state;  // the state in which the last frame that used it left it
  QueueClass queue = QueueClass::graphics;
  HistoryValidity validity = HistoryValidity::first_frame;
};

struct HistoryState {
  ResourceRecord record;                // of slot 0, with `external` cleared
  HistorySlot slots[kMaxHistorySlots];  // by physical position
  std::uint32_t head = 0;               // physical position of slot 0
  std::uint32_t generation = 0;         // changes when new physical resources are needed
};

struct HistoryEntry : HistoryState {
  std::string name;
  std::uint32_t newest = 0;  // of all generations: none comes twice
  bool declared = false;     // in the frame that is being declared
  bool dropped = false;      // the place is free

  std::uint32_t physical(std::uint32_t slot) const { return (head + slot) % record.slots; }
};

class HistoryTable {
 public:
  HistoryTable() = default;
  HistoryTable(const HistoryTable&) = delete;
  HistoryTable& operator=(const HistoryTable&) = delete;

  // Finds or creates the entry with this name. A changed record makes its slots invalid.
  std::uint32_t declare(std::string_view name, const ResourceRecord& record);
  void invalidate(std::string_view name);
  void invalidate_all();
  // Drops the history with this name unless this frame declares it.
  void drop(std::string_view name);
  void begin_frame();
  // Marks all histories as not declared, so that each can be dropped.
  void end_frame();

  // Functions for the end of a frame. leave() stores the state in which the frame left a slot.
  // rotate() is called for a history whose slot 0 was written: slot 0 becomes slot 1, and the
  // oldest slot becomes slot 0.
  void leave(std::uint32_t index, std::uint32_t slot, const HistorySlot& left);
  void rotate(std::uint32_t index);
  // Restores the table as it was at begin_frame(), because the declared frame does not run.
  // Histories that were removed with drop() stay removed.
  void undo();
  // Makes all slots invalid and without a state, because their executor is gone.
  void forget_contents();
  // Returns whether the resources of a generation are in use, or undo() could make them used again.
  bool needs(std::uint32_t index, std::uint32_t generation) const;

  const std::vector<HistoryEntry>& entries() const { return entries_; }
  HistoryEntry& entry(std::uint32_t index) { return entries_[index]; }
  // Returns a token that identifies the table to executors. It expires with the table.
  std::weak_ptr<const char> life() const { return life_; }

 private:
  // The state of an entry before the frame changed it.
  struct SavedState {
    std::uint32_t index = 0;
    HistoryState state;
  };
  void remember(std::uint32_t index);
  void invalidate(std::uint32_t index);

  std::vector<HistoryEntry> entries_;
  std::vector<SavedState> saved_;  // room for all entries
  std::shared_ptr<const char> life_ = std::make_shared<const char>('\0');
};

}  // namespace alcove::framegraph
