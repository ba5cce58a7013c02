#include <tinyxml2.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/text.hpp"

namespace relative_map::core {

namespace {

using tinyxml2::XMLElement;

[[noreturn]] void fail(const XMLElement& element, const std::string& what) {
  throw std::runtime_error("line " + std::to_string(element.GetLineNum()) + ": " + what);
}

/// Whether the element is `name`, under whatever prefix its namespace has.
bool is(const XMLElement& element, const std::string& name) {
  const std::string own = element.Name();
  const std::size_t colon = own.find(':');
  return own.compare(colon == std::string::npos ? 0 : colon + 1, std::string::npos, name) == 0;
}

std::vector<const XMLElement*> children(const tinyxml2::XMLNode& parent, const std::string& name) {
  std::vector<const XMLElement*> found;
  for (const XMLElement* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (is(*child, name)) found.push_back(child);
  }
  return found;
}

double number(const XMLElement& element, const std::string& name, const char* text) {
  const std::optional<double> value = parse_number(text);
  if (!value) fail(element, name + ": " + not_a_number(text));
  return *value;
}

GeoPoint parse_point(const XMLElement& element) {
  const char* const latitude = element.Attribute("lat");
  const char* const longitude = element.Attribute("lon");
  if (latitude == nullptr || longitude == nullptr) fail(element, "a point lacks lat or lon");
  GeoPoint point;
  point.latitude = number(element, "lat", latitude);
  point.longitude = number(element, "lon", longitude);
  point.altitude = std::numeric_limits<double>::quiet_NaN();
  for (const XMLElement* altitude : children(element, "ele")) {
    const char* const text = altitude->GetText();
    if (text != nullptr && !trimmed(text).empty()) point.altitude = number(*altitude, "ele", text);
  }
  return point;
}

/// Of a track, or a route.
GeoLine parse_line(const XMLElement& element) {
  GeoLine line;
  for (const XMLElement* point : children(element, "rtept")) line.points.push_back(parse_point(*point));
  for (const XMLElement* segment : children(element, "trkseg")) {
    const std::vector<const XMLElement*> points = children(*segment, "trkpt");
    if (!line.points.empty() && !points.empty()) line.parts.push_back(line.points.size());
    for (const XMLElement* point : points) line.points.push_back(parse_point(*point));
  }
  for (const XMLElement* description : children(element, "desc")) {
    const char* const text = description->GetText();
    if (text != nullptr && std::string(text).rfind("{\"header\"", 0) == 0)
      line.header = parse_line_header(text);
  }
  return line;
}

GeoLine parse(const tinyxml2::XMLDocument& document) {
  const std::vector<const XMLElement*> roots = children(document, "gpx");
  if (roots.empty()) throw std::runtime_error("is no GPX file: it has no element 'gpx'");
  std::vector<GeoLine> lines;
  std::size_t empty = 0;
  for (const char* name : {"trk", "rte"}) {
    for (const XMLElement* element : children(*roots.front(), name)) {
      GeoLine line = parse_line(*element);
      if (line.points.empty()) {
        ++empty;
      } else {
        lines.push_back(std::move(line));
      }
    }
  }
  if (lines.size() == 1) return lines.front();
  if (lines.empty() && empty > 0) throw std::runtime_error("has no points");
  throw std::runtime_error("has " + std::to_string(lines.size()) +
                           " tracks and routes with points, but must have one");
}

std::string degrees(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(13) << value;
  return text.str();
}

}  // namespace

GeoLine read_gpx(const std::string& path) {
  const std::string content = read_text(path);
  if (trimmed(content).empty()) throw std::runtime_error(path + ": has no points");
  tinyxml2::XMLDocument document;
  if (document.Parse(content.data(), content.size()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(path + ": is no whole XML file, from line " +
                             std::to_string(document.ErrorLineNum()) + " on");
  }
  try {
    return parse(document);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
}

std::string to_gpx(const std::string& name, const GeoLine& line) {
  tinyxml2::XMLPrinter out;
  out.PushHeader(false, true);
  out.OpenElement("gpx");
  out.PushAttribute("version", "1.1");
  out.PushAttribute("creator", "relative_map");
  out.PushAttribute("xmlns", "http://www.topografix.com/GPX/1/1");
  out.OpenElement("trk");
  const auto push_text = [&out](const char* element, const std::string& text) {
    out.OpenElement(element);
    out.PushText(text.c_str());
    out.CloseElement();
  };
  push_text("name", name);
  if (!is_empty(line.header)) push_text("desc", to_json(line.header));
  out.OpenElement("trkseg");
  for (const GeoPoint& point : line.points) {
    out.OpenElement("trkpt");
    out.PushAttribute("lat", degrees(point.latitude).c_str());
    out.PushAttribute("lon", degrees(point.longitude).c_str());
    if (std::isfinite(point.altitude)) push_text("ele", degrees(point.altitude));
    out.CloseElement();
  }
  for (int open = 0; open < 3; ++open) out.CloseElement();
  return out.CStr();
}

}  // namespace relative_map::core
