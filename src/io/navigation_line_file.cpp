#include "relative_map/io/navigation_line_file.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "json_stream.hpp"
#include "relative_map/io/text.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

using Json = nlohmann::json;

struct Field {
  const char* key;
  double LinePoint::*value;
  int decimals;  ///< written: curvature is a second difference of positions, and needs them all
};

// x and y first: a reader of the file looks for them.
constexpr std::array<Field, 7> kFields = {{{"x", &LinePoint::x, 9},
                                           {"y", &LinePoint::y, 9},
                                           {"z", &LinePoint::z, 9},
                                           {"s", &LinePoint::s, 9},
                                           {"theta", &LinePoint::theta, 12},
                                           {"kappa", &LinePoint::kappa, 12},
                                           {"dkappa", &LinePoint::dkappa, 12}}};

LinePoint parse_point(const Json& object) {
  if (object.contains("coordinates") || object.contains("geometry") || object.contains("features")) {
    throw std::runtime_error("this is GeoJSON: name the file .geojson, or its format");
  }
  LinePoint point;
  for (const Field& field : kFields) {
    const auto found = object.find(field.key);
    const bool given = found != object.end() && !found->is_null();
    if (given && !found->is_number()) throw std::runtime_error(std::string(field.key) + " is not a number");
    point.*field.value = given ? found->get<double>() : std::numeric_limits<double>::quiet_NaN();
  }
  if (std::isnan(point.x)) throw std::runtime_error("x is missing");
  if (std::isnan(point.y)) throw std::runtime_error("y is missing");
  return point;
}

/// This package's, or another tool's.
bool is_header(const Json& object) {
  return !object.contains("x") && !object.contains("y") && !object.contains("type");
}

void write_point(std::ostream& out, const LinePoint& point) {
  const char* separator = "{";
  for (const Field& field : kFields) {
    const double value = point.*field.value;
    if (!std::isfinite(value)) continue;
    out << separator << '"' << field.key << "\": " << std::setprecision(field.decimals) << value;
    separator = ", ";
  }
  out << "}";
}

}  // namespace

std::string line_name(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

LineFile read_line_file(const std::string& path) {
  const std::string text = read_text(path);
  JsonStream objects(text);
  LineFile file;
  file.line.name = line_name(path);
  Json object;
  for (bool first = true;; first = false) {
    try {
      if (!objects.next(object)) break;
    } catch (const std::runtime_error& fault) {
      throw std::runtime_error(path + ", " + fault.what());
    }
    try {
      if (first && is_header(object)) {
        file.header = parse_line_header(object.dump(-1, ' ', false, Json::error_handler_t::replace));
      } else {
        file.line.points.push_back(parse_point(object));
      }
    } catch (const std::runtime_error& fault) {
      throw std::runtime_error(path + ", line " + std::to_string(objects.line()) + ": " + fault.what());
    }
  }
  if (file.line.points.empty()) throw std::runtime_error(path + ": has no points");
  return file;
}

RecordedLine read_navigation_line(const std::string& path) {
  return read_line_file(path).line;
}

void expect_finite_positions(const std::string& path, const RecordedLine& line) {
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    if (std::isfinite(line.points[i].x) && std::isfinite(line.points[i].y)) continue;
    throw std::runtime_error(path + ": not written, since point " + std::to_string(i) + " lacks x or y");
  }
}

void write_line_file(const std::string& path, const LineFile& file, Layout layout) {
  expect_finite_positions(path, file.line);
  const bool array = layout == Layout::kOneLine;
  const char* const between = array ? ", " : "\n";
  std::ostringstream out;
  out.imbue(std::locale::classic());  // JSON has decimal points everywhere
  out << std::fixed << (array ? "[" : "");
  if (!is_empty(file.header)) out << to_json(file.header) << between;
  for (std::size_t i = 0; i < file.line.points.size(); ++i) {
    if (i > 0) out << between;
    write_point(out, file.line.points[i]);
  }
  out << (array ? "]\n" : "\n");
  write_whole_file(path, out.str());
}

void write_navigation_line(const std::string& path, const RecordedLine& line) {
  LineFile file;
  file.line = line;
  write_line_file(path, file);
}

}  // namespace relative_map::core
