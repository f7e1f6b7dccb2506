// Reads settings from JSON.
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "alcove/passes/setting_table.h"
#include "c/failure.h"
#include "c/settings.h"

namespace alcove::passes {
namespace {

constexpr std::size_t kMostBytes = 65536;
constexpr std::size_t kMostShown = 60;  // bytes of the text in a sentence
constexpr int kMostDepth = 32;          // of objects in objects that are skipped

// Returns the beginning of a text for a sentence, without bytes that cannot be printed.
std::string shown(std::string_view text) {
  std::string result(text.substr(0, kMostShown));
  for (char& byte : result) byte = byte >= ' ' && byte <= '~' ? byte : '?';
  return result;
}

// A reader of the part of JSON that settings need. A function that fails leaves the reader where
// it is, and all later ones fail too.
class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : text_(text) {}

  bool take(char wanted) {
    skip_space();
    if (at_ < text_.size() && text_[at_] == wanted) {
      ++at_;
      return true;
    }
    return false;
  }

  bool at_end() {
    skip_space();
    return at_ == text_.size();
  }

  // A string without its quotes. Escapes are kept as they are: no setting has one in its name.
  std::optional<std::string_view> string() {
    if (!take('"')) return std::nullopt;
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    if (at_ >= text_.size()) return std::nullopt;
    return text_.substr(begin, at_++ - begin);
  }

  // A string, a number, true, false or null, as text.
  std::optional<std::string_view> scalar() {
    skip_space();
    if (at_ < text_.size() && text_[at_] == '"') return string();
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n,:{}[]\"").find(text_[at_]) == std::string_view::npos)
      ++at_;
    return at_ > begin ? std::optional(text_.substr(begin, at_ - begin)) : std::nullopt;
  }

  // Any value.
  bool skip(int depth = 0) {
    for (const auto& [open, close] : {std::pair('{', '}'), std::pair('[', ']')})
      if (take(open))
        return depth < kMostDepth && (take(close) || skip_members(open == '{', close, depth));
    return scalar().has_value();
  }

  // The members of an object: calls `visit(name)`, which reads the value.
  template <typename Visit>
  bool object(const Visit& visit) {
    if (!take('{')) return false;
    if (take('}')) return true;
    do {
      const auto name = string();
      if (!name || !take(':') || !visit(*name)) return false;
    } while (take(','));
    return take('}');
  }

 private:
  void skip_space() {
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }

  bool skip_members(bool named, char close, int depth) {
    do {
      if ((named && (!string() || !take(':'))) || !skip(depth + 1)) return false;
    } while (take(','));
    return take(close);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

// Parses the value of a setting. Returns an empty text, or the values that are allowed.
template <typename Value>
std::string parse(std::string_view text, const SettingInfo& info, Value& value) {
  if constexpr (std::is_same_v<Value, float> || std::is_same_v<Value, std::uint32_t>) {
    Value read = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error == std::errc() && end == text.data() + text.size() && info.range.contains(read)) {
      value = read;
      return {};
    }
    return std::string(std::is_same_v<Value, float> ? "a number, " : "a whole number, ") +
           info.range.text();
  } else {
    const auto found = std::ranges::find(kNames<Value>, text);
    if (found != kNames<Value>.end()) {
      value = static_cast<Value>(found - kNames<Value>.begin());
      return {};
    }
    return names_text<Value>();
  }
}

// Changes one setting.
Result change(OcclusionSettings& settings, std::string_view name, std::string_view text) {
  Result result = invalid("The settings name '" + shown(name) + "', which is no setting.");
  for_each_setting(settings, [&](const SettingInfo& info, auto& field) {
    if (name == info.name) {
      const std::string wanted = parse(text, info, field);
      result = wanted.empty() ? Result()
                              : invalid("The setting '" + std::string(name) + "' is " +
                                        shown(text) + "; it must be " + wanted + ".");
    }
  });
  return result;
}

tl::expected<OcclusionSettings, Failure> read(std::string_view text, OcclusionSettings settings) {
  const auto no_settings = invalid(
      "The text holds no settings; give the contents of a file that `alcove recommend --out` "
      "wrote.");
  if (text.size() > kMostBytes) return no_settings;
  JsonReader reader(text);
  bool found = false;
  Result changed;
  const bool complete = reader.object([&](std::string_view member) {
    if (member != "settings" || found) return reader.skip();
    found = true;
    return reader.object([&](std::string_view name) {
      const auto value = reader.scalar();
      if (value) changed = change(settings, name, *value);
      return value && changed;
    });
  });
  if (!changed) return tl::unexpected(changed.error());
  if (!complete || !found || !reader.at_end()) return no_settings;
  if (auto good = validate(settings); !good) return invalid(std::move(good.error().message));
  return settings;
}

Result read(const char* text, std::size_t length, AlcoveSettings* settings) {
  if (text == nullptr) return invalid("There is no text of settings.");
  return to_settings(settings)
      .and_then([&](const OcclusionSettings& known) {
        return read({text, length}, known);
      })
      .map([&](const OcclusionSettings& found) {
        const AlcoveSpecular specular = settings->specular;
        *settings = from_settings(found);
        settings->specular = found.specular == Specular::none ? specular : settings->specular;
      });
}

}  // namespace
}  // namespace alcove::passes

using namespace alcove::passes;

AlcoveResult alcoveReadSettings(const char* text, size_t length, AlcoveSettings* settings,
                                char* message) {
  Message said{};
  const AlcoveResult result = guarded(said, [&] { return read(text, length, settings); });
  copy_text(result == ALCOVE_SUCCESS ? "" : said.data(), message,
            message == nullptr ? 0 : said.size());
  return result;
}
