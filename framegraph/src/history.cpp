#include "alcove/framegraph/history.h"

#include <algorithm>

namespace alcove::framegraph {

std::uint32_t HistoryTable::declare(std::string_view name, const ResourceRecord& record) {
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    HistoryEntry& entry = entries_[i];
    // Two histories with one name in one frame are different histories.
    if (entry.declared || entry.dropped || entry.name != name) continue;
    remember(i);
    entry.declared = true;
    if (entry.record == record) return i;
    entry.record = record;
    entry.head = 0;
    entry.generation = ++entry.newest;
    bool held = false;
    for (const HistorySlot& slot : entry.slots)
      held = held || slot.validity != HistoryValidity::first_frame;
    for (HistorySlot& slot : entry.slots) {
      slot = {};
      if (held) slot.validity = HistoryValidity::resized;
    }
    return i;
  }
  auto place = std::find_if(entries_.begin(), entries_.end(),
                            [](const HistoryEntry& entry) { return entry.dropped; });
  if (place == entries_.end()) {
    saved_.reserve(entries_.size() + 1);
    place = entries_.insert(place, HistoryEntry{});
  }
  // The generation number of the new history continues from that of the previous history in this
  // entry, so that the resources of the previous one are never found for the new one.
  const std::uint32_t newest = place->newest;
  *place = {};
  place->name = name;
  place->record = record;
  place->generation = place->newest = newest;
  place->declared = true;
  const auto index = static_cast<std::uint32_t>(place - entries_.begin());
  remember(index);
  return index;
}

void HistoryTable::drop(std::string_view name) {
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    HistoryEntry& entry = entries_[i];
    if (entry.declared || entry.dropped || entry.name != name) continue;
    entry.dropped = true;
    entry.generation = ++entry.newest;
    std::erase_if(saved_, [i](const SavedState& saved) { return saved.index == i; });
  }
}

void HistoryTable::invalidate(std::string_view name) {
  for (std::uint32_t i = 0; i < entries_.size(); ++i)
    if (entries_[i].name == name) invalidate(i);
}

void HistoryTable::invalidate_all() {
  for (std::uint32_t i = 0; i < entries_.size(); ++i) invalidate(i);
}

void HistoryTable::invalidate(std::uint32_t index) {
  for (HistorySlot& slot : entries_[index].slots) {
    // A slot that is already invalid keeps its first reason.
    if (slot.validity != HistoryValidity::valid) continue;
    remember(index);
    slot.validity = HistoryValidity::reset;
  }
}

void HistoryTable::leave(std::uint32_t index, std::uint32_t slot, const HistorySlot& left) {
  remember(index);
  HistoryEntry& entry = entries_[index];
  entry.slots[entry.physical(slot)] = left;
}

// Slots rotate: the oldest one becomes the current one.
void HistoryTable::rotate(std::uint32_t index) {
  HistoryEntry& entry = entries_[index];
  entry.head = (entry.head + entry.record.slots - 1) % entry.record.slots;
}

void HistoryTable::remember(std::uint32_t index) {
  const auto is_here = [index](const SavedState& saved) { return saved.index == index; };
  if (std::any_of(saved_.begin(), saved_.end(), is_here)) return;
  saved_.push_back({index, entries_[index]});
}

void HistoryTable::undo() {
  for (const SavedState& saved : saved_)
    static_cast<HistoryState&>(entries_[saved.index]) = saved.state;
  saved_.clear();
}

void HistoryTable::forget_contents() {
  for (HistoryEntry& entry : entries_) {
    for (HistorySlot& slot : entry.slots) {
      const bool held = slot.validity == HistoryValidity::valid;
      slot = {{}, QueueClass::graphics, held ? HistoryValidity::reset : slot.validity};
    }
  }
}

bool HistoryTable::needs(std::uint32_t index, std::uint32_t generation) const {
  return entries_[index].generation == generation ||
         std::any_of(saved_.begin(), saved_.end(), [&](const SavedState& saved) {
           return saved.index == index && saved.state.generation == generation;
         });
}

void HistoryTable::begin_frame() {
  end_frame();
  saved_.clear();
}

void HistoryTable::end_frame() {
  for (HistoryEntry& entry : entries_) entry.declared = false;
}

}  // namespace alcove::framegraph
