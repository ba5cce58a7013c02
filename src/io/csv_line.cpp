#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <locale>
#include <map>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr char kBlank = ' ';  // stands for any number of them
const std::string kSeparators = ";\t|,";

/// Longitude, latitude and altitude are kept as x, y and z until they are projected.
struct Column {
  const char* name;
  double LinePoint::*value;
  bool geographic;
};

const Column* column_named(const std::string& name) {
  static const std::map<std::string, Column> kColumns = {
      {"x", {"x", &LinePoint::x, false}},
      {"easting", {"x", &LinePoint::x, false}},
      {"y", {"y", &LinePoint::y, false}},
      {"northing", {"y", &LinePoint::y, false}},
      {"z", {"z", &LinePoint::z, false}},
      {"s", {"s", &LinePoint::s, false}},
      {"theta", {"theta", &LinePoint::theta, false}},
      {"kappa", {"kappa", &LinePoint::kappa, false}},
      {"dkappa", {"dkappa", &LinePoint::dkappa, false}},
      {"lon", {"lon", &LinePoint::x, true}},
      {"lng", {"lon", &LinePoint::x, true}},
      {"longitude", {"lon", &LinePoint::x, true}},
      {"lat", {"lat", &LinePoint::y, true}},
      {"latitude", {"lat", &LinePoint::y, true}},
      {"alt", {"alt", &LinePoint::z, true}},
      {"altitude", {"alt", &LinePoint::z, true}},
      {"ele", {"alt", &LinePoint::z, true}},
      {"height", {"alt", &LinePoint::z, true}},
  };
  const auto found = kColumns.find(name);
  return found == kColumns.end() ? nullptr : &found->second;
}

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r\n\"";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The one that a line has; a blank if it has none of the others.
char separator_of(const std::string& line) {
  for (char separator : kSeparators) {
    if (line.find(separator) != std::string::npos) return separator;
  }
  return kBlank;
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  std::string cell;
  if (separator == kBlank) {
    while (stream >> cell) cells.push_back(trimmed(cell));
    return cells;
  }
  while (std::getline(stream, cell, separator)) cells.push_back(trimmed(cell));
  if (!line.empty() && line.back() == separator) cells.emplace_back();
  return cells;
}

std::optional<double> number_of(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double number = 0.0;
  char rest = 0;
  if (stream >> number && !(stream >> rest)) return number;
  const std::string word = lower(text);
  if (text.empty() || word == "nan") return kNaN;
  return std::nullopt;
}

std::string name_of(char separator) {
  if (separator == '\t') return "a tab";
  return separator == kBlank ? "a blank" : std::string("'") + separator + "'";
}

/// What is known of a file after its first line.
class Table {
 public:
  /// True if the line was a header.
  bool start(const std::string& line) {
    separator_ = separator_of(line);
    const std::vector<std::string> cells = split(line, separator_);
    if (cells.empty() || number_of(cells[0])) {
      for (const char* name : {"x", "y", "z"}) columns_.push_back(column_named(name));
      columns_.resize(std::min(columns_.size(), cells.size()), nullptr);
      expect("x", "y");
      return false;
    }
    for (const std::string& cell : cells) columns_.push_back(column_named(lower(cell)));
    geographic_ = has("lon") || has("lat");
    if (geographic_) {
      expect("lon", "lat");
    } else {
      expect("x", "y");
    }
    return true;
  }

  LinePoint parse(const std::string& line) const {
    const std::vector<std::string> cells = split(line, separator_);
    if (cells.size() < columns_.size()) {
      const char other = separator_of(line);
      std::string fault =
          "has " + std::to_string(cells.size()) + " of " + std::to_string(columns_.size()) + " numbers";
      if (other != separator_) {
        fault += ", since " + name_of(other) + " stands between them, and " + name_of(separator_) +
                 " in the first line";
      }
      throw std::runtime_error(fault);
    }
    LinePoint point{kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      // lon,lat files may have x and y as well.
      if (columns_[i] == nullptr || (geographic_ && !columns_[i]->geographic)) continue;
      const std::optional<double> number = number_of(cells[i]);
      if (!number) {
        const bool comma = separator_ != ',' && cells[i].find(',') != std::string::npos;
        throw std::runtime_error("'" + cells[i] + "' is not a number" +
                                 (comma ? ": the decimal sign must be a point" : ""));
      }
      point.*columns_[i]->value = *number;
    }
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      throw std::runtime_error(geographic_ ? "longitude or latitude is missing or not finite"
                                           : "x or y is missing or not finite");
    }
    return point;
  }

  bool geographic() const { return geographic_; }

 private:
  bool has(const std::string& name) const {
    return std::any_of(columns_.begin(), columns_.end(),
                       [&](const Column* column) { return column != nullptr && column->name == name; });
  }
  void expect(const char* first, const char* second) const {
    if (has(first) && has(second)) return;
    throw std::runtime_error(
        "there must be columns x and y, or lon and lat, with one of , ; | tab or blank "
        "between them");
  }

  char separator_ = ',';
  std::vector<const Column*> columns_;
  bool geographic_ = false;
};

LineFile projected(LineFile file, const ReadOptions& options) {
  std::vector<GeoPoint> points;
  for (const LinePoint& point : file.line.points) points.push_back({point.x, point.y, point.z});
  GeoReference& reference = file.header.reference;
  if (options.reference.projection != Projection::kNone) reference = options.reference;
  if (reference.projection == Projection::kNone) reference = utm_zone_of(points);
  file.line.points = project(points, reference);
  return file;
}

}  // namespace

LineFile read_csv(const std::string& path, const ReadOptions& options) {
  std::string content = read_whole_file(path);
  if (content.rfind("\xEF\xBB\xBF", 0) == 0) content.erase(0, 3);  // a byte order mark
  std::istringstream in(content);
  LineFile file;
  file.line.name = line_name(path);
  Table table;
  bool started = false;
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    const std::string line = trimmed(text);
    if (line.empty()) continue;
    try {
      if (line[0] == '#') {
        if (line.find("{\"header\"") != std::string::npos)
          file.header = parse_line_header(line.substr(line.find('{')));
        continue;
      }
      if (!started && table.start(text)) {
        started = true;
        continue;
      }
      started = true;
      file.line.points.push_back(table.parse(text));
    } catch (const std::runtime_error& fault) {
      throw std::runtime_error(path + ", line " + std::to_string(number) + ": " + fault.what());
    }
  }
  if (file.line.points.empty()) throw std::runtime_error(path + ": has no points");
  if (!table.geographic()) return file;
  try {
    return projected(std::move(file), options);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
}

std::string to_csv(const LineFile& file, const WriteOptions& options) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::fixed;
  if (!is_empty(file.header)) out << "# " << to_json(file.header) << '\n';
  if (options.geographic) {
    const char c = options.separator;
    out << "lon" << c << "lat" << c << "alt\n";
    for (const GeoPoint& point : unproject(file.line.points, file.header.reference)) {
      out << std::setprecision(13) << point.longitude << c << point.latitude << c;
      if (std::isfinite(point.altitude)) out << std::setprecision(9) << point.altitude;
      out << '\n';
    }
    return out.str();
  }
  std::vector<const Column*> columns;
  for (const char* name : {"x", "y", "z", "s", "theta", "kappa", "dkappa"}) {
    const Column* column = column_named(name);
    const auto& points = file.line.points;
    const bool given = std::any_of(points.begin(), points.end(), [&](const LinePoint& point) {
      return std::isfinite(point.*column->value);
    });
    if (given) columns.push_back(column);
  }
  for (const Column* column : columns) {
    if (column != columns.front()) out << options.separator;
    out << column->name;
  }
  for (const LinePoint& point : file.line.points) {
    out << '\n' << std::setprecision(12);
    for (const Column* column : columns) {
      if (column != columns.front()) out << options.separator;
      if (std::isfinite(point.*column->value)) out << point.*column->value;
    }
  }
  out << '\n';
  return out.str();
}

}  // namespace relative_map::core
