#pragma once

#include <nav_msgs/Path.h>
#include <relative_map/NavigationInfo.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace relative_map {

/// Navigation lines out of a nav_msgs/Path each, by the order of their topics: the first has priority 0, the
/// best. Positions are taken, orientations are not: many planners leave them unset.
class PathLines {
 public:
  explicit PathLines(std::vector<std::string> topics) : topics_(std::move(topics)) {}

  struct Answer {
    std::optional<NavigationInfo> lines;  ///< all of them, if this path changed them
    std::string fault;                    ///< why the path is not used; empty: it is
  };
  /// A path takes the place of the one before on its topic; an empty one takes that away.
  Answer add(const std::string& topic, const nav_msgs::Path& path);

 private:
  NavigationInfo all() const;

  std::vector<std::string> topics_;
  std::map<std::string, nav_msgs::Path> paths_;
};

}  // namespace relative_map
