#!/usr/bin/env python3
"""localize: a bag of sensors in, a bag of poses out; the same each time, and whatever is missing."""

import math
import os
import shutil
import subprocess
import tempfile
import unittest

import rosbag
import roslib.packages
import rospy
import rostest
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import Imu, NavSatFix

STAND, ACCELERATION, TOP = 5.0, 1.0, 8.0  # [s], [m/s^2], [m/s]; to the east
METRES = math.radians(1.0) * 6386000.0 * math.cos(math.radians(48.0))  # of a degree of longitude


def speed_at(t):
    return min(TOP, ACCELERATION * max(0.0, t - STAND))


def way_at(t):
    moving, ramp = max(0.0, t - STAND), TOP / ACCELERATION
    return 0.5 * ACCELERATION * min(moving, ramp) ** 2 + TOP * max(0.0, moving - ramp)


def write_bag(path, length=40.0, imu=True, wheels=True, velocity=True, longitude=11.0):
    with rosbag.Bag(path, 'w') as bag:
        for i in range(int(100 * length)):
            t = 0.01 * i
            stamp = rospy.Time.from_sec(1000.0 + t)

            def put(topic, message):
                message.header.stamp = stamp
                bag.write(topic, message, stamp)

            if imu:
                sample = Imu()
                sample.linear_acceleration.x = ACCELERATION if 0.0 < speed_at(t) < TOP else 0.0
                sample.linear_acceleration.z = 9.8081
                put('/imu', sample)
            if wheels and i % 5 == 0:
                twist = TwistStamped()
                twist.twist.linear.x = speed_at(t)
                put('/wheel_odometry', twist)
            if i % 50 == 0:
                fix = NavSatFix()
                fix.latitude, fix.longitude, fix.altitude = 48.0, longitude + way_at(t) / METRES, 500.0
                fix.status.status = 2
                fix.position_covariance, fix.position_covariance_type = [1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 4e-4], 2
                put('/fix', fix)
                if velocity:
                    twist = TwistStamped()
                    twist.twist.linear.x = speed_at(t)
                    put('/fix_velocity', twist)


class LocalizeTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.source = os.path.join(self.folder, 'in.bag')
        self.result = os.path.join(self.folder, 'out.bag')

    def tearDown(self):
        shutil.rmtree(self.folder)

    def localize(self, *more):
        path = roslib.packages.find_node('relative_map', 'localize')[0]
        return subprocess.run([path, self.source, self.result] + list(more), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, check=False)

    def config(self, text):
        path = os.path.join(self.folder, 'config.yaml')
        with open(path, 'w') as stream:
            stream.write(text)
        return path

    def poses(self):
        with rosbag.Bag(self.result) as bag:
            messages = [(topic, m, stamp) for topic, m, stamp in bag.read_messages()]
        self.assertEqual({topic for topic, _, _ in messages}, {'/localization', '/odometry'})
        for _, m, stamp in messages:
            self.assertEqual(m.header.stamp, stamp)
        return [m for topic, m, _ in messages if topic == '/localization']

    def check(self, config='projection: "48.0, 11.0, 500.0"\n', within=0.3):
        done = self.localize('--config', self.config(config))
        self.assertEqual(done.returncode, 0, done.stderr)
        last = self.poses()[-1]
        t = last.header.stamp.to_sec() - 1000.0
        self.assertAlmostEqual(last.pose.position.x, way_at(t), delta=within)
        self.assertAlmostEqual(last.pose.position.y, 0.0, delta=within)
        self.assertAlmostEqual(last.pose.heading, 0.0, delta=0.05)
        return done, last

    def test_all_sensors(self):
        write_bag(self.source)
        _, last = self.check()
        self.assertEqual(last.status.code, 1, last.status.message)
        self.assertGreater(len(self.poses()), 3000)

    def test_the_same_each_time(self):
        write_bag(self.source, length=20.0)
        self.check()
        with open(self.result, 'rb') as stream:
            first = stream.read()
        self.check()
        with open(self.result, 'rb') as stream:
            self.assertEqual(first, stream.read())

    def test_without_inertial_sensor_it_is_planar(self):
        write_bag(self.source, imu=False)
        done, _ = self.check()
        self.assertIn('planar', done.stderr)

    def test_without_velocity(self):
        write_bag(self.source, velocity=False)
        self.check()

    def test_without_wheels_and_velocity(self):
        write_bag(self.source, velocity=False, wheels=False)
        self.check()

    def test_fixes_alone(self):
        write_bag(self.source, imu=False, wheels=False, velocity=False)
        self.check(within=0.6)

    def test_rtk(self):
        write_bag(self.source)
        self.check('method: rtk\nprojection: "48.0, 11.0, 500.0"\n')

    def test_utm_is_the_default_and_turned_by_its_convergence(self):
        write_bag(self.source)
        self.assertEqual(self.localize().returncode, 0)
        last = self.poses()[-1]
        # Two degrees east of the middle of zone 32.
        self.assertAlmostEqual(last.pose.heading, math.radians(2.0) * math.sin(math.radians(48.0)), delta=0.005)
        self.assertAlmostEqual(last.pose.position.x, 649000.0, delta=500.0)

    def test_faults_are_sentences(self):
        write_bag(self.source, length=1.0)
        done = self.localize('--config', self.config('method: guess\nnonsense: 1\n'))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('guess', done.stderr)
        self.assertIn('nonsense', done.stderr)
        self.assertFalse(os.path.exists(self.result))
        with rosbag.Bag(self.source, 'w') as bag:
            bag.write('/other', TwistStamped(), rospy.Time.from_sec(1.0))
        self.assertIn('none of the topics', self.localize().stderr)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'localize_test', LocalizeTest)
