#include "relative_map/io/line_header.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace relative_map::core {

namespace {

using Json = nlohmann::json;

constexpr double kSameAngle = 1e-9;   // [deg] 0.1 mm
constexpr double kSameHeight = 1e-3;  // [m]

double number(const Json& fields, const char* key, double low, double high) {
  const auto found = fields.find(key);
  const bool good = found != fields.end() && found->is_number() && found->get<double>() >= low &&
                    found->get<double>() <= high;
  if (!good) throw std::runtime_error(std::string("the header's ") + key + " is missing or impossible");
  return found->get<double>();
}

GeoReference parse_reference(const Json& fields) {
  GeoReference reference;
  const auto projection = fields.find("projection");
  if (projection == fields.end() || projection->is_null()) return reference;
  if (*projection == "utm") {
    const auto north = fields.find("north");
    if (north == fields.end() || !north->is_boolean()) {
      throw std::runtime_error("the header's north is neither true nor false");
    }
    reference.projection = Projection::kUtm;
    reference.zone = static_cast<int>(number(fields, "zone", 1, 60));
    reference.north = north->get<bool>();
  } else if (*projection == "local") {
    reference.projection = Projection::kLocal;
    reference.latitude = number(fields, "latitude", -90.0, 90.0);
    reference.longitude = number(fields, "longitude", -180.0, 180.0);
    reference.altitude = number(fields, "altitude", -1e5, 1e5);
  } else {
    throw std::runtime_error("the header's projection is neither \"utm\" nor \"local\"");
  }
  return reference;
}

std::vector<BridgedGap> parse_bridged(const Json& fields) {
  std::vector<BridgedGap> bridged;
  const auto gaps = fields.find("bridged");
  if (gaps == fields.end() || gaps->is_null()) return bridged;
  const auto is_number = [](const Json& value) { return value.is_number(); };
  for (const Json& gap : *gaps) {
    if (!gap.is_array() || gap.size() != 4 || !std::all_of(gap.begin(), gap.end(), is_number)) {
      throw std::runtime_error("the header's bridged is no list of four numbers each");
    }
    bridged.push_back({gap[0], gap[1], gap[2], gap[3]});
  }
  return bridged;
}

bool same(const GeoReference& a, const GeoReference& b) {
  if (a.projection != b.projection) return false;
  if (a.projection == Projection::kUtm) return a.zone == b.zone && a.north == b.north;
  return std::abs(a.latitude - b.latitude) < kSameAngle && std::abs(a.longitude - b.longitude) < kSameAngle &&
         std::abs(a.altitude - b.altitude) < kSameHeight;
}

}  // namespace

bool is_empty(const LineHeader& header) {
  return header.frame_id.empty() && header.reference.projection == Projection::kNone &&
         header.bridged.empty();
}

std::string describe(const GeoReference& reference) {
  std::ostringstream text;
  switch (reference.projection) {
    case Projection::kNone:
      text << "no projection";
      break;
    case Projection::kUtm:
      text << "UTM zone " << reference.zone << (reference.north ? 'N' : 'S');
      break;
    case Projection::kLocal:
      text << std::setprecision(12) << "local ENU about latitude " << reference.latitude << ", longitude "
           << reference.longitude << ", altitude " << reference.altitude << " m";
  }
  return text.str();
}

std::string conflict(const LineHeader& a, const LineHeader& b) {
  if (!a.frame_id.empty() && !b.frame_id.empty() && a.frame_id != b.frame_id) {
    return "one is in frame '" + a.frame_id + "', the other in '" + b.frame_id + "'";
  }
  const bool both =
      a.reference.projection != Projection::kNone && b.reference.projection != Projection::kNone;
  if (!both || same(a.reference, b.reference)) return "";
  return "one is in " + describe(a.reference) + ", the other in " + describe(b.reference);
}

std::string merge(LineHeader& known, const LineHeader& other) {
  const std::string why = conflict(known, other);
  if (!why.empty()) return why;
  if (known.frame_id.empty()) known.frame_id = other.frame_id;
  if (known.reference.projection == Projection::kNone) known.reference = other.reference;
  known.bridged.insert(known.bridged.end(), other.bridged.begin(), other.bridged.end());
  return "";
}

std::string to_json(const LineHeader& header) {
  // By hand, for the order of the keys; the library writes each value, and never fails, whatever bytes it
  // holds.
  std::string fields;
  const auto add = [&fields](const char* key, const Json& value) {
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    fields += (fields.empty() ? "\"" : ", \"") + std::string(key) + "\": " + text;
  };
  if (!header.frame_id.empty()) add("frame_id", header.frame_id);
  const GeoReference& reference = header.reference;
  if (reference.projection == Projection::kUtm) {
    add("projection", "utm");
    add("zone", reference.zone);
    add("north", reference.north);
  } else if (reference.projection == Projection::kLocal) {
    add("projection", "local");
    add("latitude", reference.latitude);
    add("longitude", reference.longitude);
    add("altitude", reference.altitude);
  }
  if (!header.bridged.empty()) {
    Json gaps = Json::array();
    for (const BridgedGap& gap : header.bridged) gaps.push_back({gap.from_x, gap.from_y, gap.to_x, gap.to_y});
    add("bridged", gaps);
  }
  return R"({"header": {)" + fields + "}}";
}

LineHeader parse_line_header(const std::string& json) {
  LineHeader header;
  const Json object = Json::parse(json, nullptr, false);
  if (!object.is_object()) throw std::runtime_error("the header is not a JSON object");
  const auto fields = object.find("header");
  if (fields == object.end() || !fields->is_object()) return header;
  if (const auto frame = fields->find("frame_id"); frame != fields->end()) {
    if (!frame->is_string()) throw std::runtime_error("the header's frame_id is not text");
    header.frame_id = frame->get<std::string>();
  }
  header.reference = parse_reference(*fields);
  header.bridged = parse_bridged(*fields);
  return header;
}

}  // namespace relative_map::core
