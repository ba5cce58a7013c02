#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "csv_columns.hpp"
#include "csv_record.hpp"
#include "relative_map/io/line_formats.hpp"
#include "relative_map/io/text.hpp"

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string name_of(char separator) {
  if (separator == '\t') return "a tab";
  return separator == kBlank ? "a blank" : std::string("'") + separator + "'";
}

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

bool is_number_or_nothing(const std::string& cell) {
  const std::string word = lower(trimmed(cell));
  return word.empty() || word == "nan" || parse_number(word);
}

/// Whether a first line names columns: one that holds a number is no such line.
bool is_header(const std::vector<std::string>& cells) {
  const auto is_number = [](const std::string& cell) { return parse_number(cell).has_value(); };
  return std::none_of(cells.begin(), cells.end(), is_number) &&
         !std::all_of(cells.begin(), cells.end(), is_number_or_nothing);
}

[[noreturn]] void fail(std::size_t line, const std::string& what) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + what);
}

/// Reads a file into points, and into what is said beside them.
class CsvLine {
 public:
  explicit CsvLine(const std::string& text) : reader_(text) {
    separator_ = reader_.next_separator();
    reader_.set_separator(separator_);
    CsvRecord record;
    bool started = false;
    while (reader_.next(record)) {
      const std::vector<CsvRecord> comments = reader_.take_comments();
      take_header(comments);
      try {
        if (!started && start(record, comments)) {
          started = true;
          continue;
        }
        started = true;
        points_.push_back(parse(record.cells));
      } catch (const LineFault& fault) {
        fail(fault.line, fault.what());
      } catch (const std::runtime_error& fault) {
        fail(record.line, fault.what());
      }
    }
    take_header(reader_.take_comments());
  }

  const std::vector<LinePoint>& points() const { return points_; }
  const CsvColumns& columns() const { return columns_; }
  const LineHeader& header() const { return header_; }

 private:
  /// In another line than the one that is read.
  struct LineFault : std::runtime_error {
    LineFault(std::size_t number, const std::string& what) : std::runtime_error(what), line(number) {}
    std::size_t line;
  };

  void take_header(const std::vector<CsvRecord>& comments) {
    for (const CsvRecord& comment : comments) {
      const std::string& text = comment.cells[0];
      if (text.find("{\"header\"") == std::string::npos) continue;
      try {
        header_ = parse_line_header(text.substr(text.find('{')));
      } catch (const std::runtime_error& fault) {
        fail(comment.line, fault.what());
      }
    }
  }

  /// By the first record; true if that was a line of names.
  bool start(const CsvRecord& record, const std::vector<CsvRecord>& comments) {
    if (is_header(record.cells)) {
      columns_ = columns_of_names(record.cells);
      return true;
    }
    // The comment next to the numbers may name their columns.
    for (auto comment = comments.rbegin(); comment != comments.rend(); ++comment) {
      if (name_columns(*comment, record.cells.size())) return false;
    }
    columns_ = columns_without_names(record.cells.size());
    return false;
  }

  /// True if a comment names the columns; throws if it seems to, and they are not enough or too many.
  bool name_columns(const CsvRecord& comment, std::size_t count) {
    std::vector<std::string> names = split(trimmed(comment.cells[0]), separator_);
    for (std::string& name : names) {
      name = trimmed(name);
      if (name.size() > 1 && name.front() == '"' && name.back() == '"')
        name = name.substr(1, name.size() - 2);
    }
    if (names.size() < 2 || !look_like_names(names)) return false;
    // Without a name that is known here it is a remark, unless it has a name for each column.
    const bool each = separator_ != kBlank && names.size() == count;
    if (!each && !name_something(names)) return false;
    if (names.size() != count) {
      if (separator_ == kBlank) return false;  // a sentence
      throw LineFault(comment.line, "names " + std::to_string(names.size()) + " columns, but there are " +
                                        std::to_string(count));
    }
    try {
      columns_ = columns_of_names(names);
    } catch (const std::runtime_error& fault) {
      throw LineFault(comment.line, fault.what());
    }
    return true;
  }

  LinePoint parse(const std::vector<std::string>& cells) const {
    const std::size_t count = columns_.list.size();
    if (cells.size() != count) fail_by_count(cells);
    LinePoint point{kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
    for (std::size_t i = 0; i < count; ++i) {
      if (columns_.list[i] == nullptr) continue;
      if (!is_number_or_nothing(cells[i])) throw std::runtime_error(not_a_number(cells[i]));
      point.*columns_.list[i]->value = parse_number(cells[i]).value_or(kNaN);
    }
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      throw std::runtime_error(columns_.geographic ? "longitude or latitude is missing or not finite"
                                                   : "x or y is missing or not finite");
    }
    return point;
  }

  [[noreturn]] void fail_by_count(const std::vector<std::string>& cells) const {
    const std::size_t count = columns_.list.size();
    if (cells.size() > count) {
      throw std::runtime_error("has " + std::to_string(cells.size()) + " cells, but there are " +
                               std::to_string(count) + " columns");
    }
    std::string fault = "has " + std::to_string(cells.size()) + " of " + std::to_string(count) + " numbers";
    const std::string line = joined(cells) + "\n";
    const char other = CsvReader(line).next_separator();
    if (cells.size() == 1 && other != separator_) {
      fault += ", since " + name_of(other) + " stands between them, and " + name_of(separator_) +
               " in the first line";
    }
    throw std::runtime_error(fault);
  }

  CsvReader reader_;
  char separator_ = ',';
  CsvColumns columns_;
  LineHeader header_;
  std::vector<LinePoint> points_;
};

}  // namespace

LineFile read_csv(const std::string& path, const ReadOptions& options) {
  const std::string text = read_text(path);
  LineFile file;
  GeoLine geo;
  bool geographic = false;
  try {
    const CsvLine csv(text);
    file.line.name = line_name(path);
    file.line.points = csv.points();
    file.header = geo.header = csv.header();
    geographic = csv.columns().geographic;
    if (!csv.columns().left_out.empty()) {
      geo.notes.push_back("these columns are left out: " + joined(csv.columns().left_out));
    }
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ", " + fault.what());
  }
  if (file.line.points.empty()) throw std::runtime_error(path + ": has no points");
  if (geographic) {
    for (const LinePoint& point : file.line.points) geo.points.push_back({point.x, point.y, point.z});
    return projected(path, geo, options);
  }
  file.notes = geo.notes;
  return file;
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
  std::vector<const CsvColumn*> columns;
  for (const char* name : {"x", "y", "z", "s", "theta", "kappa", "dkappa"}) {
    const CsvColumn& known = column(name);
    const auto& points = file.line.points;
    const bool given = std::any_of(points.begin(), points.end(),
                                   [&](const LinePoint& point) { return std::isfinite(point.*known.value); });
    if (given) columns.push_back(&known);
  }
  for (const CsvColumn* column : columns) {
    if (column != columns.front()) out << options.separator;
    out << column->name;
  }
  for (const LinePoint& point : file.line.points) {
    out << '\n' << std::setprecision(12);
    for (const CsvColumn* column : columns) {
      if (column != columns.front()) out << options.separator;
      if (std::isfinite(point.*column->value)) out << point.*column->value;
    }
  }
  out << '\n';
  return out.str();
}

}  // namespace relative_map::core
