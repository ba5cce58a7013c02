// Nodes that come and go in one process, as nodelets do, while their topics are busy. Built with
// RELATIVE_MAP_SANITIZER=thread it shows whether their threads keep apart; RELATIVE_MAP_LOADS sets how many.
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <thread>

#include "relative_map/ros/map/relative_map_node.hpp"
#include "ros/messages.hpp"

namespace relative_map {
namespace {

/// Repeats something on a thread of its own until it goes.
class Repeated {
 public:
  Repeated(double rate, std::function<void()> action)
      : thread_([this, rate, action = std::move(action)] {
          for (ros::WallRate pace(rate); !ended_; pace.sleep()) action();
        }) {}
  ~Repeated() {
    ended_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

std::size_t loads() {
  const char* wanted = std::getenv("RELATIVE_MAP_LOADS");
  return wanted ? std::strtoul(wanted, nullptr, 10) : 40;
}

/// A namespace of its own, with the inputs of a car at 500 Hz out of this process, and what another nodelet
/// has: a queue with a thread, and a subscriber of each input.
class BusyManager {
 public:
  explicit BusyManager(const std::string& name)
      : nh_(name), private_nh_(name + "/relative_map"), spinner_(1, &queue_) {
    nh_.setCallbackQueue(&queue_);
    private_nh_.setCallbackQueue(&queue_);
    private_nh_.setParam("rate", 100.0);
    localization_ = nh_.advertise<LocalizationEstimate>("localization", 10);
    chassis_ = nh_.advertise<Chassis>("chassis", 10);
    markers_ = nh_.advertise<LaneMarkers>("perception/lane_markers", 10);
    navigation_ = nh_.advertise<NavigationInfo>("navigation", 1, true);
    navigation_.publish(test::three_lanes(test::Pose2()));
    other_ =
        nh_.subscribe<LocalizationEstimate>("localization", 10, &BusyManager::ignore<LocalizationEstimate>);
    spinner_.start();
  }

  /// Publishes all inputs, stamped now.
  void sense() {
    const ros::Time now = ros::Time::now();
    localization_.publish(test::localization(test::Pose2({20.0, 0.0}, 0.0), now));
    Chassis chassis;
    chassis.header.stamp = now;
    chassis.speed_mps = 10.0;
    chassis.gear_location = Chassis::GEAR_DRIVE;
    chassis_.publish(chassis);
    markers_.publish(test::lane_markers(now));
  }

  ros::NodeHandle nh() const { return nh_; }
  ros::NodeHandle private_nh() const { return private_nh_; }
  template <class Message>
  static void ignore(const boost::shared_ptr<const Message>&) {}
  std::size_t listeners() const { return localization_.getNumSubscribers() + chassis_.getNumSubscribers(); }

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle nh_, private_nh_;
  ros::Publisher localization_, chassis_, markers_, navigation_;
  ros::Subscriber other_;
  ros::AsyncSpinner spinner_;
};

TEST(NodeLoad, ComesAndGoesWhileItsTopicsAreBusy) {
  BusyManager manager("/busy");
  const Repeated vehicle(500.0, [&] { manager.sense(); });
  std::atomic<std::size_t> maps{0};
  const ros::Subscriber planner = manager.nh().subscribe<MapMsg>(
      "relative_map", 100, boost::function<void(const MapMsgConstPtr&)>([&](const MapMsgConstPtr& map) {
        maps += map->hdmap.lane.size() == 3;
      }));
  for (std::size_t i = 0; i < loads(); ++i) {
    const std::size_t before = maps;
    RelativeMapNode node(manager.nh(), manager.private_nh());
    if (i % 2 == 1) continue;  // as soon as it is there it goes again
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(20.0);
    while (maps < before + 2 && ros::WallTime::now() < end) ros::WallDuration(0.005).sleep();
    ASSERT_GE(maps, before + 2) << "load " << i;
  }
}

TEST(NodeLoad, IsReconfiguredWhileItComesAndGoes) {
  BusyManager manager("/reconfigured");
  const Repeated vehicle(500.0, [&] { manager.sense(); });
  std::atomic<std::size_t> answers{0};
  const std::string service = manager.private_nh().resolveName("reconfigure/set_parameters");
  {
    const Repeated people(100.0, [&] {
      dynamic_reconfigure::Reconfigure call;
      dynamic_reconfigure::DoubleParameter width;
      width.name = "default_left_width";
      width.value = 1.9;
      call.request.config.doubles.push_back(width);
      answers += ros::service::exists(service, false) && ros::service::call(service, call);
    });
    for (std::size_t i = 0; i < loads() / 4; ++i) {
      const RelativeMapNode node(manager.nh(), manager.private_nh());
      ros::WallDuration(0.1).sleep();
    }
  }
  EXPECT_GT(answers, 0u);
}

TEST(NodeLoad, LeavesNothingBehindWhereATopicIsTakenByAnotherType) {
  BusyManager manager("/conflict");
  // roscpp refuses a second type of a topic in one process.
  const ros::Subscriber other =
      manager.nh().subscribe<std_msgs::String>("taken", 1, &BusyManager::ignore<std_msgs::String>);
  const ros::NodeHandle remapped(manager.nh(), "", {{"perception/lane_markers", "taken"}});
  const Repeated vehicle(500.0, [&] { manager.sense(); });
  const std::size_t before = manager.listeners();
  for (std::size_t i = 0; i < loads() / 4; ++i) {
    EXPECT_THROW(RelativeMapNode(remapped, manager.private_nh()), ros::Exception);
    EXPECT_EQ(manager.listeners(), before);
  }
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "node_load_test");
  ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
