// A growing array of plain records, for what is declared anew in every frame: clearing and
// appending cost next to nothing, since a record is not made again when its place is used again.
#pragma once

#include <cstddef>
#include <vector>

namespace alcove::framegraph {

template <typename Record>
class Records {
 public:
  // The next record, with whatever was there before: its fields are all to be set.
  Record& append() {
    if (size_ == capacity_) grow();
    return records_[size_++];
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
    capacity_ = 2 * capacity_ + 16;
    records_.resize(capacity_);
  }

  std::vector<Record> records_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;  // what records_ holds
};

}  // namespace alcove::framegraph
