// Views of every kind of projection.
#pragma once

#include <string>
#include <vector>

#include "pass_fixture.h"

namespace alcove::passes {

struct TestView {
  std::string name;
  AlcoveCamera view{};
  bool orthographic = false;
};

// Returns one view of each kind: perspective (finite, infinite, reversed, off-centre, jittered,
// flipped in Y) and orthographic.
std::vector<TestView> test_views();

// `scale_x` and `scale_y` are the cotangents of half the fields of view. `far` may be infinite.
TestView perspective_view(std::string name, double scale_x, double scale_y, double near, double far,
                          bool reversed);
TestView orthographic_view(std::string name, double half_width, double half_height, double near,
                           double far);

// Returns a view of a part of `view`'s image: of its `width` columns, the `count` columns from
// column `first` on.
TestView columns_of(TestView view, std::uint32_t width, std::uint32_t first, std::uint32_t count);

}  // namespace alcove::passes
