#include "render/settings_json.h"

#include <nlohmann/json.hpp>

#include "alcove/passes/setting_table.h"

namespace alcove::sample {

nlohmann::ordered_json to_json(const OcclusionSettings& settings) {
  using Kind = passes::SettingInfo::Kind;
  nlohmann::ordered_json json;
  for (const passes::SettingInfo& info : passes::setting_table()) {
    if (info.of_material) continue;
    const auto number = passes::setting_value<std::uint32_t>(settings, info);
    if (info.kind == Kind::real)
      json[info.name] = passes::setting_value<float>(settings, info);
    else if (info.kind == Kind::whole)
      json[info.name] = number;
    else if (info.choices.front() == "false")
      json[info.name] = number != 0;
    else
      json[info.name] = passes::setting_text(settings, info);
  }
  json["bent_normal"] = settings.bent_normal;
  return json;
}

}  // namespace alcove::sample
