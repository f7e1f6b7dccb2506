// Random inputs whose seed is logged, and replayed with ALCOVE_TEST_SEED.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/glm.hpp>
#include <iostream>
#include <random>

namespace alcove::maths_test {

class RandomInput {
 public:
  RandomInput() : RandomInput(choose_seed()) {
    ::testing::Test::RecordProperty("seed", std::to_string(seed_));
    std::cout << "seed " << seed_ << " (replay with ALCOVE_TEST_SEED)\n";
  }

  // Always the same inputs, and nothing logged.
  explicit RandomInput(unsigned seed) : seed_(seed), engine_(seed) {}

  float uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(engine_);
  }

  // Evenly spread over powers, for lengths of every size.
  float log_uniform(float low, float high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }

  unsigned bits() { return static_cast<unsigned>(engine_()); }

  glm::vec3 unit_vector() {
    const float z = uniform(-1.0f, 1.0f), phi = uniform(0.0f, 6.2831853f);
    const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return glm::normalize(glm::vec3(radius * std::cos(phi), radius * std::sin(phi), z));
  }

  // Unit, within a right angle of `axis`.
  glm::vec3 facing(glm::vec3 axis) {
    const glm::vec3 v = unit_vector();
    return glm::dot(v, axis) < 0.0f ? -v : v;
  }

 private:
  static unsigned choose_seed() {
    const char* given = std::getenv("ALCOVE_TEST_SEED");
    return given != nullptr ? static_cast<unsigned>(std::strtoul(given, nullptr, 10))
                            : std::random_device{}();
  }

  unsigned seed_;
  std::mt19937 engine_;
};

}  // namespace alcove::maths_test
