#include "alcove/framegraph/history.h"

#include <algorithm>
#include <cstring>

namespace alcove::framegraph {
namespace {

void invalidate_slots(HistoryEntry& entry, HistoryValidity reason) {
  for (HistorySlot& slot : entry.slots) {
    // What never held anything keeps the first reason.
    if (slot.validity == HistoryValidity::valid) slot.validity = reason;
  }
}

}  // namespace

std::uint32_t HistoryTable::declare(std::string_view name, const ResourceRecord& record) {
  ended_.clear();
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    HistoryEntry& entry = entries_[i];
    // Two histories of one name in one frame are two histories.
    if (entry.declared || entry.dropped || entry.name != name) continue;
    entry.declared = true;
    if (std::memcmp(&entry.record, &record, sizeof record) == 0) return i;
    entry.record = record;
    entry.head = 0;
    ++entry.generation;
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
  if (place == entries_.end()) place = entries_.insert(place, HistoryEntry{});
  // The generation goes on: what the place held before is of an earlier one.
  const std::uint32_t generation = place->generation;
  *place = {};
  place->name = name;
  place->record = record;
  place->generation = generation;
  place->declared = true;
  return static_cast<std::uint32_t>(place - entries_.begin());
}

void HistoryTable::drop(std::string_view name) {
  for (HistoryEntry& entry : entries_) {
    if (entry.declared || entry.dropped || entry.name != name) continue;
    entry.dropped = true;
    ++entry.generation;
  }
}

void HistoryTable::invalidate(std::string_view name) {
  for (HistoryEntry& entry : entries_) {
    if (entry.name == name) invalidate_slots(entry, HistoryValidity::reset);
  }
}

void HistoryTable::invalidate_all() {
  for (HistoryEntry& entry : entries_) invalidate_slots(entry, HistoryValidity::reset);
}

void HistoryTable::leave(std::uint32_t index, std::uint32_t slot, const HistorySlot& left) {
  HistoryEntry& entry = entries_[index];
  const std::uint32_t position = entry.physical(slot);
  ended_.push_back({index, entry.head, position, entry.slots[position]});
  entry.slots[position] = left;
}

// The oldest slot is the next to be written.
void HistoryTable::rotate(std::uint32_t index) {
  HistoryEntry& entry = entries_[index];
  entry.head = (entry.head + entry.record.slots - 1) % entry.record.slots;
}

void HistoryTable::undo() {
  for (const Before& before : ended_) {
    entries_[before.index].head = before.head;
    entries_[before.index].slots[before.position] = before.slot;
  }
  ended_.clear();
}

void HistoryTable::begin_frame() {
  for (HistoryEntry& entry : entries_) entry.declared = false;
}

}  // namespace alcove::framegraph
