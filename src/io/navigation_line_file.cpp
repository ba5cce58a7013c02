#include "relative_map/io/navigation_line_file.hpp"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

namespace relative_map::core {

namespace {

using Json = nlohmann::json;

struct Field {
  const char* key;
  double LinePoint::*value;
  int decimals;  ///< written
};

// x and y first: a reader of the file looks for them.
constexpr std::array<Field, 7> kFields = {{{"x", &LinePoint::x, 6},
                                           {"y", &LinePoint::y, 6},
                                           {"z", &LinePoint::z, 6},
                                           {"s", &LinePoint::s, 6},
                                           {"theta", &LinePoint::theta, 9},
                                           {"kappa", &LinePoint::kappa, 9},
                                           {"dkappa", &LinePoint::dkappa, 9}}};

bool is_blank(const std::string& text) {
  return text.find_first_not_of(" \t\r\n\v\f") == std::string::npos;
}

/// Throws std::runtime_error with a fault that the caller puts the place in front of.
Json parse_object(const std::string& text) {
  Json object;
  try {
    object = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw std::runtime_error("not valid JSON near column " + std::to_string(error.byte));
  } catch (const Json::exception&) {  // a number that no double can hold
    throw std::runtime_error("not valid JSON: a number is out of range");
  }
  if (!object.is_object()) throw std::runtime_error("not a JSON object");
  return object;
}

LinePoint parse_point(const Json& object) {
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

void write_point(std::ostream& out, const LinePoint& point) {
  const char* separator = "{";
  for (const Field& field : kFields) {
    const double value = point.*field.value;
    if (!std::isfinite(value)) continue;
    out << separator << '"' << field.key << "\": " << std::setprecision(field.decimals) << value;
    separator = ", ";
  }
  out << "}\n";
}

/// Throws std::runtime_error when the disk did not take all of it.
void write_points(const std::string& path, const RecordedLine& line) {
  std::ofstream out(path);
  out.imbue(std::locale::classic());  // JSON has decimal points everywhere
  out << std::fixed;
  for (const LinePoint& point : line.points) write_point(out, point);
  out.close();
  if (!out) throw std::runtime_error("cannot write " + path);
}

}  // namespace

RecordedLine read_navigation_line(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error(path + ": cannot be opened");
  RecordedLine line;
  line.name = std::filesystem::path(path).stem().string();
  bool may_be_header = true;
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    if (is_blank(text)) continue;
    try {
      const Json object = parse_object(text);
      const bool header = may_be_header && !object.contains("x") && !object.contains("y");
      if (!header) line.points.push_back(parse_point(object));
    } catch (const std::runtime_error& fault) {
      throw std::runtime_error(path + ", line " + std::to_string(number) + ": " + fault.what());
    }
    may_be_header = false;
  }
  if (in.bad()) throw std::runtime_error(path + ": reading failed");
  if (line.points.empty()) throw std::runtime_error(path + ": has no points");
  return line;
}

void write_navigation_line(const std::string& path, const RecordedLine& line) {
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    if (std::isfinite(line.points[i].x) && std::isfinite(line.points[i].y)) continue;
    throw std::runtime_error(path + ": not written, since point " + std::to_string(i) + " lacks x or y");
  }
  const std::string temporary = path + ".tmp." + std::to_string(getpid());
  std::error_code error;
  try {
    write_points(temporary, line);
    std::filesystem::rename(temporary, path, error);
    if (error) throw std::runtime_error("cannot write " + path + ": " + error.message());
  } catch (const std::runtime_error&) {
    std::filesystem::remove(temporary, error);
    throw;
  }
}

}  // namespace relative_map::core
