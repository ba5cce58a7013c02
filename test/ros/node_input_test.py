#!/usr/bin/env python3
"""What a running node or nodelet does with inputs that are late, missing or of no use: it says so, and lives on."""

import time

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from relative_map.msg import FusionState, LaneMarkers, MapStatus, NavigationInfo
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

import vehicle_messages as messages
from node_support import Latest, NodeTest, wait_for

NAN = float('nan')

FIXED_WEIGHT = {'lane_fusion': {'method': 'fixed_weight'}}


class Inputs(NodeTest):
    def test_one_after_the_other(self):
        self.start()
        self.vehicle.sends_localization = self.vehicle.sends_markers = False
        self.vehicle.start()
        for _ in range(2):
            map = self.maps.next_with(MapStatus.NO_LOCALIZATION)
            self.assertEqual(map.hdmap.lane, [])
            self.assertGreater(map.header.stamp, rospy.Time(0))

        self.vehicle.sends_localization = True
        self.assertEqual(self.maps.next_with(MapStatus.NO_NAVIGATION_LINE).hdmap.lane, [])

        self.vehicle.sends_markers = True
        map = self.maps.next_with(MapStatus.OK)
        self.assertEqual((len(map.hdmap.lane), map.fusion.source), (1, FusionState.LANE_MARKERS))

        self.vehicle.navigation.publish(messages.three_lines())
        self.assertEqual(self.three_lanes().fusion.source, FusionState.FUSED)

        self.vehicle.sends_markers = False
        map = self.maps.next_where(lambda head: 'lane markers' in head.text, 'a remark on markers')
        self.assertEqual((map.status.code, map.fusion.source), (MapStatus.OK, FusionState.NAVIGATION_LINE))

        self.vehicle.sends_localization = False
        for _ in range(2):
            self.assertEqual(self.maps.next_with(MapStatus.STALE_LOCALIZATION).hdmap.lane, [])

        self.vehicle.sends_localization = True
        self.three_lanes()
        self.expect_contract()

    def test_lines_that_were_published_before_it_started(self):
        navigation = rospy.Publisher('navigation', NavigationInfo, queue_size=1, latch=True)
        self.addCleanup(navigation.unregister)
        navigation.publish(messages.three_lines())
        self.start()
        self.vehicle.start()
        self.three_lanes()

    def test_lines_of_no_use_empty_the_map_and_are_named(self):
        self.drive()
        self.vehicle.sends_markers = False
        for name, points in {'empty': [], 'one_point': [(0.0, 0.0)], 'same_points': [(1.0, 1.0)] * 5,
                             'not_finite': messages.straight(500, 0.0) + [(NAN, 0.0)]}.items():
            self.vehicle.navigation.publish(messages.navigation(messages.navigation_path(name, 0, points)))
            map = self.maps.next_where(
                lambda head: head.code == MapStatus.NO_NAVIGATION_LINE and name in head.text, 'line ' + name)
            self.assertEqual(map.hdmap.lane, [])
        self.vehicle.navigation.publish(messages.navigation())
        self.maps.next_where(
            lambda head: head.code == MapStatus.NO_NAVIGATION_LINE and 'not_finite' not in head.text, 'no line')
        self.expect_contract()

    def test_a_line_of_no_use_leaves_the_others(self):
        self.drive()
        self.vehicle.navigation.publish(messages.navigation(
            messages.navigation_path('bad', 1, [(NAN, NAN)] * 9),
            messages.navigation_path('good', 2, messages.straight(1500, 0.0))))
        map = self.maps.newest_where(lambda map: len(map.navigation_path) == 1, 'one lane')
        self.assertEqual(map.navigation_path[0].navigation_path.path.name, 'good')
        self.assertEqual(map.navigation_path[0].navigation_path.path_priority, 0)

    def test_a_localization_of_no_use_empties_the_map_and_is_named(self):
        def at_no_place(localization):
            localization.pose.position.x = NAN
            return localization

        def without_direction(localization):
            localization.pose.orientation.w = 0.0
            return localization

        def in_another_frame(localization):
            localization.header.frame_id = 'odom'
            return localization

        self.drive()
        for alter, code, text in ((at_no_place, MapStatus.INVALID_LOCALIZATION, 'position.x'),
                                  (without_direction, MapStatus.INVALID_LOCALIZATION, 'direction'),
                                  (in_another_frame, MapStatus.FRAME_MISMATCH, 'odom')):
            self.vehicle.alter = alter
            map = self.maps.next_where(lambda head: head.code == code and text in head.text, text)
            self.assertEqual(map.hdmap.lane, [])
        self.vehicle.alter = lambda localization: localization
        self.three_lanes()
        self.expect_contract()

    def test_stamps_of_another_age(self):
        def stamped(message, stamp):
            message.header.stamp = stamp
            return message

        self.drive()
        for stamp, code in ((rospy.Time(1), MapStatus.STALE_LOCALIZATION),
                            (rospy.Time(4294967295, 999999999), MapStatus.INVALID_LOCALIZATION)):
            self.vehicle.alter = lambda localization: stamped(localization, stamp)
            for _ in range(12):  # and diagnostics in the meantime
                self.assertEqual(self.maps.next_with(code).hdmap.lane, [])
        self.vehicle.alter = lambda localization: localization
        self.three_lanes()
        self.vehicle.alter = lambda localization: stamped(localization, rospy.Time(0))  # not filled: of now
        self.assertEqual(self.maps.next_with(MapStatus.OK).localization.header.stamp, rospy.Time(0))
        self.three_lanes()
        self.expect_contract()

    def test_markers_of_no_use_leave_the_lines(self):
        unseen = LaneMarkers()
        unseen.header.frame_id = 'base_link'
        not_finite = messages.lane_markers(rospy.Time(0))
        not_finite.left_lane_marker.c2_curvature = not_finite.right_lane_marker.c0_position = NAN
        elsewhere = messages.lane_markers(rospy.Time(0), frame='camera_link')

        self.drive(parameters=FIXED_WEIGHT)  # which has no memory of what was seen before
        self.vehicle.sends_markers = False
        markers = rospy.Publisher('perception/lane_markers', LaneMarkers, queue_size=1)
        self.addCleanup(markers.unregister)
        wait_for(markers.get_num_connections, 'subscriber of markers')
        for message, text in ((unseen, 'quality'), (not_finite, 'nan'), (elsewhere, 'camera_link')):
            message.header.stamp = rospy.Time.now()
            markers.publish(message)
            map = self.maps.next_where(lambda head: 'lane markers' in head.text and text in head.text, text)
            self.assertEqual((map.status.code, len(map.hdmap.lane)), (MapStatus.OK, 3))
            self.assertEqual(map.fusion.source, FusionState.NAVIGATION_LINE)
        self.expect_contract()

    def test_a_localized_link_needs_its_transform(self):
        def of_imu(localization):
            localization.child_frame_id = 'imu_link'
            localization.pose.position.x += 0.4
            return localization

        self.drive(parameters=FIXED_WEIGHT)  # which takes the pose as it is
        self.vehicle.alter = of_imu
        self.assertIn('imu_link', self.maps.next_with(MapStatus.NO_TRANSFORM).status.message)
        tf_static = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self.addCleanup(tf_static.unregister)
        tf_static.publish(TFMessage([messages.static_transform('imu_link', 0.4, 0.55)]))
        map = self.maps.newest_where(
            lambda map: map.status.code == MapStatus.OK and map.localization.child_frame_id == 'imu_link', 'imu_link')
        # A vertex a metre: where the first one lies tells where base_link is.
        vertex = map.navigation_path[1].navigation_path.path.path_point[0].x + map.localization.pose.position.x - 0.4
        self.assertAlmostEqual(vertex, round(vertex), delta=1e-6)
        self.assertEqual(map.header.frame_id, 'base_link')

    def test_a_clock_that_goes_back(self):
        clock = rospy.Publisher('/clock', Clock, queue_size=1)
        self.addCleanup(clock.unregister)
        rospy.set_param('/use_sim_time', True)
        self.start()
        self.vehicle.navigation.publish(messages.three_lines())
        wait_for(clock.get_num_connections, 'subscriber of the clock')

        def map_in_a_second_from(start):
            for step in range(50):
                stamp = rospy.Time(start) + rospy.Duration(0, 20000000 * step)
                self.vehicle.sense(stamp)
                clock.publish(Clock(stamp))
                time.sleep(0.002)
            return any(head.code == MapStatus.OK and head.stamp.secs == start for head in self.maps.heads())

        wait_for(lambda: map_in_a_second_from(1000), 'map')
        wait_for(lambda: map_in_a_second_from(500), 'map after the clock went back')
        diagnostics = Latest('/diagnostics', DiagnosticArray)
        self.addCleanup(diagnostics.subscriber.unregister)
        wait_for(lambda: diagnostics.message, 'diagnostics after the clock went back')

    def test_a_clock_that_stands_still(self):
        clock = rospy.Publisher('/clock', Clock, queue_size=1)
        self.addCleanup(clock.unregister)
        said = []  # level and sentence, each second
        diagnostics = rospy.Subscriber('/diagnostics', DiagnosticArray, lambda array: said.extend(
            (status.level, status.message) for status in array.status if status.name.endswith('relative map')))
        self.addCleanup(diagnostics.unregister)
        rospy.set_param('/use_sim_time', True)
        self.start()

        def expect_warnings(what):
            first = len(said)
            wait_for(lambda: len(said) >= first + 5, 'diagnostics ' + what)
            for level, sentence in said[first + 3:]:
                self.assertEqual(level, DiagnosticStatus.WARN, what)
                self.assertIn('the clock stands still', sentence, what)

        expect_warnings('before the clock has ever come')
        self.vehicle.navigation.publish(messages.three_lines())
        wait_for(clock.get_num_connections, 'subscriber of the clock')
        now = 1000.0

        def runs():
            nonlocal now
            now += 0.02
            self.vehicle.sense(rospy.Time(now))
            clock.publish(Clock(rospy.Time(now)))
            time.sleep(0.005)
            return said and said[-1][0] == DiagnosticStatus.OK

        wait_for(runs, 'diagnostics that all is well while the clock runs')
        expect_warnings('after the clock has stopped')
        wait_for(runs, 'diagnostics that all is well while the clock runs again')


if __name__ == '__main__':
    rospy.init_node('node_input_test')
    rostest.rosrun('relative_map', 'inputs', Inputs)
