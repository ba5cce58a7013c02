// The nodelet: a shell around LocalizerNode.
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

#include "relative_map/ros/localizer/localizer_node.hpp"

namespace relative_map {

class LocalizerNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<LocalizerNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& fault) {
      // The manager stays alive and may lose an exception's text.
      NODELET_FATAL_STREAM(fault.what());
      throw;
    }
  }

  std::unique_ptr<LocalizerNode> node_;
};

}  // namespace relative_map

PLUGINLIB_EXPORT_CLASS(relative_map::LocalizerNodelet, nodelet::Nodelet)
