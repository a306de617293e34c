#include "app/text_result.h"

#include "app/output.h"
#include "core/json_text.h"
#include "core/version.h"

namespace retrace::app {

ExitCode write_text(const CommonOptions& common, nlohmann::ordered_json document, const std::string& text) {
  CommonOptions outputs = without_folder(common);
  outputs.quiet = common.quiet && !common.out.empty();
  ResultFiles files(outputs, {});
  files.add_named("--out", common.out, [&] { return text; });
  files.prepare();
  document["text"] = text;
  document["version"] = kVersion;
  document["warnings"] = nlohmann::ordered_json::array();
  document["complete"] = true;
  files.write(to_text(document), common.out.empty() ? text : "");
  return ExitCode::done;
}

}  // namespace retrace::app
