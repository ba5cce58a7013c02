"""Messages as a vehicle sends them that drives along the x axis of the map frame, on the middle one of three lines."""

import math

import rospy
from relative_map.msg import Chassis, LaneMarker, LaneMarkers, LocalizationEstimate, NavigationInfo, NavigationPath
from relative_map.msg import PathPoint

LANE_WIDTH = 3.5  # [m] between the lines
SPEED = 10.0  # [m/s]


def navigation_path(name, priority, points):
    line = NavigationPath(path_priority=priority)
    line.path.name = name
    nan = float('nan')
    line.path.path_point = [PathPoint(x=x, y=y, z=nan, theta=nan, kappa=nan, dkappa=nan, s=nan) for x, y in points]
    return line


def straight(length, y):
    return [(float(x), y) for x in range(int(length) + 1)]


def navigation(*lines, frame='map'):
    info = NavigationInfo(navigation_path=list(lines))
    info.header.frame_id = frame
    return info


def three_lines(length=1500):
    return navigation(navigation_path('left', 2, straight(length, LANE_WIDTH)),
                      navigation_path('middle', 0, straight(length, 0.0)),
                      navigation_path('right', 1, straight(length, -LANE_WIDTH)))


def localization(stamp, x=20.0, y=0.0, child_frame='base_link'):
    message = LocalizationEstimate(child_frame_id=child_frame)
    message.header.stamp = stamp
    message.header.frame_id = 'map'
    message.pose.position.x = x
    message.pose.position.y = y
    message.pose.orientation.w = 1.0
    message.pose.heading = float('nan')
    message.pose.linear_velocity.x = SPEED
    return message


def chassis(stamp):
    message = Chassis(speed_mps=SPEED, gear_location=Chassis.GEAR_DRIVE)
    message.header.stamp = stamp
    return message


def lane_marker(c0):
    return LaneMarker(lane_type=LaneMarker.SOLID_WHITE, quality=1.0, model_degree=3, c0_position=c0, view_range=60.0)


def lane_markers(stamp, middle=0.0, frame='base_link'):
    """The paint of a straight lane whose middle lies so far [m] to the left of the sensor."""
    message = LaneMarkers(left_lane_marker=lane_marker(middle + 0.5 * LANE_WIDTH),
                          right_lane_marker=lane_marker(middle - 0.5 * LANE_WIDTH))
    message.header.stamp = stamp
    message.header.frame_id = frame
    return message


def static_transform(child, x, z, parent='base_link'):
    from geometry_msgs.msg import TransformStamped
    transform = TransformStamped(child_frame_id=child)
    transform.header.frame_id = parent
    transform.transform.translation.x = x
    transform.transform.translation.z = z
    transform.transform.rotation.w = 1.0
    return transform


def seconds(value):
    """An exact duration."""
    return rospy.Duration(int(math.floor(value)), int(round((value % 1.0) * 1e9)))
