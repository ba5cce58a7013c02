#!/usr/bin/env python3
"""The doctor finds what is wrong with a running system, and nothing wrong with a healthy one."""

import contextlib
import math
import os
import subprocess
import time
import unittest

import rospy
import rostest
from relative_map.msg import MapMsg, MapStatus
from std_msgs.msg import Float64

import faulty_vehicle

PATIENCE = 30.0  # [s] for what comes at once on a machine that is not busy
DURATION = '1.5'  # [s] of listening


def run_doctor(*arguments, **environment):
    """Its exit code, and all that it prints."""
    done = subprocess.run(['rosrun', 'relative_map', 'doctor', *arguments], env=dict(os.environ, **environment),
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=PATIENCE)
    return done.returncode, done.stdout


class DoctorTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        rospy.init_node('doctor_test')
        cls.vehicle = faulty_vehicle.Vehicle()

    def setUp(self):
        """The map is good again, whatever the last test did."""
        end = time.time() + PATIENCE
        while rospy.wait_for_message('relative_map', MapMsg, PATIENCE).status.code != MapStatus.OK:
            self.assertLess(time.time(), end, 'the map does not come back')

    def assert_finds(self, *sentences, arguments=()):
        """That the doctor says so of what is wrong."""
        code, output = run_doctor('--duration', DURATION, *arguments)
        wrong = [line for line in output.splitlines() if line.startswith('WRONG: ') and ' -> mend: ' in line]
        for sentence in sentences:
            self.assertTrue(any(sentence in line for line in wrong), '%r is not said:\n%s' % (sentence, output))
        self.assertEqual(code, 1, output)

    @contextlib.contextmanager
    def spoiled(self, sensor, spoil):
        sensor.spoil = spoil
        time.sleep(0.3)
        try:
            yield
        finally:
            sensor.spoil = None

    @contextlib.contextmanager
    def other_lines(self, change):
        message = faulty_vehicle.navigation()
        change(message)
        self.vehicle.navigation.publish(message)
        try:
            yield
        finally:
            self.vehicle.navigation.publish(faulty_vehicle.navigation())

    def test_a_healthy_system(self):
        code, output = run_doctor('--duration', '3')
        self.assertEqual(code, 0, output)
        self.assertNotIn('WRONG', output)
        self.assertIn('ok: /localization comes', output)
        self.assertIn('all is well', output)

    def test_no_chassis_is_a_note(self):
        self.vehicle.chassis.stop()
        try:
            code, output = run_doctor('--duration', DURATION)
            self.assertEqual(code, 0, output)
            self.assertIn('note: nobody publishes /chassis', output)
        finally:
            self.vehicle.chassis.start()

    def test_wrong_type(self):
        self.vehicle.chassis.stop()
        other = rospy.Publisher('chassis', Float64, queue_size=1)
        try:
            self.assert_finds('publishes /chassis as std_msgs/Float64, not as relative_map/Chassis')
        finally:
            other.unregister()
            self.vehicle.chassis.start()

    def test_another_definition(self):
        class Chassis(Float64):
            _type = 'relative_map/Chassis'
            _md5sum = '0123456789abcdef0123456789abcdef'

        self.vehicle.chassis.stop()
        other = rospy.Publisher('chassis', Chassis, queue_size=1)
        timer = rospy.Timer(rospy.Duration(0.05), lambda _: other.publish(Chassis(10.0)))
        try:
            self.assert_finds('publishes /chassis with another definition of relative_map/Chassis '
                              '(md5sum 0123456789abcdef0123456789abcdef, here ')
        finally:
            timer.shutdown()
            timer.join()
            other.unregister()
            self.vehicle.chassis.start()

    def test_two_publishers(self):
        with subprocess.Popen(['rostopic', 'pub', '-s', '-r', '1', '/chassis', 'relative_map/Chassis', '{}'],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as other:
            try:
                time.sleep(1.5)
                self.assert_finds('2 nodes publish /chassis')
            finally:
                other.terminate()

    def test_no_map_node_under_a_remapped_name(self):
        self.assert_finds('nobody publishes /other_map: the map node does not run',
                          arguments=('relative_map:=other_map',))

    def test_topics_of_another_namespace(self):
        self.assert_finds('nobody publishes /elsewhere/localization', 'nobody publishes /elsewhere/navigation',
                          arguments=('__ns:=elsewhere',))

    def test_two_map_frames(self):
        with self.other_lines(lambda message: setattr(message.header, 'frame_id', 'utm')):
            self.assert_finds("/navigation is in frame 'utm', but /localization in 'map'",
                              'maps are empty with FRAME_MISMATCH')

    def test_no_transform_of_the_localized_link(self):
        with self.spoiled(self.vehicle.localization, lambda message: setattr(message, 'child_frame_id', 'gps_link')):
            self.assert_finds("no transform from 'gps_link', the child_frame_id of /localization",
                              'maps are empty with NO_TRANSFORM')

    def test_no_transform_of_the_camera(self):
        with self.spoiled(self.vehicle.lane_markers, lambda message: setattr(message.header, 'frame_id', 'lens')):
            self.assert_finds("no transform from 'lens', the header.frame_id of /perception/lane_markers")

    def test_stamps_three_seconds_old(self):
        def spoil(message):
            message.header.stamp -= rospy.Duration(3.0)
        with self.spoiled(self.vehicle.localization, spoil):
            self.assert_finds('/localization: header.stamp is 3.0 s old', 'maps are empty with STALE_LOCALIZATION')

    def test_stamps_from_the_future(self):
        def spoil(message):
            message.header.stamp += rospy.Duration(3.0)
        with self.spoiled(self.vehicle.chassis, spoil):
            self.assert_finds('/chassis: header.stamp lies 3.0 s in the future')

    def test_heading_never_filled(self):
        with self.spoiled(self.vehicle.localization, lambda message: setattr(message.pose, 'heading', 0.0)):
            self.assert_finds('/localization: pose.heading is 0 all the time')

    def test_orientation_is_rfu(self):
        def spoil(message):
            faulty_vehicle.set_yaw(message.pose.orientation, message.pose.heading - math.pi / 2.0)
        with self.spoiled(self.vehicle.localization, spoil):
            self.assert_finds('differ by a constant 90 degrees: the orientation is that of an RFU')

    def test_slow_localization(self):
        self.vehicle.localization.rate = 4.0
        try:
            self.assert_finds('it should come 10 times or more')
        finally:
            self.vehicle.localization.rate = 40.0

    def test_kilometers_per_hour(self):
        with self.spoiled(self.vehicle.chassis, lambda message: setattr(message, 'speed_mps', 36.0)):
            self.assert_finds("speeds disagree: 36.0 m/s by /chassis's speed_mps")

    def test_line_in_another_utm_zone(self):
        def change(message):
            for point in message.navigation_path[0].path.path_point:
                point.x += 4e5
        with self.other_lines(change):
            self.assert_finds("km away (at most 15.0 m is in reach): the vehicle is at (44")

    def test_opposed_line(self):
        with self.other_lines(lambda message: message.navigation_path[0].path.path_point.reverse()):
            self.assert_finds('all lines in reach are opposed to the vehicle')

    def test_no_usable_line(self):
        def change(message):
            message.navigation_path[0].path.path_point = message.navigation_path[0].path.path_point[:1]
        with self.other_lines(change):
            self.assert_finds('/navigation: 0 of 1 lines can be used')

    def test_mirrored_markers(self):
        def spoil(message):
            for marker in (message.left_lane_marker, message.right_lane_marker):
                marker.c0_position *= -1.0
        with self.spoiled(self.vehicle.lane_markers, spoil):
            self.assert_finds('/perception/lane_markers: the left marker lies right of the right one')

    def test_orientation_convention_of_the_map_node_is_read(self):
        rospy.set_param('rfu_node/orientation_convention', 'rfu')
        self.assert_finds('but orientation_convention says otherwise', arguments=('_node:=rfu_node',))

    def test_refused_parameters_are_told(self):
        rospy.set_param('bad_node/rate', 0.0)
        self.assert_finds('the map node can not run with the parameters in /bad_node', arguments=('_node:=bad_node',))

    def test_arguments(self):
        for arguments in (('--duration',), ('--duration', 'x'), ('--duration', '0'), ('--durations', '3')):
            self.assertEqual(run_doctor(*arguments)[0], 2)
        code, output = run_doctor('--help')
        self.assertEqual(code, 0)
        self.assertIn('--duration', output)

    def test_no_master(self):
        code, output = run_doctor(ROS_MASTER_URI='http://127.0.0.1:9')
        self.assertEqual(code, 2)
        self.assertIn('there is no master at http://127.0.0.1:9', output)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'doctor_test', DoctorTest)
