// Validation: checks a declaration by following versions and contents through the passes in order
// of declaration.
#include "validate.h"

#include <algorithm>

namespace alcove::framegraph {
namespace {

constexpr VkAccessFlags2 kAttachmentBits =
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

// Returns whether an access reads contents that must exist. An attachment does not need contents:
// if nothing wrote it, it is cleared or left undefined instead of loaded.
constexpr bool reads_contents(const AccessRecord& access) {
  if (!(access.flags & kWrite)) return true;
  return !(access.flags & kDiscard) && (access.access & kWriteBits) != 0 &&
         (access.access & ~(kWriteBits | kAttachmentBits)) != 0;
}

// Returns whether an access writes a part of contents that must exist.
constexpr bool keeps_contents(const AccessRecord& access) {
  return (access.flags & (kWrite | kDiscard)) == kWrite && (access.access & kWriteBits) != 0 &&
         (access.access & kAttachmentBits) == 0;
}

class Replay {
 public:
  explicit Replay(Validation& validation) : v_(validation), s_(validation.workspace.validate) {}

  void run() {
    begin();
    for (std::uint32_t pass = 0; pass < v_.graph.passes.size(); ++pass) {
      forbidden_ = forbidden_stages(v_.graph.passes[pass].queue);
      for (const AccessRecord& access : v_.graph.pass_accesses(pass)) visit(pass, access);
    }
    for (const OutputRecord& output : v_.graph.outputs) check_output(output);
  }

 private:
  void begin() {
    const auto& first = v_.workspace.first_sub;
    s_.versions.assign(v_.graph.resources.size(), 0);
    s_.touches.assign(first.back(), {});
    v_.plan.contents.assign(v_.graph.accesses.size(), 0);
    for_each_external(v_.graph, [&](std::uint32_t r, const auto&, const ExternalRecord& external) {
      for (std::uint32_t sub = first[r]; external.has_contents && sub < first[r + 1]; ++sub)
        s_.touches[sub].written = true;
    });
  }

  // Returns whether an access is valid and of the usual kind: to all of a transient.
  bool is_usual(const AccessRecord& access) const {
    constexpr std::uint32_t kProblems = kNull | kForeign | kClosed;
    if ((access.flags & (kProblems | kWhole)) != kWhole) return false;
    const ResourceRecord& r = v_.graph.resources[access.resource];
    const FormatOracle& formats = v_.limits.formats;
    return r.external == kNone && access.kind() == r.kind && access.stages != 0 &&
           (access.stages & forbidden_) == 0 && access.access != 0 &&
           can_make(access.stages, access.access) &&
           ((access.access & kWriteBits) != 0) == ((access.flags & kWrite) != 0) &&
           (r.kind == ResourceKind::buffer ||
            (layout_is_usable(access.layout) &&
             !(formats.query && access.usage & ~formats.query(formats.context, r.format))));
  }

  void visit(std::uint32_t pass, const AccessRecord& access) {
    if (!is_usual(access) && !validate_access(v_, pass, access)) return;
    std::uint32_t& version = s_.versions[access.resource];
    if (access.version != version) stale(pass, access, version);
    if (access.flags & kWrite) ++version;
    const auto& first = v_.workspace.first_sub;
    if (first[access.resource] == first[access.resource + 1]) return;  // its description is invalid
    EarlierContents earlier;
    for_each_sub(v_.graph, v_.workspace, access,
                 [&](std::uint32_t sub) { touch(pass, access, s_.touches[sub], earlier); });
    // The contents are those of passes that run, because an attachment also reads them.
    if ((access.access & kAttachmentBits) != 0 && earlier.written && !(access.flags & kDiscard))
      v_.plan.contents[static_cast<std::size_t>(&access - v_.graph.accesses.data())] = kHasContents;
    if (earlier.conflict) report_conflict(pass, access);
    if (earlier.unwritten) report_unwritten(pass, access);
    if (!earlier.written && !earlier.unwritten && keeps_contents(access)) report_kept(pass, access);
  }

  // The contents of the range of an access, before the access.
  struct EarlierContents {
    bool unwritten = false;  // it reads contents that nothing wrote
    bool conflict = false;   // its pass has another access that it excludes
    bool written = false;    // there are contents
  };

  static void touch(std::uint32_t pass, const AccessRecord& access, Workspace::Touch& touched,
                    EarlierContents& earlier) {
    const bool again = touched.stamp == pass + 1;
    const bool reads = again && touched.reads;
    const bool writes = again && touched.writes;
    earlier.written |= touched.written;
    if (access.flags & kWrite) {
      earlier.conflict |= reads || writes;
      earlier.unwritten |= !touched.written && reads_contents(access);
      touched = {pass + 1, access.layout, reads, true, true};
    } else {
      earlier.conflict |= writes || (reads && touched.layout != access.layout);
      earlier.unwritten |= !touched.written;
      touched = {pass + 1, access.layout, true, writes, touched.written};
    }
  }

  void report_conflict(std::uint32_t pass, const AccessRecord& access) {
    const bool writes = (access.flags & kWrite) != 0;
    bool other_writes = false;
    for_each_sub(v_.graph, v_.workspace, access,
                 [&](std::uint32_t sub) { other_writes |= !writes || !s_.touches[sub].reads; });
    if (writes && other_writes) {
      v_.fail(ErrorCode::two_writers, pass, access,
              "writes a subresource of " + v_.resource_text(access.resource) +
                  " twice: declare one write that does both");
    } else {
      v_.fail(ErrorCode::read_and_write, pass, access,
              "uses a subresource of " + v_.resource_text(access.resource) +
                  " in two accesses that exclude each other: read and write it in one access that "
                  "does both, or in disjoint mips or layers, and read it in one layout");
    }
  }

  void report_unwritten(std::uint32_t pass, const AccessRecord& access) {
    const ResourceRecord& resource = v_.graph.resources[access.resource];
    if (resource.origin == Origin::history && resource.slot != 0) {
      if (history_is_written(access.resource - resource.slot)) return;
      v_.fail(ErrorCode::history_never_written, pass, access,
              "reads " + v_.resource_text(access.resource) + " of " +
                  std::to_string(resource.slot) +
                  " frame(s) ago, but no frame wrote it and no pass of this one writes it: write "
                  "its current slot");
      return;
    }
    v_.fail(ErrorCode::read_before_write, pass, access,
            (access.flags & kWrite ? "reads and writes " : "reads ") +
                v_.resource_text(access.resource) + " version " + std::to_string(access.version) +
                ", parts of which nothing has written: write it in an earlier pass" +
                (resource.origin == Origin::imported ? ", or import it with its contents" : ""));
  }

  void report_kept(std::uint32_t pass, const AccessRecord& access) {
    v_.fail(ErrorCode::read_before_write, pass, access,
            "writes " + v_.resource_text(access.resource) +
                " and keeps its earlier contents (Contents::keep, the default), but nothing has "
                "written any: write it with Contents::discard" +
                (v_.graph.resources[access.resource].origin == Origin::imported
                     ? ", or import it with its contents"
                     : ""));
  }

  bool history_is_written(std::uint32_t current) const {
    return std::any_of(v_.graph.accesses.begin(), v_.graph.accesses.end(),
                       [current](const AccessRecord& access) {
                         return access.resource == current && (access.flags & kWrite);
                       });
  }

  // Returns the pass that wrote version `version` + 1, or kNone.
  std::uint32_t writer_of(std::uint32_t resource, std::uint32_t version) const {
    for (std::uint32_t pass = 0; pass < v_.graph.passes.size(); ++pass) {
      for (const AccessRecord& access : v_.graph.pass_accesses(pass))
        if (access.resource == resource && access.version == version && (access.flags & kWrite))
          return pass;
    }
    return kNone;
  }

  void stale(std::uint32_t pass, const AccessRecord& access, std::uint32_t expected) {
    const std::uint32_t writer = writer_of(access.resource, access.version);
    const bool writes = (access.flags & kWrite) != 0;
    v_.fail(
        ErrorCode::stale_handle, pass, access,
        (writes ? "writes " : "reads ") + v_.resource_text(access.resource) + " version " +
            std::to_string(access.version) + ", but the version then is " +
            std::to_string(expected) +
            (writer != kNone && writer != pass
                 ? ": " + v_.pass_text(writer) + " consumed it, use the handle its write returned"
                 : ": use the handle that the last write returned"));
  }

  void check_output(const OutputRecord& output) {
    if (output.flags == kStaleBuilder) {
      v_.fail(ErrorCode::closed_pass,
              "a PassBuilder of a frame before reset() was used: add the pass anew in this frame");
      return;
    }
    if (output.flags != 0) {
      v_.fail(output.flags & kNull ? ErrorCode::null_handle : ErrorCode::foreign_handle,
              "an output is given by a handle that is null, or of another graph or frame: pass one "
              "that the graph gave in this frame");
      return;
    }
    const std::uint32_t version = s_.versions[output.resource];
    if (output.version != version) {
      v_.fail(ErrorCode::stale_handle,
              "output " + v_.resource_text(output.resource) + " is given as version " +
                  std::to_string(output.version) + ", but the last is " + std::to_string(version) +
                  ": pass the handle that the last write returned",
              kNone, output.resource, output.version);
      return;
    }
    const auto& first = v_.workspace.first_sub;
    const auto begin = s_.touches.begin() + first[output.resource];
    const auto end = s_.touches.begin() + first[output.resource + 1];
    if (begin != end &&
        std::none_of(begin, end, [](const Workspace::Touch& touched) { return touched.written; }))
      v_.fail(ErrorCode::read_before_write,
              "output " + v_.resource_text(output.resource) +
                  " is written by no pass: write it, or do not ask for it",
              kNone, output.resource, output.version);
  }

  Validation& v_;
  Workspace::Validate& s_;
  VkPipelineStageFlags2 forbidden_ = 0;  // of this pass
};

}  // namespace

bool validate(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan,
              Errors& errors) {
  Validation validation{graph, limits, workspace, plan, errors};
  validate_resources(validation);
  Replay(validation).run();
  return errors.empty();
}

}  // namespace alcove::framegraph
