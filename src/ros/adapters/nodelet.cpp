// The nodelet: a shell around AdaptersNode.
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

#include "relative_map/ros/adapters/adapters_node.hpp"

namespace relative_map {

class AdaptersNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<AdaptersNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& fault) {
      // The manager stays alive and may lose an exception's text.
      NODELET_FATAL_STREAM(getName() << ": " << fault.what());
      throw;
    }
  }

  std::unique_ptr<AdaptersNode> node_;
};

}  // namespace relative_map

PLUGINLIB_EXPORT_CLASS(relative_map::AdaptersNodelet, nodelet::Nodelet)
