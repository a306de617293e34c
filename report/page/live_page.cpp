#include "report/page/live_page.h"

#include <fmt/format.h>

#include "core/base64.h"
#include "core/text.h"
#include "core/version.h"
#include "report/page/html_text.h"

namespace retrace::report {

std::string live_elements(const LiveStart& start, const PageAssets& assets, bool is_embedded) {
  std::string json = fmt::format(R"({{"version":{},"embedded":{})", json_string(kVersion), is_embedded);
  if (!start.toml.empty())
    json += fmt::format(R"(,"toml":{},"source":{})", json_string(start.toml), json_string(start.source));
  return fmt::format(
      "<script type=\"application/json\" id=\"start\">{}}}</script>\n"
      "<script type=\"application/octet-stream\" id=\"engine-wasm\">{}</script>\n"
      "<script type=\"text/plain\" id=\"engine-js\">{}</script>\n",
      json, base64(assets.engine_wasm), assets.engine_script);
}

std::string live_html(const LiveStart& start, const std::string& title, const PageAssets& assets) {
  return html_head(title, assets.style) + fmt::format(
                                              "<body>\n{}<footer>\n<details><summary>Licences of the code in this "
                                              "page</summary><pre>{}</pre></details>\n"
                                              "</footer>\n{}<script>{}</script>\n</body>\n</html>\n",
                                              assets.markup, markup_text(assets.licences),
                                              live_elements(start, assets, false), assets.script);
}

}  // namespace retrace::report
