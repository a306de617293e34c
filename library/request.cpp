#include "retrace/request.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/json_text.h"
#include "requests/descriptions.h"
#include "requests/json.h"

namespace retrace {
namespace {

template <class Request>
void assign_field(Request& request, std::string_view field, const FieldValue& value) {
  const requests::Row* const row = requests::row_of(requests::description<Request>(), field);
  if (row == nullptr) throw InputError(Field{field}, "the request has no field of this name");
  if (std::holds_alternative<std::monostate>(value))
    requests::reset(requests::description<Request>(), *row, &request);
  else
    std::visit([&](const auto& given) { requests::set(*row, &request, schema::Value(given)); }, value);
}

}  // namespace

void assign(DetectorRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(CameraRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(RoadRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(InspectRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(JobRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(FabricationRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(MetrologyRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(SolidRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(MaterialRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(PhotometryRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(RangingRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(RaysRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(TraceRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(RreRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(StudyRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}
void assign(VerificationRequest& request, std::string_view field, const FieldValue& value) {
  assign_field(request, field, value);
}

std::string request_description() {
  return to_text(requests::description_json());
}

std::string python_keyword(std::string_view field) {
  return requests::keyword_of_field(field);
}

}  // namespace retrace
