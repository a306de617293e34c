#include "studies/quantity/io/study_json.h"

namespace retrace::studies {

nlohmann::ordered_json begin_document(const Study& study) {
  nlohmann::ordered_json json = {{"study", study.source}};
  if (!study.title.empty()) json["title"] = study.title;
  return json;
}

}  // namespace retrace::studies
