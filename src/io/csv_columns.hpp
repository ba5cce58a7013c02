#pragma once

#include <string>
#include <vector>

#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// A quantity that a column can hold. Longitude, latitude and altitude are kept as x, y and z until they are
/// projected.
struct CsvColumn {
  const char* name;
  double LinePoint::*value;
  bool geographic;
};

/// Exactly "x", "y", "z", "s", "theta", "kappa", "dkappa", "lon", "lat" or "alt".
const CsvColumn& column(const std::string& name);

/// What the cells of a file's lines hold, in their order; null: something that is not used.
struct CsvColumns {
  std::vector<const CsvColumn*> list;
  std::vector<std::string> left_out;  ///< names of those that are not used
  bool geographic = false;            ///< by longitude and latitude, and not by x and y
};

/// By the cells of a line with names. Throws std::runtime_error, a sentence, if x and y, or longitude and
/// latitude, are not among them, one is there twice, or is in a unit that is not read.
CsvColumns columns_of_names(const std::vector<std::string>& names);

/// Of a file without names: x, y and perhaps z; throws for any other number of cells.
CsvColumns columns_without_names(std::size_t count);

/// Whether all cells could be names of columns, and not a remark or numbers.
bool look_like_names(const std::vector<std::string>& cells);

/// Whether one of them is a name that is known here, or of a time.
bool name_something(const std::vector<std::string>& cells);

}  // namespace relative_map::core
