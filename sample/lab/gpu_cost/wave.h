// The instructions that one wave executes: the basic blocks of the compiled shader, times the
// number of times that each of them runs.
//
// The compiler's own figures assume that every loop runs 8 times and that branches are taken 50 %
// or 75 % of the time. Here each loop runs as often as its pass declares, and every branch is
// taken, so divergent branches count in full.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu_cost/null_device.h"
#include "gpu_cost/pass_work.h"
#include "support/result.h"

namespace alcove::sample {

// Sums over all instructions that a wave executes.
struct WaveWork {
  double instructions = 0;
  double vector_instructions = 0;
  double scalar_instructions = 0;
  double transcendentals = 0;    // reciprocals, roots, exponentials and the like
  double selects = 0;            // v_cndmask
  double loads = 0;              // image loads, samples and gathers
  double stores = 0;             // image stores
  double shared_operations = 0;  // on shared memory (LDS)
  double shared_words = 0;       // 32-bit words that each lane moves by shared_operations
  // Cycles of a SIMD's execution units, and of its compute unit's texture unit.
  double vector_cycles = 0;
  double complex_cycles = 0;  // of the unit for transcendentals (RDNA)
  double scalar_cycles = 0;
  double branch_cycles = 0;
  double memory_cycles = 0;
  double texture_cycles = 0;
  // The cycles of the busiest execution unit.
  double busiest() const;
};

struct Instruction {
  std::string operation;
  double result_words = 1;  // 32-bit words that a lane loads or stores
  std::uint32_t repeats = 1;
};

struct BasicBlock {
  std::uint32_t index = 0;
  std::vector<std::uint32_t> predecessors;
  bool branches = false;  // ends with a divergent branch
  bool inverts = false;   // stands between the two sides of a divergent branch
  bool merges = false;    // follows the sides of a divergent branch
  std::vector<Instruction> instructions;
};

// Returns the basic blocks of a shader in the order of the code. Errors: the driver gave no text,
// or the text does not have the format of Mesa's AMD compiler (ACO).
[[nodiscard]] Result<std::vector<BasicBlock>> parse_blocks(const CompiledShader& shader);

// A loop, which consists of the blocks from `first` to `last`.
struct Loop {
  CompiledLoop summary;
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  double iterations = 1;  // each time that it is entered
};
[[nodiscard]] std::vector<Loop> find_loops(const std::vector<BasicBlock>& blocks);

// One side of a divergent branch: the blocks from `first` to `last`.
struct Branch {
  CompiledBranch summary;
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  double share = 1;  // of the waves that execute it
};
[[nodiscard]] std::vector<Branch> find_branches(const std::vector<BasicBlock>& blocks);

[[nodiscard]] WaveWork wave_work(const std::vector<BasicBlock>& blocks,
                                 const std::vector<Loop>& loops,
                                 const std::vector<Branch>& branches, bool rdna,
                                 std::uint32_t wave);

}  // namespace alcove::sample
