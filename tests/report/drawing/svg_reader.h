#pragma once

#include <expat.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace retrace::testing {

/// An element of an SVG drawing, and the group that contains it.
struct SvgElement {
  std::string name;
  std::string group;  ///< id of the group
  std::map<std::string, std::string> attributes;
  std::string text;
};

struct SvgPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Returns all elements of an SVG document in order. Returns an empty list if the document is not well-formed.
inline std::vector<SvgElement> svg_elements(const std::string& svg) {
  struct State {
    std::vector<SvgElement> elements;
    std::vector<std::size_t> open;
    std::string group;
  } state;
  XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &state);
  XML_SetElementHandler(
      parser,
      [](void* user, const XML_Char* name, const XML_Char** given) {
        auto& s = *static_cast<State*>(user);
        SvgElement element{name, s.group, {}, {}};
        for (; *given != nullptr; given += 2) element.attributes[given[0]] = given[1];
        if (element.name == "g") s.group = element.attributes["id"];
        s.open.push_back(s.elements.size());
        s.elements.push_back(std::move(element));
      },
      [](void* user, const XML_Char*) { static_cast<State*>(user)->open.pop_back(); });
  XML_SetCharacterDataHandler(parser, [](void* user, const XML_Char* text, int length) {
    auto& s = *static_cast<State*>(user);
    s.elements[s.open.back()].text.append(text, static_cast<std::size_t>(length));
  });
  const bool is_read = XML_Parse(parser, svg.data(), static_cast<int>(svg.size()), 1) == XML_STATUS_OK;
  XML_ParserFree(parser);
  return is_read ? state.elements : std::vector<SvgElement>{};
}

/// Returns the points of a path that consists of straight lines.
inline std::vector<SvgPoint> svg_points(const SvgElement& path) {
  std::string numbers = path.attributes.at("d");
  for (char& c : numbers)
    if (c == 'M' || c == 'L' || c == 'Z' || c == ',') c = ' ';
  std::istringstream stream(numbers);
  std::vector<SvgPoint> points;
  for (SvgPoint p; stream >> p.x >> p.y;) points.push_back(p);
  return points;
}

}  // namespace retrace::testing
