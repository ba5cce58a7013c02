#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "messages.hpp"
#include "relative_map/doctor/doctor.hpp"

// What the doctor sees of a system that is well, to be spoiled in one place.
namespace relative_map::doctor::test {

/// Where links are, seen from base_link.
using Places = std::map<std::string, Eigen::Isometry3d>;

inline LinkTransforms transforms_of(Places places) {
  places["base_link"] = Eigen::Isometry3d::Identity();
  return [places](const std::string& target, const std::string& source,
                  const ros::Time&) -> std::optional<Eigen::Isometry3d> {
    const auto to = places.find(target), from = places.find(source);
    if (to == places.end() || from == places.end()) return std::nullopt;
    return to->second.inverse() * from->second;
  };
}

/// A car that drives for 5 s at 10 m/s along its one line, a wide bend to the left in UTM-sized coordinates.
/// imu_link is localized, and a camera sees the paint. Nothing is wrong with it.
Observations healthy_system();
Places healthy_places();

/// Changes all messages of an input.
template <class Message, class Change>
void change(Input<Message>& input, Change change_one) {
  for (Received<Message>& received : input.messages) {
    Message message = *received.message;
    change_one(message);
    received.message = relative_map::test::shared(message);
  }
}

/// Stamps as if each message had been on its way for so long.
template <class Message>
void delay(Input<Message>& input, double seconds) {
  change(input, [&](Message& message) { message.header.stamp -= ros::Duration(seconds); });
}

/// The car stands all the time where it was first.
void stop(Observations& seen);

/// Keeps one message in `step`.
template <class Element>
void thin_out(std::vector<Element>& elements, std::size_t step) {
  std::vector<Element> kept;
  for (std::size_t i = 0; i < elements.size(); i += step) kept.push_back(elements[i]);
  elements = kept;
}

/// Something that is wrong with a system.
struct Fault {
  const char* rule;  ///< that has to find it
  const char* name;
  void (*spoil)(Observations& seen);
  const char* what;               ///< part of the sentence
  const char* mend;               ///< part of the advice
  std::vector<std::string> also;  ///< other rules that find it too
};

std::vector<Fault> node_faults();
std::vector<Fault> topic_faults();
std::vector<Fault> time_faults();
std::vector<Fault> frame_faults();
std::vector<Fault> pose_faults();
std::vector<Fault> motion_faults();
std::vector<Fault> line_faults();
std::vector<Fault> marker_faults();
std::vector<Fault> map_faults();

/// For gtest's messages.
inline void PrintTo(const Fault& fault, std::ostream* stream) {
  *stream << fault.name;
}

}  // namespace relative_map::doctor::test
