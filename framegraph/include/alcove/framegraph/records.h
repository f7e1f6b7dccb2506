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
  // The value after the last one may belong to an older frame than the others and is removed.
  void clear() {
    values_[size_] = {};
    size_ = 0;
  }

  // next() returns the element after the last one. Its memory always exists, and usually still
  // holds the record that an earlier frame declared there. repeat() appends this element as it is;
  // it may be called only if is_full() is false.
  Value& next() { return values_[size_]; }
  bool is_full() const { return size_ == capacity_; }
  void repeat() { ++size_; }
  void reserve(std::size_t size) {
    if (size <= capacity_) return;
    values_.resize(size + 1);
    capacity_ = size;
  }
  // Appends a value. Returns whether it differs from the one that was at its place before.
  bool add(const Value& value) {
    if (is_full()) reserve(2 * size_ + 16);
    const bool differs = !(values_[size_] == value);
    values_[size_++] = value;
    return differs;
  }

 private:
  std::vector<Value> values_ = std::vector<Value>(1);
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;  // one less than values_ holds
};

}  // namespace alcove::framegraph
