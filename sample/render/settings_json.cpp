#include "render/settings_json.h"

#include <nlohmann/json.hpp>

#include "alcove/passes/setting_table.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

Json show(float value) { return value; }
Json show(std::uint32_t value) { return value; }
Json show(bool value) { return value; }
template <typename Choice>
Json show(Choice value) {
  return passes::name_of(value);
}

}  // namespace

Json to_json(const passes::OcclusionSettings& settings) {
  Json json;
  passes::for_each_setting(settings, [&](const passes::SettingInfo& info, const auto& field) {
    if (info.group != passes::SettingGroup::surface) json[info.name] = show(field);
  });
  return json;
}

}  // namespace alcove::sample
