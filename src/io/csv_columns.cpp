#include "csv_columns.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>

#include "relative_map/io/text.hpp"

namespace relative_map::core {

namespace {

constexpr std::size_t kLongestName = 100;  // [bytes] more is no name

const std::vector<CsvColumn> kColumns = {
    {"x", &LinePoint::x, false},           {"y", &LinePoint::y, false},
    {"z", &LinePoint::z, false},           {"s", &LinePoint::s, false},
    {"theta", &LinePoint::theta, false},   {"kappa", &LinePoint::kappa, false},
    {"dkappa", &LinePoint::dkappa, false}, {"lon", &LinePoint::x, true},
    {"lat", &LinePoint::y, true},          {"alt", &LinePoint::z, true},
};

const std::map<std::string, std::string> kOtherNames = {
    {"easting", "x"}, {"east", "x"},        {"northing", "y"},   {"north", "y"},
    {"lng", "lon"},   {"longitude", "lon"}, {"latitude", "lat"}, {"altitude", "alt"},
    {"ele", "alt"},   {"elevation", "alt"}, {"height", "alt"}};

/// The units that a column is read in, the first of which is told.
const std::map<std::string, std::vector<std::string>> kUnits = {
    {"x", {"m", "meter", "meters", "metre", "metres"}},
    {"theta", {"rad", "radian", "radians"}},
    {"kappa", {"1/m", "rad/m", "radpm", "m^-1"}},
    {"dkappa", {"1/m^2", "1/m2", "1/m\xC2\xB2", "rad/m^2", "rad/m2", "radpm2", "m^-2"}},
    {"lon", {"deg", "degree", "degrees", "\xC2\xB0"}}};

const std::vector<std::string>& units_of(const std::string& name) {
  if (name == "lat") return kUnits.at("lon");
  const auto found = kUnits.find(name);
  return found == kUnits.end() ? kUnits.at("x") : found->second;
}

const CsvColumn* find(const std::string& name) {
  const auto other = kOtherNames.find(name);
  const std::string& known = other == kOtherNames.end() ? name : other->second;
  const auto found =
      std::find_if(kColumns.begin(), kColumns.end(), [&](const CsvColumn& c) { return c.name == known; });
  return found == kColumns.end() ? nullptr : &*found;
}

/// "x [m]", "x (m)" and "x_m" are x in m.
struct Name {
  std::string quantity, unit;
};

Name parse_name(const std::string& cell) {
  static const std::regex kInBrackets(R"re(^(.*?)\s*[\[(]\s*(.*?)\s*[\])]$)re");
  static const std::regex kBehind(
      R"re(^(.*)_(m|km|cm|mm|ft|meters?|metres?|rad|deg|degrees?|radpm|radpm2)$)re");
  const std::string text = lower(trimmed(cell));
  if (text.size() > kLongestName) return {text, ""};
  std::smatch parts;
  if (std::regex_match(text, parts, kInBrackets) || std::regex_match(text, parts, kBehind)) {
    return {parts[1], parts[2]};
  }
  return {text, ""};
}

/// Null: another quantity.
const CsvColumn* column_of(const std::string& cell) {
  const Name name = parse_name(cell);
  const CsvColumn* const found = find(name.quantity);
  if (found == nullptr || name.unit.empty()) return found;
  const std::vector<std::string>& units = units_of(found->name);
  if (std::find(units.begin(), units.end(), name.unit) != units.end()) return found;
  throw std::runtime_error("column '" + trimmed(cell) + "' is in " + name.unit + ", but " + found->name +
                           " must be in " + units.front());
}

bool has(const CsvColumns& columns, const std::string& name) {
  return std::any_of(columns.list.begin(), columns.list.end(),
                     [&](const CsvColumn* c) { return c != nullptr && c->name == name; });
}

}  // namespace

const CsvColumn& column(const std::string& name) {
  return *find(name);
}

CsvColumns columns_of_names(const std::vector<std::string>& names) {
  CsvColumns columns;
  for (const std::string& name : names) {
    const CsvColumn* const found = column_of(name);
    if (found != nullptr && has(columns, found->name)) {
      throw std::runtime_error(std::string("there are two columns of ") + found->name);
    }
    columns.list.push_back(found);
  }
  columns.geographic = has(columns, "lon") || has(columns, "lat");
  const bool complete = columns.geographic ? has(columns, "lon") && has(columns, "lat")
                                           : has(columns, "x") && has(columns, "y");
  if (!complete) {
    throw std::runtime_error(
        "there must be columns x and y, or lon and lat, with one of , ; | tab or blank between them");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const CsvColumn*& used = columns.list[i];
    if (used != nullptr && columns.geographic && !used->geographic)
      used = nullptr;  // it may have x, y as well
    if (used == nullptr && !trimmed(names[i]).empty()) columns.left_out.push_back(trimmed(names[i]));
  }
  return columns;
}

CsvColumns columns_without_names(std::size_t count) {
  if (count < 2) return columns_of_names({"x"});  // says what there must be
  if (count > 3) {
    throw std::runtime_error("has " + std::to_string(count) +
                             " columns, and no line that names them: name them, or keep x, y and z alone");
  }
  CsvColumns columns = columns_of_names({"x", "y", "z"});
  columns.list.resize(count);
  return columns;
}

bool look_like_names(const std::vector<std::string>& cells) {
  static const std::regex kName(R"re(^[A-Za-z_]\w*( ?[\[(].*[\])])?$)re");
  return std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
    return cell.size() <= kLongestName && std::regex_match(trimmed(cell), kName);
  });
}

bool name_something(const std::vector<std::string>& cells) {
  static const std::set<std::string> kTimes = {"t", "time", "stamp", "timestamp", "sec", "secs"};
  return std::any_of(cells.begin(), cells.end(), [](const std::string& cell) {
    const std::string name = parse_name(cell).quantity;
    return find(name) != nullptr || kTimes.count(name) > 0;
  });
}

}  // namespace relative_map::core
