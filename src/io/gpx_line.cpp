#include <tinyxml2.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

using tinyxml2::XMLElement;

void add_point(const XMLElement& element, std::vector<GeoPoint>& points) {
  GeoPoint point;
  point.altitude = std::numeric_limits<double>::quiet_NaN();
  const bool complete = element.QueryDoubleAttribute("lat", &point.latitude) == tinyxml2::XML_SUCCESS &&
                        element.QueryDoubleAttribute("lon", &point.longitude) == tinyxml2::XML_SUCCESS;
  if (!complete) {
    throw std::runtime_error("line " + std::to_string(element.GetLineNum()) + ": a point lacks lat or lon");
  }
  if (const XMLElement* altitude = element.FirstChildElement("ele")) {
    if (altitude->QueryDoubleText(&point.altitude) != tinyxml2::XML_SUCCESS) {
      throw std::runtime_error("line " + std::to_string(altitude->GetLineNum()) + ": ele is not a number");
    }
  }
  points.push_back(point);
}

void add_points(const XMLElement& parent, const char* name, std::vector<GeoPoint>& points) {
  for (const XMLElement* point = parent.FirstChildElement(name); point != nullptr;
       point = point->NextSiblingElement(name)) {
    add_point(*point, points);
  }
}

/// The one track, or the one route.
const XMLElement& find_line(const XMLElement& root) {
  const XMLElement* line = nullptr;
  int count = 0;
  for (const char* name : {"trk", "rte"}) {
    for (const XMLElement* found = root.FirstChildElement(name); found != nullptr;
         found = found->NextSiblingElement(name), ++count) {
      if (line == nullptr) line = found;
    }
  }
  if (count == 1) return *line;
  throw std::runtime_error("has " + std::to_string(count) + " tracks and routes, but must have one");
}

GeoLine parse(const tinyxml2::XMLDocument& document) {
  const XMLElement* root = document.FirstChildElement("gpx");
  if (root == nullptr) throw std::runtime_error("is no GPX file: it has no element 'gpx'");
  const XMLElement& track = find_line(*root);
  GeoLine line;
  add_points(track, "rtept", line.points);
  for (const XMLElement* segment = track.FirstChildElement("trkseg"); segment != nullptr;
       segment = segment->NextSiblingElement("trkseg")) {
    add_points(*segment, "trkpt", line.points);
  }
  const XMLElement* description = track.FirstChildElement("desc");
  const char* text = description != nullptr ? description->GetText() : nullptr;
  if (text != nullptr && std::string(text).rfind("{\"header\"", 0) == 0)
    line.header = parse_line_header(text);
  return line;
}

std::string degrees(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(13) << value;
  return text.str();
}

}  // namespace

GeoLine read_gpx(const std::string& path) {
  const std::string content = read_whole_file(path);
  if (content.empty()) throw std::runtime_error(path + ": has no points");
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
