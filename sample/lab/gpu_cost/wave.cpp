#include "gpu_cost/wave.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <sstream>
#include <string_view>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

bool starts_with_any(std::string_view text, std::initializer_list<std::string_view> beginnings) {
  return std::ranges::any_of(
      beginnings, [text](std::string_view beginning) { return text.starts_with(beginning); });
}

// The encoding suffixes of the disassembly do not affect the cost.
std::string_view without_encoding(std::string_view operation) {
  for (const std::string_view suffix : {"_e32", "_e64", "_sdwa", "_dpp"})
    if (operation.ends_with(suffix)) operation.remove_suffix(suffix.size());
  return operation;
}

bool is_transcendental(std::string_view operation) {
  return starts_with_any(operation,
                         {"v_rcp", "v_rsq", "v_sqrt", "v_exp_", "v_log_", "v_sin_", "v_cos_"}) &&
         (operation.ends_with("_f32") || operation.ends_with("_f16"));
}

bool is_slow_multiply(std::string_view operation) {
  return starts_with_any(operation, {"v_mul_lo_", "v_mul_hi_"});
}

bool is_64_bit(std::string_view operation) {
  return std::ranges::any_of(
      std::array<std::string_view, 4>{"_f64", "_b64", "_u64", "_i64"},
      [&](std::string_view type) { return operation.find(type) != std::string_view::npos; });
}

// Conversions on GCN run at a quarter of the rate, by LLVM's tables; unpacking bytes does not.
bool is_conversion(std::string_view operation) {
  return operation.starts_with("v_cvt_") &&
         !starts_with_any(operation, {"v_cvt_f32_ubyte", "v_cvt_pk"});
}

// Waits and hints that take no slot of an execution unit.
bool is_free(std::string_view operation) {
  return starts_with_any(
      operation, {"s_waitcnt", "s_nop", "s_inst_prefetch", "s_clause", "s_delay_alu", "v_nop"});
}

std::uint32_t number_at(std::string_view text, std::size_t at) {
  std::uint32_t number = 0;
  std::from_chars(text.data() + std::min(at, text.size()), text.data() + text.size(), number);
  return number;
}

// Returns the number of 32-bit words of an operand: for example four for "v[4:7]", and four for
// "v4:" in the compiler's text before registers are assigned.
double count_words(std::string_view text) {
  const std::string_view first = text.substr(0, text.find(','));
  if (const std::size_t range = first.find("v["); range != std::string_view::npos) {
    const std::size_t colon = first.find(':', range);
    return number_at(first, colon + 1) - number_at(first, range + 2) + 1.0;
  }
  const std::size_t begin = first.find_first_not_of(" \t");
  if (begin != std::string_view::npos && first[begin] == 'v')
    return std::max(1.0, static_cast<double>(number_at(first, begin + 1)));
  return 1.0;
}

std::string_view first_word(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin);
  return text.substr(0, text.find_first_of(" \t\n"));
}

// A line of the compiler's text before registers are assigned: "results = operation operands".
Instruction parse_instruction(std::string_view line) {
  const std::size_t equals = line.find(" = ");
  const std::string_view results =
      equals == std::string_view::npos ? std::string_view{} : line.substr(0, equals);
  std::string operation(
      first_word(equals == std::string_view::npos ? line : line.substr(equals + 3)));
  const std::string_view result = first_word(results);
  if (operation == "p_parallelcopy") {
    // Only some of the copies in "p_parallelcopy" become instructions: most vector copies, and
    // scalar copies of constants. Register allocation removes the others.
    const std::size_t from = line.find("p_parallelcopy ") + 15;
    const bool constant = from < line.size() && (line.substr(from, 2) == "0x" ||
                                                 line[from] == '-' || std::isdigit(line[from]));
    operation = result.starts_with("v") ? "v_mov_b32" : constant ? "s_mov_b32" : operation;
  }
  if (operation == "p_cbranch_z" || operation == "p_cbranch_nz" || operation == "p_branch")
    operation = "s_cbranch";
  return {std::move(operation), count_words(results.empty() ? line : results), 1};
}

// Decodes an instruction that LLVM's disassembler does not support: mostly image instructions with
// their address in nonconsecutive registers.
Instruction decode_instruction(std::uint32_t word) {
  constexpr std::uint32_t kImage = 0x3c;
  constexpr std::uint32_t kScalarMemory = 0x3d;
  if (word >> 26u == kImage) {
    const int lanes = std::popcount(word >> 8u & 15u);
    const bool store = (word >> 18u & 0x7fu) == 8;
    return {store ? "image_store" : "image_load", static_cast<double>(lanes), 1};
  }
  return {word >> 26u == kScalarMemory ? "s_buffer_load" : "", 1, 1};
}

// The block number of a line "BB12" or "BB12:"; none for any other line.
std::optional<std::uint32_t> parse_block_number(std::string_view line) {
  if (!line.starts_with("BB")) return std::nullopt;
  line.remove_prefix(2);
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), index);
  const std::string_view rest(end, line.data() + line.size() - end);
  return error == std::errc() && (rest.empty() || rest == ":") ? std::optional(index)
                                                               : std::nullopt;
}

// "... linear preds: BB3, BB5, / kind: ..."
std::vector<std::uint32_t> parse_predecessors(std::string_view line) {
  std::vector<std::uint32_t> found;
  const std::size_t begin = line.find("linear preds:");
  if (begin == std::string_view::npos) return found;
  std::string_view list = line.substr(begin, line.find("/ kind:") - begin);
  for (std::size_t at = list.find("BB"); at != std::string_view::npos; at = list.find("BB", at + 2))
    found.push_back(number_at(list, at + 2));
  return found;
}

std::vector<BasicBlock> parse_aco(const std::string& text, bool instructions) {
  std::vector<BasicBlock> blocks;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (const auto index = parse_block_number(line)) {
      blocks.push_back({.index = *index});
    } else if (!blocks.empty() && line.starts_with("/* logical preds:")) {
      const std::string_view kind =
          std::string_view(line).substr(std::min(line.find("kind:"), line.size()));
      blocks.back().predecessors = parse_predecessors(line);
      blocks.back().branches = kind.find("branch,") != std::string_view::npos;
      blocks.back().inverts = kind.find("invert,") != std::string_view::npos;
      blocks.back().merges = kind.find("merge,") != std::string_view::npos;
    } else if (!blocks.empty() && line.starts_with("\t") && instructions) {
      blocks.back().instructions.push_back(parse_instruction(line));
    }
  }
  return blocks;
}

void add_disassembly(const std::string& text, std::vector<BasicBlock>& blocks) {
  BasicBlock* block = nullptr;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (const auto index = parse_block_number(line)) {
      block = *index < blocks.size() ? &blocks[*index] : nullptr;
      continue;
    }
    if (block == nullptr) continue;
    if (const std::size_t repeated = line.find("(then repeated ");
        repeated != std::string::npos && !block->instructions.empty()) {
      block->instructions.back().repeats += number_at(line, repeated + 15);
    } else if (line.find("(invalid instruction)") != std::string::npos) {
      const std::size_t words = line.rfind(';');
      const std::string word(first_word(std::string_view(line).substr(words + 1)));
      block->instructions.push_back(
          decode_instruction(static_cast<std::uint32_t>(std::stoul(word, nullptr, 16))));
    } else if (line.starts_with("\t")) {
      const std::string_view code = std::string_view(line).substr(0, line.find(';'));
      block->instructions.push_back(
          {std::string(without_encoding(first_word(code))), count_words(code), 1});
    }
  }
}

// Adds the cycles of a vector instruction by the rules of ACO's statistics (aco_statistics.cpp).
void add_vector(std::string_view operation, bool rdna, double half_waves, double times,
                WaveWork& work) {
  const bool transcendental = is_transcendental(operation);
  const bool slow = is_slow_multiply(operation);
  const bool compares = operation.starts_with("v_cmp");
  work.vector_instructions += times;
  work.transcendentals += transcendental ? times : 0.0;
  work.selects += operation.starts_with("v_cndmask") ? times : 0.0;
  if (rdna) {
    const double rate = slow ? 4.0 : is_64_bit(operation) && !compares ? 2.0 : 1.0;
    work.vector_cycles += rate * half_waves * times;
    work.complex_cycles += transcendental || slow ? 4.0 * half_waves * times : 0.0;
    return;
  }
  const bool quarter =
      is_conversion(operation) || transcendental || slow || operation.starts_with("v_fma_f32");
  work.vector_cycles += (quarter ? 16.0 : is_64_bit(operation) ? 8.0 : 4.0) * times;
}

void add_memory(const Instruction& instruction, bool rdna, std::uint32_t wave, double times,
                WaveWork& work) {
  const std::string_view operation = instruction.operation;
  const bool plain_load = operation.starts_with("image_load");
  if (plain_load || starts_with_any(operation, {"image_sample", "image_gather"}))
    work.loads += times;
  work.stores += operation.starts_with("image_store") ? times : 0.0;
  work.memory_cycles += (rdna ? 1.0 : 4.0) * times;
  // The texture unit processes four lanes a cycle; loads of over 64 bits a lane take twice as long.
  const double wide = plain_load && instruction.result_words > 2 ? 2.0 : 1.0;
  work.texture_cycles += wave / 4.0 * wide * times;
}

// "ds_read2_b64" moves two values of 64 bits for each lane.
double shared_words(std::string_view operation) {
  const double values = starts_with_any(operation, {"ds_read2", "ds_write2"}) ? 2.0 : 1.0;
  const double words = operation.ends_with("_b128")  ? 4.0
                       : operation.ends_with("_b96") ? 3.0
                       : is_64_bit(operation)        ? 2.0
                                                     : 1.0;
  return values * words;
}

void add(const Instruction& instruction, bool rdna, std::uint32_t wave, double times,
         WaveWork& work) {
  const std::string_view operation = instruction.operation;
  if (operation.empty() || operation.starts_with("p_")) return;  // a pseudo instruction
  work.instructions += times;
  work.scalar_instructions += operation.starts_with("s_") ? times : 0.0;
  if (is_free(operation)) {
    work.vector_instructions += operation.starts_with("v_") ? times : 0.0;
  } else if (operation.starts_with("v_")) {
    add_vector(operation, rdna, wave / 32.0, times, work);
  } else if (starts_with_any(operation, {"s_cbranch", "s_branch"})) {
    work.branch_cycles += (rdna ? 1.0 : 8.0) * times;
  } else if (operation.starts_with("s_")) {
    work.scalar_cycles += (rdna ? 1.0 : 4.0) * times;
  } else if (operation.starts_with("ds_")) {
    work.shared_operations += times;
    work.shared_words += shared_words(operation) * times;
    work.memory_cycles += (rdna ? 1.0 : 4.0) * times;
  } else if (starts_with_any(operation, {"image_", "buffer_", "global_", "flat_"})) {
    add_memory(instruction, rdna, wave, times, work);
  }
}

// The instructions of the blocks from `first` to `last`, each once.
WaveWork work_between(const std::vector<BasicBlock>& blocks, std::uint32_t first,
                      std::uint32_t last) {
  WaveWork work;
  for (std::uint32_t i = first; i <= last; ++i)
    for (const Instruction& instruction : blocks[i].instructions)
      add(instruction, false, 64, instruction.repeats, work);
  return work;
}

}  // namespace

double WaveWork::busiest() const {
  return std::max({vector_cycles, complex_cycles, scalar_cycles, branch_cycles, memory_cycles});
}

Result<std::vector<BasicBlock>> parse_blocks(const CompiledShader& shader) {
  const auto aco = shader.texts.find("ACO IR");
  if (aco == shader.texts.end())
    return Failure("The driver gives no 'ACO IR' for its pipelines; Mesa's AMD driver is needed.");
  // LLVM disassembles GFX8 and later; for older GPUs ACO's own text has the instructions.
  const auto assembly = shader.texts.find("Assembly");
  const bool disassembled = assembly != shader.texts.end() && assembly->second.starts_with("BB");
  std::vector<BasicBlock> blocks = parse_aco(aco->second, !disassembled);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].index != i) {
      return Failure(
          fmt::format("The driver's 'ACO IR' has an unknown format: block {} is missing.", i));
    }
  }
  if (disassembled) add_disassembly(assembly->second, blocks);
  if (blocks.empty())
    return Failure("The driver's 'ACO IR' has an unknown format: it has no blocks.");
  return blocks;
}

std::vector<Loop> find_loops(const std::vector<BasicBlock>& blocks) {
  // ACO stores the blocks of a loop consecutively, from the header to the last block that jumps
  // back to it.
  std::vector<Loop> loops;
  for (const BasicBlock& block : blocks) {
    const auto last = std::ranges::max_element(block.predecessors);
    if (last != block.predecessors.end() && *last >= block.index)
      loops.push_back({{}, block.index, *last});
  }
  for (Loop& loop : loops) {
    loop.summary.depth = static_cast<std::uint32_t>(std::ranges::count_if(
        loops, [&](const Loop& o) { return o.first <= loop.first && loop.last <= o.last; }));
    const WaveWork body = work_between(blocks, loop.first, loop.last);
    loop.summary.instructions = static_cast<std::uint32_t>(body.instructions);
    loop.summary.loads = static_cast<std::uint32_t>(body.loads);
  }
  return loops;
}

std::vector<Branch> find_branches(const std::vector<BasicBlock>& blocks) {
  // ACO stores the blocks of a divergent branch in order: the branch, one side, a block that
  // inverts the lanes, the other side, and the block in which both merge.
  std::vector<Branch> branches;
  std::vector<std::uint32_t> open;  // the block before the current side of each nested branch
  const auto end_side = [&](std::uint32_t end) {
    if (end > open.back() + 1) {
      const WaveWork work = work_between(blocks, open.back() + 1, end - 1);
      branches.push_back({{work.instructions, work.loads, work.stores, work.shared_operations},
                          open.back() + 1,
                          end - 1});
    }
    open.back() = end;
  };
  for (const BasicBlock& block : blocks) {
    if ((block.inverts || block.merges) && !open.empty()) end_side(block.index);
    if (block.merges && !open.empty()) open.pop_back();
    if (block.branches) open.push_back(block.index);
  }
  return branches;
}

WaveWork wave_work(const std::vector<BasicBlock>& blocks, const std::vector<Loop>& loops,
                   const std::vector<Branch>& branches, bool rdna, std::uint32_t wave) {
  WaveWork work;
  for (const BasicBlock& block : blocks) {
    double times = 1.0;
    for (const Loop& loop : loops)
      if (loop.first <= block.index && block.index <= loop.last) times *= loop.iterations;
    for (const Branch& branch : branches)
      if (branch.first <= block.index && block.index <= branch.last) times *= branch.share;
    for (const Instruction& instruction : block.instructions)
      add(instruction, rdna, wave, times * instruction.repeats, work);
  }
  return work;
}

}  // namespace alcove::sample
