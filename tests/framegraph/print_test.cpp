#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "deferred_frame.h"

namespace alcove::framegraph {
namespace {

using testing::HasSubstr;

class Print : public testing::Test {
 protected:
  void SetUp() override {
    declare_deferred_frame(graph_, 1920, 1080);
    (void)graph_.add_pass("nobody \"wants\" this");
    plan_ = *compile(graph_.description());
  }
  Graph graph_;
  Plan plan_;
};

TEST_F(Print, PrintedPlanShowsPassesBarriersCullReasonsAndMemory) {
  const std::string text = print_text(graph_.description(), plan_);
  EXPECT_THAT(text, HasSubstr("lower bound"));
  EXPECT_THAT(text, HasSubstr("g-buffer"));
  EXPECT_THAT(text, HasSubstr("compute -> copy: tonemap general -> transfer source"));
  EXPECT_THAT(text, HasSubstr("side effect: nobody \"wants\" this\n"));
  EXPECT_THAT(text, HasSubstr("memory by offset"));
  EXPECT_THAT(text, HasSubstr("(for 'antialiasing')"));
  // Resources with the same name are distinguished by an index.
  EXPECT_THAT(text, HasSubstr("<bloom down#"));
}

TEST_F(Print, LinesOfAPrintedPlanHaveAtMost120Characters) {
  std::istringstream lines(print_text(graph_.description(), plan_));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

TEST_F(Print, GraphvizOutputHasANodeForEachPass) {
  const std::string dot = print_dot(graph_.description(), plan_);
  for (std::size_t i = 0; i < graph_.description().passes.size(); ++i)
    EXPECT_THAT(dot, HasSubstr(std::string("p").append(std::to_string(i)).append(" [label=")));
  EXPECT_THAT(dot, HasSubstr("style=dashed"));
}

}  // namespace
}  // namespace alcove::framegraph
