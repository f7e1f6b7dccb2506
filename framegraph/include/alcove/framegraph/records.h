// A growing array for what is declared anew in every frame.
#pragma once

#include <cstddef>
#include <vector>

namespace alcove::framegraph {

// Plain values, one after the other. clear() leaves them where they are: what is declared again is
// as a rule the same, and comparing it with what is there costs less than writing it.
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

  // What lies at the next place: repeat() makes it the next value, where there is room. There
  // always is such a place, if only to look at.
  Value& next() { return values_[size_]; }
  void repeat() { ++size_; }

 private:
  std::vector<Value> values_ = std::vector<Value>(1);
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;  // one less than values_ holds
};

}  // namespace alcove::framegraph
