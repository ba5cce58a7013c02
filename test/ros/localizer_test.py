#!/usr/bin/env python3
"""Sensors of a short drive in, poses out; the services, and what is told when something is wrong."""

import math
import threading
import unittest

import diagnostic_msgs.msg
import nav_msgs.msg
import rospy
import rostest
import std_srvs.srv
from geometry_msgs.msg import TransformStamped, TwistStamped
from relative_map.msg import LocalizationEstimate, LocalizationStatus
from sensor_msgs.msg import Imu, NavSatFix
from tf2_msgs.msg import TFMessage

STAND, ACCELERATION, TOP = 3.0, 1.5, 6.0  # [s], [m/s^2], [m/s]; to the north
GRAVITY = 9.8096  # [m/s^2] there


def speed_at(t):
    return min(TOP, ACCELERATION * max(0.0, t - STAND))


def way_at(t):
    moving = max(0.0, t - STAND)
    ramp = TOP / ACCELERATION
    return 0.5 * ACCELERATION * min(moving, ramp) ** 2 + TOP * max(0.0, moving - ramp)


class LocalizerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('localizer_test')
        cls.poses, cls.odometry, cls.statuses = [], [], []
        cls.changed = threading.Condition()
        cls.imu = rospy.Publisher('imu', Imu, queue_size=200)
        cls.fix = rospy.Publisher('fix', NavSatFix, queue_size=10)
        cls.velocity = rospy.Publisher('fix_velocity', TwistStamped, queue_size=10)
        cls.links = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        cls.send_links()
        cls.subscribers = [
            rospy.Subscriber('localization', LocalizationEstimate, cls.poses.append, queue_size=200),
            rospy.Subscriber('odometry', nav_msgs.msg.Odometry, cls.odometry.append, queue_size=200),
            rospy.Subscriber('/diagnostics', diagnostic_msgs.msg.DiagnosticArray, cls.on_diagnostics)]
        rospy.wait_for_service('localizer/reset', 30.0)
        while cls.imu.get_num_connections() == 0 or cls.velocity.get_num_connections() == 0:
            rospy.sleep(0.05)
        rospy.sleep(0.5)
        cls.drive(18.0)

    @classmethod
    def on_diagnostics(cls, message):
        for status in message.status:
            if 'localizer' in status.name:
                cls.statuses.append(status)

    @classmethod
    def send_links(cls):
        links = []
        # The inertial sensor looks to the left.
        for child, x, z, w in (('imu_link', 0.5, math.sqrt(0.5), math.sqrt(0.5)), ('gps', 1.0, 0.0, 1.0)):
            link = TransformStamped()
            link.header.frame_id, link.child_frame_id, link.header.stamp = 'base_link', child, rospy.Time.now()
            link.transform.translation.x = x
            link.transform.rotation.z, link.transform.rotation.w = z, w
            links.append(link)
        cls.links.publish(TFMessage(links))

    @classmethod
    def drive(cls, length):
        cls.start = rospy.Time.now()
        rate = rospy.Rate(100)
        for i in range(int(100 * length)):
            t = 0.01 * i
            stamp = cls.start + rospy.Duration(t)
            imu = Imu()
            imu.header.stamp, imu.header.frame_id = stamp, 'imu_link'
            # Forward is the sensor's -y.
            imu.linear_acceleration.y = -ACCELERATION if 0.0 < speed_at(t) < TOP else 0.0
            imu.linear_acceleration.z = GRAVITY
            cls.imu.publish(imu)
            if i % 20 == 0:
                fix = NavSatFix()
                fix.header.stamp, fix.header.frame_id = stamp, 'gps'
                fix.latitude = 48.0 + math.degrees((way_at(t) + 1.0) / 6372000.0 * 1.0)
                fix.longitude, fix.altitude = 11.0, 500.0
                fix.status.status = 2
                fix.position_covariance = [1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 4e-4]
                fix.position_covariance_type = 2
                cls.fix.publish(fix)
                velocity = TwistStamped()
                velocity.header.stamp = stamp
                velocity.twist.linear.y = speed_at(t)
                cls.velocity.publish(velocity)
            rate.sleep()
        rospy.sleep(0.5)

    def test_poses_are_those_of_the_drive(self):
        poses = [p for p in self.poses if p.header.stamp >= self.start + rospy.Duration(12.0)]
        self.assertGreater(len(poses), 300)
        last = poses[-1]
        t = (last.header.stamp - self.start).to_sec()
        self.assertEqual(last.status.code, LocalizationStatus.OK, last.status.message)
        self.assertEqual((last.header.frame_id, last.child_frame_id), ('map', 'base_link'))
        self.assertAlmostEqual(last.pose.position.x, 0.0, delta=0.2)
        self.assertAlmostEqual(last.pose.position.y, way_at(t), delta=0.3)
        self.assertAlmostEqual(last.pose.heading, math.pi / 2, delta=0.05)
        self.assertAlmostEqual(last.pose.linear_velocity.y, TOP, delta=0.2)
        self.assertLess(last.uncertainty.position_std_dev.x, 0.15)
        self.assertEqual(last.measurement_time, last.header.stamp)
        stamps = [p.header.stamp for p in self.poses]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))

    def test_odometry_says_the_same(self):
        last = self.odometry[-1]
        self.assertAlmostEqual(last.twist.twist.linear.x, TOP, delta=0.2)
        self.assertAlmostEqual(last.pose.pose.orientation.z, math.sqrt(0.5), delta=0.05)
        self.assertGreater(last.pose.covariance[0], 0.0)

    def test_diagnostics_name_the_sources(self):
        texts = [entry.key for status in self.statuses for entry in status.values]
        self.assertIn('fix', texts)
        self.assertIn('yaw sigma [deg]', texts)

    def test_services_answer(self):
        datum = rospy.ServiceProxy('localizer/set_datum', std_srvs.srv.Trigger)()
        self.assertTrue(datum.success, datum.message)
        self.assertIn('origin', datum.message)
        align = rospy.ServiceProxy('localizer/align', std_srvs.srv.Trigger)()
        self.assertTrue(align.success, align.message)
        self.assertTrue(rospy.ServiceProxy('localizer/reset', std_srvs.srv.Trigger)().success)
        again = rospy.ServiceProxy('localizer/align', std_srvs.srv.Trigger)()
        self.assertFalse(again.success)
        self.assertIn('no fix', again.message)

    def test_without_a_fix_it_says_so(self):
        bad = NavSatFix()
        bad.header.stamp, bad.header.frame_id = rospy.Time.now(), 'gps'
        bad.status.status = -1
        before = len(self.poses)
        self.fix.publish(bad)
        deadline = rospy.Time.now() + rospy.Duration(6.0)
        while rospy.Time.now() < deadline and not any('no fix' in status.message for status in self.statuses):
            rospy.sleep(0.1)
        self.assertTrue(any('no fix' in status.message for status in self.statuses))
        self.assertEqual(len(self.poses), before)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'localizer_test', LocalizerTest)
