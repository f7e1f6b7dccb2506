// Prints a plan for Graphviz: passes coloured by queue, an edge from each pass to the passes that
// use what it wrote, and culled passes with dashed borders.
#include <map>
#include <vector>

#include "alcove/framegraph/print.h"
#include "print_names.h"

namespace alcove::framegraph {
namespace {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out + '"';
}

class DotPrinter {
 public:
  DotPrinter(const GraphDescription& graph, const Plan& plan)
      : graph_(graph), plan_(plan), names_(resource_names(graph)) {}

  std::string print() {
    out_ =
        "digraph frame {\n"
        "  rankdir=TB; nodesep=0.3; ranksep=0.35;\n"
        "  node [shape=box fontname=\"sans-serif\" fontsize=11 height=0.3];\n"
        "  edge [fontname=\"sans-serif\" fontsize=9 arrowsize=0.6];\n";
    position_.assign(graph_.passes.size(), kNone);
    for (std::uint32_t p = 0; p < plan_.passes.size(); ++p) position_[plan_.passes[p].pass] = p;
    for (std::uint32_t pass = 0; pass < graph_.passes.size(); ++pass) node(pass);
    edges();
    return std::move(out_) + "}\n";
  }

 private:
  static std::string id(std::uint32_t pass) {
    return std::string("p").append(std::to_string(pass));
  }

  void node(std::uint32_t pass) {
    std::string label(graph_.pass_name(pass));
    std::string style = "style=dashed color=gray fontcolor=gray";
    if (position_[pass] != kNone) {
      const PlannedPass& planned = plan_.passes[position_[pass]];
      const std::uint32_t barriers =
          planned.batch == kNone ? 0 : plan_.batches[planned.batch].count;
      label = std::to_string(position_[pass]).append(" ").append(label);
      if (barriers > 0) label.append(" | ").append(std::to_string(barriers)).append(" barriers");
      constexpr const char* kColors[] = {"lightsteelblue", "palegreen", "moccasin"};
      style = std::string("style=filled fillcolor=")
                  .append(kColors[static_cast<std::size_t>(planned.queue)]);
    }
    out_.append("  ").append(id(pass)).append(" [label=").append(quoted(label));
    out_.append(" tooltip=").append(quoted(reason(graph_, plan_.cull_reasons[pass])));
    out_.append(" ").append(style).append("];\n");
  }

  // Draws one edge from each pass that last wrote something which a pass uses.
  void edges() {
    std::vector<std::uint32_t> writer(graph_.resources.size(), kNone);
    for (std::uint32_t pass = 0; pass < graph_.passes.size(); ++pass) {
      std::map<std::uint32_t, std::string> labels;  // key: the pass that wrote
      for (const AccessRecord& access : graph_.pass_accesses(pass)) {
        const std::uint32_t from = writer[access.resource];
        if (from == kNone || from == pass || (access.flags & kDiscard)) continue;
        std::string& label = labels[from];
        if (!label.empty()) label += '\n';
        label.append(names_[access.resource]).append(".").append(std::to_string(access.version));
      }
      for (const auto& [from, label] : labels) edge(from, pass, label);
      for (const AccessRecord& access : graph_.pass_accesses(pass))
        if (access.flags & kWrite) writer[access.resource] = pass;
    }
  }

  void edge(std::uint32_t from, std::uint32_t to, const std::string& label) {
    out_.append("  ").append(id(from)).append(" -> ").append(id(to));
    out_.append(" [label=").append(quoted(label));
    if (position_[from] == kNone || position_[to] == kNone) out_ += " style=dashed color=gray";
    out_ += "];\n";
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  std::vector<std::string> names_;
  std::vector<std::uint32_t> position_;
  std::string out_;
};

}  // namespace

std::string print_dot(const GraphDescription& graph, const Plan& plan) {
  return DotPrinter(graph, plan).print();
}

}  // namespace alcove::framegraph
