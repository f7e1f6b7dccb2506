// The state of a graph's history resources from frame to frame.
//
// A history has N slots. Each frame slot 0 ("current") may be written and slots 1..N-1 hold what
// was current 1..N-1 frames ago. Slots rotate at the end of a frame in which a live pass wrote slot
// 0, and only then: a frame that culls the writer leaves all contents where they are, and one that
// writes an older slot instead, keeping contents, updates it in place. A change of description or a
// reset makes every slot invalid, with the reason; a slot becomes valid again when it was written.
// A frame that does not declare the history leaves it untouched.
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
  State state;  // how the last frame that touched it left it
  QueueClass queue = QueueClass::graphics;
  HistoryValidity validity = HistoryValidity::first_frame;
};

struct HistoryEntry {
  std::string name;
  ResourceRecord record;                // of slot 0, with `external` cleared
  HistorySlot slots[kMaxHistorySlots];  // by physical position
  std::uint32_t head = 0;               // physical position of slot 0
  std::uint32_t generation = 0;         // changes when new physical resources are needed
  std::uint32_t newest = 0;             // of all generations: none comes twice
  bool declared = false;                // in the frame that is being declared
  bool dropped = false;                 // the place is free

  std::uint32_t physical(std::uint32_t slot) const { return (head + slot) % record.slots; }
};

class HistoryTable {
 public:
  HistoryTable() = default;
  HistoryTable(const HistoryTable&) = delete;
  HistoryTable& operator=(const HistoryTable&) = delete;

  // Finds or makes the entry; a changed record invalidates it.
  std::uint32_t declare(std::string_view name, const ResourceRecord& record);
  void invalidate(std::string_view name);
  void invalidate_all();
  // Frees the place of a history that is not declared in this frame.
  void drop(std::string_view name);
  void begin_frame();
  // No history is declared any more: each can be dropped.
  void end_frame();

  // At the end of a frame, after begin_end(): how it left a slot, and that slot 0 becomes slot 1.
  void begin_end();
  void leave(std::uint32_t index, std::uint32_t slot, const HistorySlot& left);
  void rotate(std::uint32_t index);
  // The frame does not run: takes back all that was done since begin_frame(), but for drop().
  void undo();
  // Whether undo() took back a description that the declared frame still goes by.
  bool must_be_declared_anew() const { return anew_; }
  // No slot has contents any more, nor a state: the executor that had them is gone.
  void forget_contents();
  // Whether a frame has left or taken back slots since begin_frame() or clear_moved().
  bool have_moved() const { return moved_; }
  void clear_moved() { moved_ = false; }
  // Whether the resources of a generation are in use, or undo() could bring them back.
  bool needs(std::uint32_t index, std::uint32_t generation) const;

  const std::vector<HistoryEntry>& entries() const { return entries_; }
  HistoryEntry& entry(std::uint32_t index) { return entries_[index]; }
  // Tells executors the histories of one graph from another's; expires with the table.
  std::weak_ptr<const char> life() const { return life_; }

 private:
  // An entry as it was before the frame changed it.
  struct Before {
    std::uint32_t index = 0;
    std::uint32_t head = 0;
    std::uint32_t generation = 0;
    ResourceRecord record;
    HistorySlot slots[kMaxHistorySlots];
  };
  void remember(std::uint32_t index);
  void invalidate(std::uint32_t index);

  std::vector<HistoryEntry> entries_;
  std::vector<Before> before_;  // room for all entries
  bool ended_ = false;          // the frame has left some
  bool anew_ = false;
  bool moved_ = false;
  std::shared_ptr<const char> life_ = std::make_shared<const char>('\0');
};

}  // namespace alcove::framegraph
