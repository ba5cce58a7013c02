#!/usr/bin/env python3
"""Standard messages in, a map and paths out, with no line of code between."""

import math
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped
from nav_msgs.msg import Odometry, Path
from relative_map.msg import Chassis, FusionState, LaneMarkers, LocalizationEstimate, MapMsg
from tf2_msgs.msg import TFMessage

from node_support import Latest, wait_for

SPEED = 10.0  # [m/s]
HEADING = 0.5  # [rad] of the road


def on_road(s, left):
    return s * math.cos(HEADING) - left * math.sin(HEADING), s * math.sin(HEADING) + left * math.cos(HEADING)


def path(points, frame, stamp=None):
    message = Path()
    message.header.frame_id = frame
    message.header.stamp = stamp or rospy.Time.now()
    for x, y in points:
        pose = PoseStamped()
        pose.pose.position.x, pose.pose.position.y = x, y
        pose.pose.orientation.w = 1.0
        message.poses.append(pose)
    return message


class Adapters(unittest.TestCase):
    def setUp(self):
        self.publishers = {}
        self.s = 20.0
        self.ended = threading.Event()
        for name, left in (('route', 0.0), ('beside', 3.5)):
            publisher = rospy.Publisher(name, Path, queue_size=1, latch=True)
            publisher.publish(path([on_road(s, left) for s in range(0, 1500, 2)], 'map'))
            self.publishers[name] = publisher
        self.odom = rospy.Publisher('odom', Odometry, queue_size=10)
        self.twist = rospy.Publisher('can/twist', TwistStamped, queue_size=10)
        self.tf = rospy.Publisher('/tf', TFMessage, queue_size=10)
        self.borders = [rospy.Publisher('camera/' + side, Path, queue_size=10) for side in ('left', 'right')]
        self.thread = threading.Thread(target=self.drive, daemon=True)
        self.thread.start()
        self.addCleanup(self.stop)

    def stop(self):
        self.ended.set()
        self.thread.join()

    def drive(self):
        """0.4 m left of the route's line, and in the middle of the painted lane."""
        last = rospy.Time.now()
        while not self.ended.wait(0.05):
            now = rospy.Time.now()
            self.s += SPEED * (now - last).to_sec()
            last = now
            odometry = Odometry(child_frame_id='base_link')
            odometry.header.stamp, odometry.header.frame_id = now, 'map'
            odometry.pose.pose.position.x, odometry.pose.pose.position.y = on_road(self.s, 0.4)
            odometry.pose.pose.orientation.z = math.sin(HEADING / 2.0)
            odometry.pose.pose.orientation.w = math.cos(HEADING / 2.0)
            odometry.twist.twist.linear.x = SPEED
            self.odom.publish(odometry)
            twist = TwistStamped()
            twist.header.stamp = now
            twist.twist.linear.x = -SPEED
            self.twist.publish(twist)
            transform = TransformStamped(child_frame_id='tf_car/base_link')
            transform.header = odometry.header
            transform.transform.translation.x, transform.transform.translation.y = on_road(self.s, -0.3)
            transform.transform.rotation = odometry.pose.pose.orientation
            self.tf.publish(TFMessage([transform]))
            for publisher, y in zip(self.borders, (1.75, -1.75)):
                publisher.publish(path([(x, y) for x in range(0, 60, 2)], 'base_link', now))

    def test_odometry_twist_paths_and_borders_make_a_map(self):
        maps = Latest('relative_map', MapMsg)
        chassis, markers = Latest('chassis', Chassis), Latest('perception/lane_markers', LaneMarkers)
        localization = Latest('localization', LocalizationEstimate)
        wait_for(lambda: maps.message and len(maps.message.hdmap.lane) == 2 and
                 maps.message.fusion.source == FusionState.FUSED, 'fused map of two lanes')
        message = maps.message
        self.assertEqual(message.header.frame_id, 'base_link')
        current = next(p for p in message.navigation_path if p.lane_id == message.current_lane_id)
        self.assertEqual(current.navigation_path.path_priority, 0)
        self.assertAlmostEqual(current.navigation_path.path.path_point[-1].y, -0.4, delta=0.45)
        self.assertEqual((chassis.message.gear_location, chassis.message.speed_mps), (Chassis.GEAR_REVERSE, SPEED))
        self.assertAlmostEqual(localization.message.pose.linear_velocity.x, SPEED * math.cos(HEADING), 6)
        wait_for(lambda: markers.message.left_lane_marker.quality and markers.message.right_lane_marker.quality,
                 'markers of both sides')
        self.assertAlmostEqual(markers.message.left_lane_marker.c0_position, 1.75, 6)
        self.assertAlmostEqual(markers.message.right_lane_marker.c0_position, -1.75, 6)
        self.assertEqual(markers.message.left_lane_marker.view_range, 58.0)

    def test_lanes_are_published_as_paths(self):
        paths = {name: Latest('relative_map_adapters/lanes/' + name, Path)
                 for name in ('current/centerline', 'current/left_border', 'left_1/centerline', 'right_1/centerline')}
        wait_for(lambda: all(p.message for p in paths.values()) and len(paths['left_1/centerline'].message.poses) > 50,
                 'paths')
        self.assertEqual(paths['current/centerline'].message.header.frame_id, 'base_link')
        self.assertGreater(len(paths['current/left_border'].message.poses), 50)
        self.assertEqual(paths['right_1/centerline'].message.poses, [])

    def test_tf_alone_makes_a_map(self):
        maps = Latest('/tf_car/relative_map', MapMsg)
        wait_for(lambda: maps.message and len(maps.message.hdmap.lane) == 1, 'map of one lane')
        self.assertEqual(maps.message.header.frame_id, 'tf_car/base_link')
        self.assertAlmostEqual(maps.message.navigation_path[0].navigation_path.path.path_point[-1].y, 0.3, 3)
        self.assertEqual(maps.message.localization.child_frame_id, 'tf_car/base_link')


if __name__ == '__main__':
    rospy.init_node('adapters_test')
    rostest.rosrun('relative_map', 'adapters', Adapters)
