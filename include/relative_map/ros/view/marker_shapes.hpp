#pragma once

#include <relative_map/MapMsg.h>
#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

// Lines for rviz, made of few points. Colours are Okabe and Ito's, which colour-blind people can tell apart.
namespace relative_map {

using Points = std::vector<geometry_msgs::Point>;

std_msgs::ColorRGBA color(double r, double g, double b, double a = 1.0);

visualization_msgs::Marker make_marker(const MapMsg& map, const std::string& ns, int id, int type);

/// The points of a curve that a screen can show: far from the vehicle they are farther apart. Both ends stay.
Points thinned(const Curve& curve);
/// [m] along `points` to the one nearest to the vehicle, among the first of them: a lap comes by again.
double s_beside_vehicle(const Points& points);
/// So far [m] to the left.
Points shifted(const Points& points, double left);

/// On and off by turns, each `length` [m], from where `phase` [m] is an even number of them; 0: no gaps.
struct Dashes {
  double length = 0.0;
  double phase = 0.0;  ///< [m] at the start of the points
};

/// Appends what lies between two arc lengths, `z` [m] higher, to the pairs of points of a LINE_LIST.
void append_stroke(const Points& points, double from, double to, const Dashes& dashes, double z,
                   Points& pairs);

}  // namespace relative_map
