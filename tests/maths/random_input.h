// Random inputs. They are the same in every run, unless ALCOVE_TEST_SEED gives another seed.
#pragma once

#include <cmath>
#include <cstdlib>
#include <glm/glm.hpp>
#include <random>

namespace alcove::maths_test {

class RandomInput {
 public:
  RandomInput() : RandomInput(environment_seed()) {}

  // Gives the same inputs whatever ALCOVE_TEST_SEED says.
  explicit RandomInput(unsigned seed) : engine_(seed) {}

  float uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(engine_);
  }

  // Returns a number whose logarithm is uniformly distributed, for lengths of all magnitudes.
  float log_uniform(float low, float high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }

  unsigned bits() { return static_cast<unsigned>(engine_()); }

  glm::vec3 unit_vector() {
    const float z = uniform(-1.0f, 1.0f), phi = uniform(0.0f, 6.2831853f);
    const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return glm::normalize(glm::vec3(radius * std::cos(phi), radius * std::sin(phi), z));
  }

  // Returns a random unit vector within 90 degrees of `axis`.
  glm::vec3 facing(glm::vec3 axis) {
    const glm::vec3 v = unit_vector();
    return glm::dot(v, axis) < 0.0f ? -v : v;
  }

 private:
  static unsigned environment_seed() {
    const char* seed = std::getenv("ALCOVE_TEST_SEED");
    return seed != nullptr ? static_cast<unsigned>(std::strtoul(seed, nullptr, 10)) : 1;
  }

  std::mt19937 engine_;
};

}  // namespace alcove::maths_test
