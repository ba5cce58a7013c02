#include "relative_map/route/route_identity.hpp"

#include <cstdint>
#include <cstdio>

namespace relative_map::core {

namespace {

/// FNV-1a of 64 bits, http://www.isthe.com/chongo/tech/comp/fnv
class Hash {
 public:
  void add(const std::string& text) {
    add_bytes(text.data(), text.size());
    add(static_cast<std::uint64_t>(text.size()));
  }
  void add(double value) {
    const double positive = value == 0.0 ? 0.0 : value;  // -0 is 0
    add_bytes(&positive, sizeof positive);
  }
  void add(std::uint64_t value) { add_bytes(&value, sizeof value); }
  std::uint64_t value() const { return value_; }

 private:
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3U;
  }

  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace

std::string route_identity(const Route& route) {
  Hash hash;
  hash.add(route.map_version);
  for (const RouteRoad& road : route.roads) {
    hash.add(road.id);
    for (const Passage& passage : road.passages) {
      hash.add(static_cast<std::uint64_t>(passage.can_exit));
      hash.add(static_cast<std::uint64_t>(passage.change_lane));
      for (const LaneSegment& segment : passage.segments) {
        hash.add(segment.lane_id);
        hash.add(segment.start_s);
        hash.add(segment.end_s);
      }
      hash.add(static_cast<std::uint64_t>(passage.segments.size()));
    }
    hash.add(static_cast<std::uint64_t>(road.passages.size()));
  }
  for (const RouteWaypoint& waypoint : route.waypoints) {
    hash.add(waypoint.lane_id);
    hash.add(waypoint.s);
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash.value()));
  return text;
}

}  // namespace relative_map::core
