#!/usr/bin/env python3
"""A day on which everything goes wrong once: the nodelet stays alive, and each map is right or empty."""

import math
import os
import random
import subprocess
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from relative_map.msg import Chassis, LaneMarker, LaneMarkers, LocalizationEstimate, MapMsg, MapStatus
from rosgraph_msgs.msg import Clock

import drive

STEP = 0.02  # [s] of the clock, and of the world
SPEED = 10.0  # [m/s]
SETTLE = 1.0  # [s] in which the map must be right again


class World:
    """The clock, the car, and its sensors, each of which can be made to fail."""

    def __init__(self):
        self.now = 1000.0
        self.s, self.l = 50.0, 0.2
        self.localizes, self.sees = True, False
        self.spoil = lambda estimate: None  # what is done to each localization before it is sent
        self.spoil_markers = lambda markers: None
        self.spoil_chassis = lambda chassis: None
        self.truth = {}  # stamp [ns] to (s, l)
        self.clock = rospy.Publisher('/clock', Clock, queue_size=1)
        self.navigation = rospy.Publisher('navigation', drive.NavigationInfo, queue_size=1, latch=True)
        self.markers = rospy.Publisher('perception/lane_markers', LaneMarkers, queue_size=10)
        self.open_localization()

    def open_localization(self):
        self.localization = rospy.Publisher('localization', LocalizationEstimate, queue_size=10)
        self.chassis = rospy.Publisher('chassis', Chassis, queue_size=10)

    def close_localization(self):
        self.localization.unregister()
        self.chassis.unregister()

    def stamp(self):
        return rospy.Time.from_sec(round(self.now, 6))

    def run(self, seconds):
        """Drives on, about as fast as real time."""
        for _ in range(int(round(seconds / STEP))):
            self.now += STEP
            self.s = 50.0 + (self.s - 50.0 + SPEED * STEP) % 300.0
            self.clock.publish(Clock(self.stamp()))
            if self.localizes:
                self._publish_pose()
            if self.sees:
                self._publish_markers()
            time.sleep(STEP)

    def _publish_pose(self):
        message = LocalizationEstimate()
        message.header.stamp = self.stamp()
        message.header.frame_id = 'map'
        message.pose.position.x, message.pose.position.y = drive.at(self.s, self.l)
        message.pose.heading = drive.HEADING
        message.pose.orientation.z = math.sin(drive.HEADING / 2)
        message.pose.orientation.w = math.cos(drive.HEADING / 2)
        self.truth[message.header.stamp.to_nsec()] = (self.s, self.l)
        self.spoil(message)
        self.localization.publish(message)
        chassis = Chassis(speed_mps=SPEED, gear_location=Chassis.GEAR_DRIVE)
        chassis.header.stamp = message.header.stamp
        self.spoil_chassis(chassis)
        self.chassis.publish(chassis)

    def _publish_markers(self):
        message = LaneMarkers()
        message.header.stamp = self.stamp()
        for marker, side in ((message.left_lane_marker, 1), (message.right_lane_marker, -1)):
            marker.lane_type = LaneMarker.DOTTED_WHITE
            marker.quality = 0.9
            marker.c0_position = side * 1.75 - self.l
            marker.view_range = 50.0
        self.spoil_markers(message)
        self.markers.publish(message)


class BadDayTest(unittest.TestCase):

    def setUp(self):
        rospy.init_node('bad_day_test')
        self.maps = []
        self.subscriber = rospy.Subscriber('relative_map', MapMsg, self.maps.append)
        self.world = World()
        self.world.navigation.publish(self._good_lines())
        end = time.time() + 20.0
        while time.time() < end and not (self.maps and self.maps[-1].status.code == MapStatus.OK):
            self.world.run(0.1)

    @staticmethod
    def _good_lines():
        message = drive.navigation()
        message.header.stamp = rospy.Time(1)
        return message

    def maps_of(self, seconds):
        first = len(self.maps)
        self.world.run(seconds)
        time.sleep(0.2)
        return self.maps[first:]

    def assert_right(self, message, what):
        """The lanes lie where they are seen from the pose at the map's stamp."""
        self.assertEqual(message.status.code, MapStatus.OK, '%s: %s' % (what, message.status))
        self.assertIn(message.header.stamp.to_nsec(), self.world.truth, what)
        _, l = self.world.truth[message.header.stamp.to_nsec()]
        self.assertEqual(len(message.hdmap.lane), 3, what)
        for lane, y in zip(message.hdmap.lane, (drive.SPACING, 0.0, -drive.SPACING)):
            for point in lane.central_curve.segment[0].line_segment.point:
                self.assertAlmostEqual(point.y, y - l, delta=0.02, msg=what)

    def assert_all_right_or_empty(self, maps, what):
        for message in maps:
            if message.hdmap.lane:
                self.assert_right(message, what)
            else:
                self.assertNotEqual(message.status.code, MapStatus.OK, what)
                self.assertNotEqual(message.status.message, '', what)

    def assert_well_again(self, what):
        self.assert_all_right_or_empty(self.maps_of(SETTLE), what)
        maps = self.maps_of(1.0)
        self.assertGreater(len(maps), 3, what)
        for message in maps:
            self.assert_right(message, what)

    def assert_says(self, maps, code, what):
        self.assert_all_right_or_empty(maps, what)
        self.assertIn(code, [m.status.code for m in maps], what)
        self.assertEqual(maps[-1].status.code, code, what)

    def test_a_bad_day(self):
        world = self.world
        self.assert_well_again('at the start')

        world.localizes = False
        self.assert_says(self.maps_of(2.0), MapStatus.STALE_LOCALIZATION, 'localization drops out')
        world.localizes = True
        self.assert_well_again('localization is back')

        world.sees = True
        self.assert_well_again('markers appear')
        world.sees = False
        self.assert_well_again('markers disappear')

        world.close_localization()
        world.localizes = False
        self.assert_says(self.maps_of(2.0), MapStatus.STALE_LOCALIZATION, 'the publisher dies')
        world.open_localization()
        world.localizes = True
        self.maps_of(1.0)  # connections take their time
        self.assert_well_again('the publisher returns')

        world.s += 180.0
        self.assert_well_again('the pose jumps ahead')
        world.s = 60.0
        self.assert_well_again('the pose jumps back')
        world.l = 60.0
        self.assert_says(self.maps_of(1.0), MapStatus.OFF_ROUTE, 'the pose jumps off the route')
        world.l = -0.3
        self.assert_well_again('the pose is on the route again')

        world.now += 100.0
        self.assert_well_again('the clock leaps ahead')
        world.now -= 300.0
        self.assert_well_again('the clock leaps back, as when a bag begins anew')

        self._spoil_localization()
        self._spoil_navigation()
        self._stop_the_clock()
        self._check_contract()

    def test_days_of_chance(self):
        """Several things go wrong at once, by seeded chance."""
        self.assert_well_again('at the start')
        for seed in (1, 2):
            chance = random.Random(seed)
            for round_ in range(8):
                what = 'seed %d, round %d: ' % (seed, round_)
                faults = chance.sample(self._faults(chance), chance.randint(1, 4))
                what += ', '.join(fault.__name__ for fault in faults)
                for fault in faults:
                    fault()
                self.assert_all_right_or_empty(self.maps_of(chance.uniform(0.3, 1.2)), what)
                self._mend()
                self.assert_well_again('after ' + what)
        self._check_contract()

    def _faults(self, chance):
        """What can go wrong; each of them lasts until it is mended, or happens once."""
        world = self.world

        def no_localization():
            world.localizes = False

        def localization_publisher_dies():
            world.close_localization()
            world.open_localization()

        def camera_sees():
            world.sees = True

        def camera_publisher_dies():
            world.markers.unregister()
            world.markers = rospy.Publisher('perception/lane_markers', LaneMarkers, queue_size=10)

        def camera_sees_wrong():
            world.sees = True
            field, value = chance.choice((('c0_position', drive.NAN), ('c0_position', 20.0), ('c0_position', -world.l),
                                          ('view_range', -5.0), ('quality', 90.0), ('longitude_start', -1e9)))

            def spoil(markers):
                setattr(markers.left_lane_marker, field, value)
                setattr(markers.right_lane_marker, field, value)
            world.spoil_markers = spoil

        def pose_jumps():
            world.s = chance.uniform(60.0, 300.0)
            world.l = chance.uniform(-0.5, 0.5)

        def pose_is_off_the_route():
            world.l = chance.choice((-60.0, 60.0))

        def clock_leaps():
            world.now += chance.choice((-1.0, 1.0)) * chance.uniform(0.5, 100.0)

        def localization_is_spoilt():
            def spoil(estimate):
                estimate.pose.position.x = chance.choice((estimate.pose.position.x, drive.NAN, 1e30))
                estimate.pose.linear_velocity.x = chance.choice((0.0, drive.NAN, 1000.0))
                estimate.pose.angular_velocity_vrf.z = chance.choice((0.0, drive.NAN, 1e6))
                estimate.child_frame_id = chance.choice(('base_link', 'base_link', 'no_such_link'))
            world.spoil = spoil

        def chassis_is_spoilt():
            def spoil(chassis):
                chassis.speed_mps = chance.choice((drive.NAN, 1000.0))
            world.spoil_chassis = spoil

        def lines_are_spoilt():
            message = self._good_lines()
            for path in message.navigation_path:
                path.path.path_point[chance.randrange(len(path.path.path_point))].y = drive.NAN
            world.navigation.publish(message)

        def no_lines():
            world.navigation.publish(drive.NavigationInfo(header=self._good_lines().header))

        def lines_of_another_frame():
            message = self._good_lines()
            message.header.frame_id = 'utm'
            world.navigation.publish(message)

        return [no_localization, localization_publisher_dies, camera_sees, camera_publisher_dies, camera_sees_wrong,
                pose_jumps, pose_is_off_the_route, clock_leaps, localization_is_spoilt, chassis_is_spoilt,
                lines_are_spoilt, no_lines, lines_of_another_frame]

    def _mend(self):
        world = self.world
        world.localizes, world.sees = True, False
        world.spoil = world.spoil_markers = world.spoil_chassis = lambda message: None
        if abs(world.l) > 1.0:
            world.l = 0.2
        world.navigation.publish(self._good_lines())
        world.run(0.5)  # connections take their time

    def _spoil_localization(self):
        def position_is_nan(estimate):
            estimate.pose.position.x = drive.NAN

        def direction_is_not_given(estimate):
            estimate.pose.heading = drive.NAN
            estimate.pose.orientation.z = estimate.pose.orientation.w = 0.0

        def directions_disagree(estimate):
            estimate.pose.heading = drive.HEADING + 0.8

        def stamp_is_ahead(estimate):
            estimate.header.stamp += rospy.Duration(20)

        def link_is_unknown(estimate):
            estimate.child_frame_id = 'no_such_link'

        def frame_is_another(estimate):
            estimate.header.frame_id = 'odom'

        for spoil, code in ((position_is_nan, MapStatus.INVALID_LOCALIZATION),
                            (direction_is_not_given, MapStatus.INVALID_LOCALIZATION),
                            (directions_disagree, MapStatus.INVALID_LOCALIZATION),
                            (link_is_unknown, MapStatus.NO_TRANSFORM),
                            (frame_is_another, MapStatus.FRAME_MISMATCH),
                            (stamp_is_ahead, MapStatus.INVALID_LOCALIZATION)):
            self.world.spoil = spoil
            self.assert_says(self.maps_of(1.5), code, spoil.__name__)
            self.world.spoil = lambda estimate: None
            self.assert_well_again('no longer: ' + spoil.__name__)

    def _spoil_navigation(self):
        self.world.navigation.publish(self._good_lines())
        self.assert_well_again('the lines are sent again')
        bad = self._good_lines()
        for path in bad.navigation_path:
            path.path.path_point[7].x = drive.NAN
        self.world.navigation.publish(bad)
        self.maps_of(SETTLE)
        self.assert_says(self.maps_of(1.0), MapStatus.NO_NAVIGATION_LINE, 'lines with a point that is no number')
        self.world.navigation.publish(self._good_lines())
        self.assert_well_again('good lines again')

    @staticmethod
    def _summary(diagnostics):
        """The newest word about the map."""
        return [s for d in diagnostics for s in d.status if s.name.endswith('relative map')][-1]

    def _stop_the_clock(self):
        seen = []
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, seen.append)
        time.sleep(4.5)
        subscriber.unregister()
        self.assertGreater(len(seen), 1, 'diagnostics go on while the clock stands')
        self.assertEqual(self._summary(seen).level, DiagnosticStatus.WARN)
        self.assertIn('the clock stands still', self._summary(seen).message)
        self.assert_well_again('the clock runs again')

    def _check_contract(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, 'maps.bag')
            with rosbag.Bag(file, 'w') as bag:
                for number, message in enumerate(self.maps):
                    bag.write('/relative_map', message, rospy.Time(1 + number))
            check = subprocess.run(['rosrun', 'relative_map', 'check_maps', file], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True)
            self.assertEqual(check.returncode, 0, check.stdout)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'bad_day', BadDayTest)
