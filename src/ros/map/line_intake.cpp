#include "relative_map/ros/map/line_intake.hpp"

#include <algorithm>
#include <sstream>

#include "relative_map/ros/setup/line_loader.hpp"

namespace relative_map {

namespace {

constexpr std::size_t kMaxLogged = 10;  // lines, and faults, of one message

std::string description(const core::NavigationLine& line, const std::map<std::string, double>& limits) {
  std::ostringstream text;
  const auto limit = limits.find(line.name);
  text << "line '" << line.id << "', priority " << line.priority << ", " << line.points.size() << " points, "
       << line.length << " m" << (line.closed() ? ", closed" : "");
  if (limit != limits.end()) {
    text << ", speed limit " << limit->second << " m/s";
  } else {
    text << ", speed limit not known: the default";
  }
  return text.str();
}

/// Each message is told of once, however often it is sent.
void tell(const core::NavigationLines& lines, const std::map<std::string, double>& limits, const NodeLog& log,
          ThrottledLog& told) {
  std::vector<std::string> good;
  for (std::size_t i = 0; i < std::min(lines.lines.size(), kMaxLogged); ++i) {
    good.push_back(description(lines.lines[i], limits));
  }
  const auto end_of_faults =
      lines.faults.begin() + static_cast<std::ptrdiff_t>(std::min(lines.faults.size(), kMaxLogged));
  const std::vector<std::string> faults(lines.faults.begin(), end_of_faults);
  std::string all;
  for (const std::string& sentence : faults) all += sentence + "\n";
  for (const std::string& sentence : good) all += sentence + "\n";
  if (!told.due(all, ros::WallTime::now())) return;
  for (const std::string& fault : faults) log.warn("navigation: " + fault);
  for (const std::string& line : good) log.info("navigation: " + line);
  log.info("navigation: " + std::to_string(lines.lines.size()) + " lines, " +
           std::to_string(lines.faults.size()) + " faults");
}

}  // namespace

LineIntake::LineIntake(const NodeConfig& config, std::string folder, NodeLog log)
    : log_(std::move(log)),
      folder_(std::move(folder)),
      map_frame_(config.map_frame),
      speed_limits_(config.speed_limits),
      config_(config.pipeline) {}

void LineIntake::load(const std::vector<std::string>& files) {
  if (files.empty()) return;
  std::vector<std::string> notes;
  const auto lines = prepare(to_message(load_lines(files, map_frame_, notes)));
  for (const std::string& note : notes) log_.warn(std::string(kLinesParameter) + ": " + note);
  expect_all_loaded(*lines, files.size());
  hand_over(lines);
}

void LineIntake::listen(ros::NodeHandle nh, ros::NodeHandle private_nh, ros::CallbackQueueInterface& queue) {
  ros::SubscribeOptions navigation = ros::SubscribeOptions::create<NavigationInfo>(
      "navigation", 1, [this](const NavigationInfoConstPtr& message) { hand_over(prepare(*message)); },
      ros::VoidConstPtr(), &queue);
  subscriber_ = nh.subscribe(navigation);
  // Files are read where lines are prepared: a tick does not wait for them.
  const auto on_request = [this](LoadNavigationLines::Request& request,
                                 LoadNavigationLines::Response& response) {
    return on_load(request, response);
  };
  ros::AdvertiseServiceOptions load = ros::AdvertiseServiceOptions::create<LoadNavigationLines>(
      "load_navigation_lines", on_request, ros::VoidConstPtr(), &queue);
  load_service_ = private_nh.advertiseService(load);
}

std::shared_ptr<const core::NavigationLines> LineIntake::take() {
  std::shared_ptr<const core::NavigationLines> lines;
  const std::lock_guard<std::mutex> lock(mutex_);
  lines.swap(new_lines_);
  return lines;
}

void LineIntake::set_config(const core::PipelineConfig& config) {
  const std::lock_guard<std::mutex> lock(mutex_);
  config_ = config;
}

void LineIntake::note_localization_frame(const std::string& frame_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (localization_frame_ != frame_id) localization_frame_ = frame_id;
}

std::shared_ptr<const core::NavigationLines> LineIntake::prepare(const NavigationInfo& message) {
  core::PipelineConfig config;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    config = config_;
  }
  auto lines = MapEngine::prepare(message, config);
  tell(*lines, speed_limits_, log_, told_);
  return lines;
}

void LineIntake::hand_over(std::shared_ptr<const core::NavigationLines> lines) {
  // The one before the last is freed here, and not by the tick that lets go of it.
  kept_lines_[0] = std::move(kept_lines_[1]);
  kept_lines_[1] = lines;
  const std::lock_guard<std::mutex> lock(mutex_);
  new_lines_ = std::move(lines);
}

bool LineIntake::on_load(LoadNavigationLines::Request& request, LoadNavigationLines::Response& response) {
  try {
    std::string localization_frame;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      localization_frame = frame_name(localization_frame_);
    }
    const std::string otherwise = localization_frame.empty() ? map_frame_ : localization_frame;
    expect_allowed(request.files, folder_);
    std::vector<std::string> notes;
    const core::NavigationInfo info =
        load_lines(request.files, request.frame_id.empty() ? otherwise : request.frame_id, notes);
    expect_frame(info.frame_id, localization_frame);
    const auto lines = prepare(to_message(info));
    expect_all_loaded(*lines, request.files.size());
    response.lines = described(*lines);
    response.message =
        std::to_string(lines->lines.size()) + " lines loaded in frame '" + lines->frame_id + "'";
    for (const std::string& note : notes) {
      response.message += "; " + note;
      log_.warn("load_navigation_lines: " + note);
    }
    response.success = true;
    hand_over(lines);
  } catch (const std::exception& fault) {
    response.message = std::string("nothing was loaded: ") + fault.what();
    log_.error("load_navigation_lines: " + response.message);
  }
  return true;
}

}  // namespace relative_map
