// A growing array for records that are declared again in every frame.
#pragma once

#include <cstddef>
#include <vector>

namespace alcove::framegraph {

// An array of plain values. clear() leaves the values in memory: the next frame mostly declares the
// same ones, and comparing a value with the one that is there costs less than writing it.
template <typename Value>
class Records {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Value* data() const { return values_.data(); }
  const Value* begin() const { return data(); }
  const Value* end() const { return data() + size_; }
  const Value& operator[](std::size_t index) const { return values_[index]; }
  Value& operator[](std::size_t index) { return values_[index]; }

  void clear() { size_ = 0; }
  bool is_full() const { return size_ == capacity_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t next_capacity() const { return 2 * size_ + 16; }
  void grow() {
    const std::size_t capacity = next_capacity();
    values_.resize(capacity + 1);
    capacity_ = capacity;
  }

  // next() returns the element after the last one. Its memory always exists, and usually still
  // holds the record that an earlier frame declared there. repeat() appends this element as it is;
  // it may be called only if is_full() is false.
  Value& next() { return values_[size_]; }
  void repeat() { ++size_; }

 private:
  std::vector<Value> values_ = std::vector<Value>(1);
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;  // one less than values_ holds
};

}  // namespace alcove::framegraph
