// Listens to a live system for some seconds and says what is wrong with it and how to mend it.
#include "relative_map/doctor/doctor.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "command_line.hpp"
#include "doctor_master.hpp"
#include "relative_map/ros/messages/message_check.hpp"
#include "relative_map/ros/setup/reconfigure.hpp"

namespace relative_map {
namespace {

constexpr const char* kUsage =
    "usage: rosrun relative_map doctor [--duration S] [--namespace NS] [_node:=NAME] [TOPIC:=OTHER ...]\n"
    "\n"
    "Listens beside a running system and says in plain sentences what is wrong with it and how to mend it.\n"
    "Exit code 0: all is well; 1: something is wrong; 2: bad arguments, or no master.\n"
    "\n"
    "  --duration S     how long to listen [s], from 1 to 600 (default 5); the vehicle should move: "
    "headings\n"
    "                   and speeds are told by motion\n"
    "  --namespace NS   where the vehicle's topics and its map node are, e.g. /car1 (default: that of "
    "ROS_NAMESPACE)\n"
    "  _node:=NAME      name of the map node, to read its parameters (default relative_map)\n"
    "  TOPIC:=OTHER     remaps navigation, localization, chassis, perception/lane_markers or relative_map,\n"
    "                   as for the map node\n";

/// Gathers observations on one thread.
class Listener {
 public:
  Listener(ros::NodeHandle nh, ros::NodeHandle private_nh) : nh_(nh), transform_listener_(transforms_, nh) {
    read_parameters(private_nh.param<std::string>("node", "relative_map"));
    seen_.transforms = link_transforms(transforms_);
    listen("navigation", seen_.navigation);
    listen("localization", seen_.localization);
    listen("chassis", seen_.chassis);
    listen("perception/lane_markers", seen_.lane_markers);
    listen_to_diagnostics();
    seen_.map_topic.name = nh_.resolveName("relative_map");
    subscribers_.push_back(
        nh_.subscribe<MapMsg>("relative_map", kQueue, [this](const MapMsgConstPtr& map) { on_map(*map); }));
  }

  /// What is seen in `duration` [s] of the wall clock: simulated time may stand still.
  const doctor::Observations& listen_for(double duration) {
    seen_.simulated_time = ros::Time::isSimTime();
    wait_for_simulated_time();
    const ros::WallTime begin = ros::WallTime::now();
    const ros::WallTime end = begin + ros::WallDuration(duration);
    const ros::WallTime settled = begin + ros::WallDuration(kSettling);
    while (ros::ok() && ros::WallTime::now() < end) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
      if (seen_.begin.isZero() && ros::WallTime::now() > settled) seen_.begin = ros::Time::now();
    }
    seen_.end = ros::Time::now();
    read_reconfigured();  // once more: it may have been changed in the meantime
    seen_.listened = (ros::WallTime::now() - begin).toSec();
    ask_master();
    look_at_definitions();
    return seen_;
  }

 private:
  static constexpr uint32_t kQueue = 1000;
  static constexpr double kSettling = 0.2;     // [s] until /clock has come, if there is one
  static constexpr double kFirstClock = 10.0;  // [s] for the first /clock
  static constexpr double kProbeTime = 1.0;    // [s] for another look at topics on which nothing came

  template <class Message>
  void listen(const std::string& name, doctor::Input<Message>& input) {
    input.topic.name = nh_.resolveName(name);
    subscribers_.push_back(
        nh_.subscribe<Message>(name, kQueue, [&input](const boost::shared_ptr<const Message>& message) {
          input.messages.push_back({ros::Time::now(), message});
        }));
  }

  void read_parameters(const std::string& node) {
    seen_.node = nh_.resolveName(node);
    XmlRpc::XmlRpcValue tree;
    seen_.node_has_parameters = nh_.getParam(seen_.node, tree);
    std::string key, urdf;
    if (ros::NodeHandle(seen_.node).searchParam("robot_description", key)) nh_.getParam(key, urdf);
    try {
      seen_.config = make_node_config(flatten(tree), urdf);
    } catch (const std::runtime_error& fault) {
      seen_.config_fault = fault.what();
    }
    read_reconfigured();
  }

  /// What was changed while driving counts, and not what the node was started with.
  void read_reconfigured() {
    RelativeMapConfig view = reconfigure_view(seen_.config.pipeline);
    view.__fromServer__(ros::NodeHandle(seen_.node + "/" + kReconfigureNamespace));
    seen_.config.pipeline = with_request(seen_.config.pipeline, view);
  }

  /// The map node says there how many lines it has: they may come from files, and no message tells of them.
  void listen_to_diagnostics() {
    subscribers_.push_back(nh_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", kQueue, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
          for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
            if (status.name != seen_.node.substr(1) + ": relative map" &&
                status.name != seen_.node + ": relative map") {
              continue;
            }
            for (const diagnostic_msgs::KeyValue& value : status.values) {
              if (value.key == "navigation lines")
                seen_.lines_in_use = std::strtoul(value.value.c_str(), nullptr, 10);
            }
          }
        }));
  }

  /// A simulation or a bag may begin after the doctor.
  void wait_for_simulated_time() {
    if (!seen_.simulated_time) return;
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kFirstClock);
    while (ros::ok() && ros::WallTime::now() < end && ros::Time::now().isZero()) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
    }
  }

  void on_map(const MapMsg& map) {
    // Without the number of the map before: one that the doctor was too slow to take is no fault of the
    // node's.
    core::MapContext context;
    context.frame_id = seen_.config.pipeline.base_frame;
    seen_.maps.push_back({ros::Time::now(),
                          {static_cast<core::StatusCode>(map.status.code), map.status.message},
                          check_message(map, context)});
  }

  void ask_master() {
    MasterSurvey survey;
    fill<NavigationInfo>(survey, seen_.navigation.topic);
    fill<LocalizationEstimate>(survey, seen_.localization.topic);
    fill<Chassis>(survey, seen_.chassis.topic);
    fill<LaneMarkers>(survey, seen_.lane_markers.topic);
    fill<MapMsg>(survey, seen_.map_topic);
  }

  template <class Message>
  static void fill(MasterSurvey& survey, doctor::Topic& topic) {
    topic = survey.topic(topic.name, ros::message_traits::datatype<Message>());
    topic.md5sum = ros::message_traits::md5sum<Message>();
  }

  /// A publisher of another definition sends nothing to a subscriber of ours, but it does to one of any.
  void look_at_definitions() {
    subscribers_.clear();
    const auto look_at = [this](doctor::Topic& topic, bool silent) {
      if (!silent || topic.publishers.empty()) return;
      subscribers_.push_back(nh_.subscribe<topic_tools::ShapeShifter>(
          topic.name, kQueue,
          boost::function<void(const ros::MessageEvent<const topic_tools::ShapeShifter>&)>(
              [&topic](const ros::MessageEvent<const topic_tools::ShapeShifter>& event) {
                for (doctor::Publisher& publisher : topic.publishers) {
                  if (publisher.node == event.getPublisherName()) {
                    publisher.md5sum = event.getConstMessage()->getMD5Sum();
                  }
                }
              })));
    };
    look_at(seen_.navigation.topic, seen_.navigation.messages.empty());
    look_at(seen_.localization.topic, seen_.localization.messages.empty());
    look_at(seen_.chassis.topic, seen_.chassis.messages.empty());
    look_at(seen_.lane_markers.topic, seen_.lane_markers.messages.empty());
    look_at(seen_.map_topic, seen_.maps.empty());
    if (subscribers_.empty()) return;
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kProbeTime);
    while (ros::ok() && ros::WallTime::now() < end) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
    }
  }

  ros::NodeHandle nh_;
  doctor::Observations seen_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  std::vector<ros::Subscriber> subscribers_;
};

/// Prints what is well, then what is not, where the eye is at the end. The process's exit code.
int report(std::vector<doctor::Finding> findings) {
  std::stable_sort(findings.begin(), findings.end(), [](const doctor::Finding& a, const doctor::Finding& b) {
    return a.severity < b.severity;
  });
  for (const doctor::Finding& finding : findings) std::printf("%s\n", doctor::to_line(finding).c_str());
  const auto wrong = std::count_if(findings.begin(), findings.end(), [](const doctor::Finding& finding) {
    return finding.severity == doctor::Severity::kWrong;
  });
  if (wrong == 0) {
    std::printf("all is well\n");
  } else {
    std::printf("%d %s wrong\n", static_cast<int>(wrong), wrong == 1 ? "thing is" : "things are");
  }
  return wrong == 0 ? 0 : 1;
}

int run(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--duration", "--namespace"});
  line.files(0, 0, "");
  const double duration = line.number("--duration", 5.0, 1.0, 600.0);
  if (!ros::master::check()) {
    throw std::runtime_error("there is no master at " + ros::master::getURI() +
                             ": start the system first, or set ROS_MASTER_URI");
  }
  const ros::NodeHandle nh(line.text("--namespace")), private_nh("~");
  Listener listener(nh, private_nh);
  return report(doctor::diagnose(listener.listen_for(duration)));
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  ros::init(argc, argv, "doctor", ros::init_options::AnonymousName);  // takes the words that are its own
  return relative_map::run_tool("doctor", relative_map::kUsage, argc, argv, relative_map::run, 2);
}
