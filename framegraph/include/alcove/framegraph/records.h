// Growing arrays for what is declared anew in every frame. Using a place again costs next to
// nothing, since what is there is overwritten and not made again.
#pragma once

#include <cstddef>
#include <vector>

namespace alcove::framegraph {

// Plain records, one after the other.
template <typename Record>
class Records {
 public:
  // The next record, with whatever was there before: its fields are all to be set.
  Record& append() { return *append(1); }
  // The first of `count` such records.
  Record* append(std::size_t count) {
    const std::size_t first = size_;
    size_ += count;
    if (size_ > capacity_) [[unlikely]]
      grow();
    return records_.data() + first;
  }
  void push_back(const Record& record) { append() = record; }
  void clear() { size_ = 0; }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Record* data() const { return records_.data(); }
  const Record* begin() const { return data(); }
  const Record* end() const { return data() + size_; }
  const Record& operator[](std::size_t index) const { return records_[index]; }
  Record& operator[](std::size_t index) { return records_[index]; }

 private:
  void grow() {
    capacity_ = 2 * size_ + 16;
    records_.resize(capacity_);
  }

  std::vector<Record> records_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;  // what records_ holds
};

// Values beside records, each at the index of its record.
template <typename Value>
class Beside {
 public:
  Value& at(std::size_t index) {
    if (index >= capacity_) [[unlikely]]
      grow(index);
    return values_[index];
  }
  // At an index that was given to at() before.
  const Value& operator[](std::size_t index) const { return values_[index]; }
  Value& operator[](std::size_t index) { return values_[index]; }

 private:
  void grow(std::size_t index) {
    capacity_ = 2 * index + 16;
    values_.resize(capacity_);
  }

  std::vector<Value> values_;
  std::size_t capacity_ = 0;  // what values_ holds
};

}  // namespace alcove::framegraph
