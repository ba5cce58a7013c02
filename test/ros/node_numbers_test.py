#!/usr/bin/env python3
"""Bad numbers, sent to a running node or nodelet: each is named once in its log, by topic, field and value, and shown in
its diagnostics; the map meanwhile is right or empty, and whole again afterwards."""

import math
import time

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from relative_map.msg import MapStatus
from rosgraph_msgs.msg import Log

import vehicle_messages as messages
from node_support import NodeTest, wait_for

NAN, INFINITY = float('nan'), float('inf')
LONG_ENOUGH = 1.5  # [s] for many messages, and a round of diagnostics
THROTTLE = 10.0  # [s] in which the same complaint comes once


def is_right(map):
    """The vehicle drives on the middle line, straight on."""
    lines = (messages.LANE_WIDTH, 0.0, -messages.LANE_WIDTH)

    def on_one_line(lane):
        points = lane.central_curve.segment[0].line_segment.point
        return any(all(abs(point.y - y) < 0.1 for point in points) for y in lines)

    return map.status.code == MapStatus.OK and all(on_one_line(lane) for lane in map.hdmap.lane)


def is_empty(map):
    return map.status.code != MapStatus.OK and not map.hdmap.lane and map.status.message


class Numbers(NodeTest):
    def setUp(self):
        self.log, self.diagnostics = [], []
        for topic, kind, heard in (('/rosout', Log, self._hear_log), ('/diagnostics', DiagnosticArray, self._hear)):
            self.addCleanup(rospy.Subscriber(topic, kind, heard).unregister)
        self.drive()

    def _hear_log(self, entry):
        if entry.name != rospy.get_name() and entry.level >= Log.WARN:
            self.log.append(entry.msg)

    def _hear(self, array):
        for status in array.status:
            self.diagnostics.append(status.message + '; ' + '; '.join(value.value for value in status.values))

    def expect(self, texts, condition):
        """Sent again and again by now: told once, shown, and the map fulfils the condition all the while."""
        def tells(sentence):
            return all(text in sentence for text in texts)

        first_log, first_map, first_diagnostic = len(self.log), len(self.maps.data), len(self.diagnostics)
        end = time.monotonic() + LONG_ENOUGH
        wait_for(lambda: any(map(tells, self.log[first_log:])), 'message with %s' % (texts,), THROTTLE)
        wait_for(lambda: any(map(tells, self.diagnostics[first_diagnostic:])), 'diagnostics with %s' % (texts,))
        time.sleep(max(0.0, end - time.monotonic()))
        self.assertEqual([tells(entry) for entry in self.log[first_log:]].count(True), 1, self.log[first_log:])
        received = [self.maps.message(i) for i in range(first_map, len(self.maps.data))]
        self.assertGreater(len(received), 8, texts)
        for message in received:
            self.assertTrue(is_right(message) or is_empty(message), (texts, message.status))
        # The first ones are from before.
        self.assertTrue(condition(received[-1]), (texts, received[-1].status))

    def expect_whole_again(self, what):
        map = self.three_lanes()
        self.assertTrue(is_right(map), what)

    def expect_of(self, alter, cases):
        """`alter` is the vehicle's attribute that changes a message before it is sent."""
        unchanged = getattr(self.vehicle, alter)
        for spoil, texts, condition in cases:
            def spoilt(message, spoil=spoil):
                spoil(message)
                return message
            setattr(self.vehicle, alter, spoilt)
            self.expect(texts, condition)
            setattr(self.vehicle, alter, unchanged)
            self.expect_whole_again(texts)
        self.expect_contract()

    def test_of_localization(self):
        def face(pose, heading, yaw, scale=1.0):
            pose.heading = heading
            pose.orientation.z, pose.orientation.w = scale * math.sin(yaw / 2), scale * math.cos(yaw / 2)

        def no_place(localization):
            localization.pose.position.x = NAN

        def no_place_on_earth(localization):
            localization.pose.position.y = 1e30

        def no_direction(localization):
            localization.pose.orientation.w = 0.0

        def no_orientation(localization):
            face(localization.pose, 1e-5, 0.0, scale=0.0)

        def not_normalised(localization):
            face(localization.pose, NAN, 0.0, scale=3.0)

        def no_heading(localization):
            face(localization.pose, INFINITY, 0.0)

        def two_directions(localization):
            face(localization.pose, 0.8, 1e-4)

        def another_convention(localization):
            face(localization.pose, 1e-4, -math.pi / 2)

        def too_fast(localization):
            localization.pose.linear_velocity.x = 1000.0

        def turning_by_nan(localization):
            localization.pose.angular_velocity_vrf.z = NAN

        self.expect_of('alter', (
            (no_place, ('localization', 'pose.position.x', 'nan'), is_empty),
            (no_place_on_earth, ('localization', 'pose.position.y', '1e+30'), is_empty),
            (no_direction, ('localization', 'pose.heading is nan', 'pose.orientation', '(0, 0, 0, 0)'), is_empty),
            (no_orientation, ('localization', 'pose.orientation', '(0, 0, 0, 0): ignored'), is_right),
            (not_normalised, ('localization', 'pose.orientation', 'norm 3'), is_right),
            (no_heading, ('localization', 'pose.heading', 'inf'), is_right),
            (two_directions, ('localization', 'pose.heading (0.8 rad)', 'pose.orientation', '45.8'), is_empty),
            (another_convention, ('localization', 'pose.heading', 'pose.orientation', '90', 'orientation_convention'),
             is_right),
            (too_fast, ('localization', 'pose.linear_velocity', '1000'), is_right),
            (turning_by_nan, ('localization', 'pose.angular_velocity_vrf.z', 'nan'), is_right)))

    def test_of_chassis(self):
        def too_fast(chassis):
            chassis.speed_mps = 1000.0

        self.expect_of('alter_chassis', ((too_fast, ('chassis', 'speed_mps', '1000'), is_right),))

    def test_of_chassis_that_are_none(self):
        def no_number(chassis):
            chassis.speed_mps = NAN

        self.expect_of('alter_chassis', ((no_number, ('chassis', 'speed_mps', 'nan'), is_right),))

    def test_of_markers(self):
        def nothing_seen(markers):
            markers.left_lane_marker.view_range = -5.0

        def all_too_sure(markers):
            markers.right_lane_marker.quality = 90.0

        def no_curve(markers):
            markers.left_lane_marker.c2_curvature = NAN

        def seen_without_end(markers):
            markers.left_lane_marker.view_range = markers.right_lane_marker.view_range = INFINITY

        def no_width(markers):
            markers.left_lane_marker.c0_position = markers.right_lane_marker.c0_position = 0.0

        def forty_metres(markers):
            markers.left_lane_marker.c0_position, markers.right_lane_marker.c0_position = 20.0, -20.0

        topic = 'perception/lane_markers'
        self.expect_of('alter_markers', (
            (nothing_seen, (topic, 'left_lane_marker.view_range', '-5'), is_right),
            (all_too_sure, (topic, 'right_lane_marker.quality', '90'), is_right),
            (no_curve, (topic, 'left_lane_marker.c2_curvature', 'nan'), is_right),
            (seen_without_end, (topic, 'right_lane_marker.view_range', 'inf'), is_right),
            (no_width, (topic, 'c0_position', 'left_lane_marker', 'right_lane_marker', 'a lane of 0 m'), is_right),
            (forty_metres, (topic, 'left_lane_marker.c0_position', '20'), is_right)))

    def test_of_lines(self):
        def lines(priorities, **kwargs):
            info = messages.three_lines(**kwargs)
            for path, priority in zip(info.navigation_path, priorities):
                path.path_priority = priority
            return info

        no_point = lines((2, 0, 1))
        no_point.navigation_path[0].path.path_point[3].x = NAN
        no_curvature = lines((2, 0, 1))
        no_curvature.navigation_path[1].path.path_point[5].kappa = INFINITY
        many = lines((2, 0, 1))
        many.navigation_path += [messages.navigation_path('far %d' % i, 3 + i, [(0.0, 1e4 + i), (9.0, 1e4 + i)])
                                 for i in range(10000 - 3)]
        for info, texts in (
                (no_point, ('navigation', "'left'", 'path_point[3].x', 'nan')),
                (no_curvature, ('navigation', "'middle'", 'path_point[5].kappa', 'inf')),
                (lines((0, 0, 0)), ('navigation', 'path_priority', "'middle'", 'is 0')),
                (lines((4, 3, 5)), ('navigation', 'path_priority', "'middle'", 'is 3, not 0')),
                (many, ('navigation_path', '10000'))):
            sending = rospy.Timer(rospy.Duration(0.3), lambda _, info=info: self.vehicle.navigation.publish(info))
            self.expect([text for text in texts if text != 'navigation'], is_right)
            sending.shutdown()
            sending.join()
            self.assertTrue(all(entry.startswith('/relative_map: navigation: ') for entry in self.log
                                if all(text in entry for text in texts[1:])), self.log)
            self.vehicle.navigation.publish(messages.three_lines())
            self.expect_whole_again(texts)
        self.expect_contract()


if __name__ == '__main__':
    rospy.init_node('node_numbers_test')
    rostest.rosrun('relative_map', 'numbers', Numbers)
