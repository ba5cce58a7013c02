#pragma once

#include <string>
#include <vector>

#include "relative_map/model/geo_reference.hpp"

namespace relative_map::core {

/// A stretch that nothing was recorded on, and that a tool has put points across all the same: a guess, and a
/// fault until somebody accepts it. From the last point before it to the first one after it, map frame.
struct BridgedGap {
  double from_x = 0.0, from_y = 0.0, to_x = 0.0, to_y = 0.0;  ///< [m]
};

/// What a file of a navigation line says about its map frame, and about itself.
struct LineHeader {
  std::string frame_id;  ///< empty: not given
  GeoReference reference = {};
  std::vector<BridgedGap> bridged = {};
};

bool is_empty(const LineHeader& header);

/// E.g. "UTM zone 50N", "local ENU about 48.1, 11.5", "no projection".
std::string describe(const GeoReference& reference);

/// Why coordinates under these two can't be used together, as the end of a sentence: "one is in ..., the
/// other in ..."; empty: they can, as far as is known.
std::string conflict(const LineHeader& a, const LineHeader& b);

/// Takes into `known` what `other` knows besides, field by field; the conflict if there is one, and then
/// `known` stays.
std::string merge(LineHeader& known, const LineHeader& other);

/// The header as the one-line JSON object that stands first in a file, without a line's end:
/// {"header": {"frame_id": "map", "projection": "utm", "zone": 50, "north": true}} or
/// {"header": {"frame_id": "map", "projection": "local", "latitude": 48.1, "longitude": 11.5, "altitude":
/// 0.0}}, and "bridged": [[from x, from y, to x, to y], ...] where there is one.
std::string to_json(const LineHeader& header);

/// Reads such an object; one without "header" gives an empty header (another tool's). Throws
/// std::runtime_error, a fault without its place, if a header holds what can't be.
LineHeader parse_line_header(const std::string& json);

}  // namespace relative_map::core
