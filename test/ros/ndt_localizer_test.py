#!/usr/bin/env python3
"""Clouds in, map_pose and a verdict out: first searched, then tracked, then lost, and found again."""

import math
import os
import random
import shutil
import struct
import subprocess
import tempfile
import threading
import unittest

import geometry_msgs.msg
import nav_msgs.msg
import rospy
import rostest
import sensor_msgs.msg
import std_srvs.srv
import tf2_msgs.msg
from relative_map.msg import LidarMatch

LIDAR = (1.2, 0.0, 1.8)  # in base_link


def yard(seed, count=20000):
    """Points of a yard in the map: ground, two walls, one askew, and poles; the map's z is 0 on the ground."""
    rand = random.Random(seed)
    points = []
    for _ in range(count):
        u, v, which = rand.random(), rand.random(), rand.random()
        if which < 0.45:
            point = (60 * u - 30, 50 * v - 25, 0)
        elif which < 0.6:
            point = (60 * u - 30, 25, 6 * v)
        elif which < 0.75:
            point = (-30, 50 * u - 25, 5 * v)
        elif which < 0.9:
            point = (10 + 15 * u, -20 + 12 * u, 4 * v)
        else:
            k, turn = int(8 * u), 6.28 * 8 * u
            point = (-20 + 6 * k + 0.2 * math.cos(turn), 8 - 3 * (k % 3) + 0.2 * math.sin(turn), 4 * v)
        points.append(tuple(c + rand.gauss(0, 0.02) for c in point))
    return points


def cloud(points, pose, stamp):
    """As the lidar sees them with base_link at `pose` (x, y, yaw)."""
    x, y, yaw = pose
    c, s = math.cos(yaw), math.sin(yaw)
    data = bytearray()
    for px, py, pz in points:
        dx, dy = px - x, py - y
        data += struct.pack('<fff', c * dx + s * dy - LIDAR[0], -s * dx + c * dy - LIDAR[1], pz - LIDAR[2])
    message = sensor_msgs.msg.PointCloud2()
    message.header.stamp = stamp
    message.header.frame_id = 'lidar'
    message.height, message.width = 1, len(points)
    message.fields = [sensor_msgs.msg.PointField(name, 4 * i, sensor_msgs.msg.PointField.FLOAT32, 1)
                      for i, name in enumerate('xyz')]
    message.point_step, message.row_step = 12, 12 * len(points)
    message.data = bytes(data)
    return message


class NdtLocalizerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('ndt_localizer_test')
        cls.folder = tempfile.mkdtemp()
        pcd = os.path.join(cls.folder, 'yard.pcd')
        points = yard(1, 120000)
        with open(pcd, 'w') as file:
            file.write('# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\n'
                       'HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n' % (len(points), len(points)))
            for point in points:
                file.write('%.4f %.4f %.4f\n' % point)
        cls.map = os.path.join(cls.folder, 'map')
        subprocess.check_call(['rosrun', 'relative_map', 'build_ndt_map', cls.map, pcd, '--resolution', '1'])
        cls.launched = subprocess.Popen(
            ['roslaunch', 'relative_map', 'ndt_localizer.launch', 'map:=' + cls.map,
             'nodelet:=' + ('true' if rospy.get_param('kind') == 'nodelet' else 'false')])
        mount = geometry_msgs.msg.TransformStamped(child_frame_id='lidar')
        mount.header.frame_id = 'base_link'
        mount.transform.translation = geometry_msgs.msg.Vector3(*LIDAR)
        mount.transform.rotation.w = 1.0
        cls.static = rospy.Publisher('/tf_static', tf2_msgs.msg.TFMessage, queue_size=1, latch=True)
        cls.static.publish(tf2_msgs.msg.TFMessage([mount]))
        cls.poses, cls.matches = [], []
        cls.changed = threading.Condition()
        cls.subscribers = [rospy.Subscriber('map_pose', geometry_msgs.msg.PoseWithCovarianceStamped, cls.on_pose),
                           rospy.Subscriber('ndt_localizer/match', LidarMatch, cls.on_match)]
        cls.points = rospy.Publisher('points', sensor_msgs.msg.PointCloud2, queue_size=1)
        cls.odometry = rospy.Publisher('odometry', nav_msgs.msg.Odometry, queue_size=1)
        cls.initial = rospy.Publisher('initialpose', geometry_msgs.msg.PoseWithCovarianceStamped, queue_size=1)
        rospy.wait_for_service('ndt_localizer/align', 60.0)
        for publisher in (cls.points, cls.initial, cls.odometry):
            while publisher.get_num_connections() == 0 and not rospy.is_shutdown():
                rospy.sleep(0.05)

    @classmethod
    def tearDownClass(cls):
        cls.launched.terminate()
        cls.launched.wait()
        shutil.rmtree(cls.folder)

    @classmethod
    def on_pose(cls, message):
        with cls.changed:
            cls.poses.append(message)
            cls.changed.notify_all()

    @classmethod
    def on_match(cls, message):
        with cls.changed:
            cls.matches.append(message)
            cls.changed.notify_all()

    def match(self, points, pose, seconds=None):
        """The verdict on one cloud."""
        stamp = rospy.Time.now() if seconds is None else rospy.Time.from_sec(seconds)
        self.points.publish(cloud(points, pose, stamp))
        with self.changed:
            self.assertTrue(self.changed.wait_for(
                lambda: any(m.header.stamp == stamp for m in self.matches), 20.0), 'no verdict came')
            return [m for m in self.matches if m.header.stamp == stamp][-1]

    def assert_at(self, match, pose):
        self.assertTrue(match.believed, match.reasons)
        self.assertLess(math.hypot(match.pose.position.x - pose[0], match.pose.position.y - pose[1]), 0.05)
        yaw = 2.0 * math.atan2(match.pose.orientation.z, match.pose.orientation.w)
        self.assertLess(abs(math.remainder(yaw - pose[2], 2 * math.pi)), 0.005)
        self.assertLess(abs(match.pose.position.z), 0.05)
        with self.changed:
            self.assertTrue(self.changed.wait_for(
                lambda: any(p.header.stamp == match.header.stamp for p in self.poses), 5.0))
            told = [p for p in self.poses if p.header.stamp == match.header.stamp][-1]
        self.assertEqual(told.header.frame_id, 'map')
        self.assertGreater(told.pose.covariance[0], 0.0)

    def test_1_searched_tracked_lost_and_found(self):
        scan = yard(2)
        align = rospy.ServiceProxy('ndt_localizer/align', std_srvs.srv.Trigger)
        answer = align()
        self.assertFalse(answer.success)
        self.assertIn('nothing is known of the place', answer.message)
        match = self.match(scan, (3.0, -4.0, 2.0))
        self.assertFalse(match.believed)
        self.assertIn('nothing is known of the place', match.reasons[0])

        click = geometry_msgs.msg.PoseWithCovarianceStamped()
        click.header.frame_id = 'map'
        click.pose.pose.orientation.w = 1.0  # 5 m away, and pointing elsewhere
        self.initial.publish(click)
        pose = (3.0, -4.0, 2.0)
        for _ in range(20):  # until the map is loaded
            rospy.sleep(0.3)
            match = self.match(scan, pose)
            if match.believed:
                break
        self.assert_at(match, pose)

        # Tracked, at 5 m/s in a bend, by the own motion alone.
        start = match.header.stamp.to_sec()
        for i in range(1, 8):
            pose = (3.0 + 0.5 * math.cos(2.0) * i, -4.0 + 0.5 * math.sin(2.0) * i, 2.0 + 0.02 * i)
            match = self.match(scan, pose, start + 0.1 * i)
            self.assert_at(match, pose)
        self.assertEqual(match.refused_in_a_row, 0)

        # Another place: not believed, nothing published.
        count = len(self.poses)
        rand = random.Random(5)
        rubbish = [(rand.uniform(-30, 30), rand.uniform(-30, 30), rand.uniform(0, 8)) for _ in range(20000)]
        for i in range(8, 11):
            match = self.match(rubbish, pose, start + 0.1 * i)
            self.assertFalse(match.believed)
            self.assertTrue(match.reasons)
        self.assertEqual(match.refused_in_a_row, 3)
        self.assertEqual(len(self.poses), count)

        # Odometry tells roughly where to go on.
        odometry = nav_msgs.msg.Odometry()
        odometry.header.frame_id, odometry.child_frame_id = 'map', 'base_link'
        odometry.header.stamp = rospy.Time.from_sec(start + 1.2)
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = pose[0] + 0.4, pose[1] - 0.3
        odometry.pose.pose.orientation.z, odometry.pose.pose.orientation.w = (math.sin(0.5 * pose[2] + 0.02),
                                                                              math.cos(0.5 * pose[2] + 0.02))
        self.odometry.publish(odometry)
        rospy.sleep(0.3)
        self.assert_at(self.match(scan, pose, start + 1.2), pose)
        self.assertTrue(align().success)
        self.assert_at(self.match(scan, pose, start + 1.3), pose)

    def test_2_bad_clouds_do_no_harm(self):
        count = len(self.matches)
        good = cloud(yard(3)[:100], (0, 0, 0), rospy.Time.now())
        bad = []
        for _ in range(5):
            bad.append(sensor_msgs.msg.PointCloud2(header=good.header, height=1, fields=good.fields, point_step=12))
        bad[1].width = 4000000000 % 2**32
        bad[1].row_step = 12
        bad[2].width, bad[2].row_step, bad[2].fields = 100, 1200, good.fields[:2]
        bad[3].width, bad[3].row_step, bad[3].data = 100, 1200, struct.pack('<300f', *([math.nan] * 300))
        bad[4].width, bad[4].row_step, bad[4].data = 1, 12, good.data[:12]
        bad[4].header.frame_id = 'nowhere'
        for message in bad:
            self.points.publish(message)
            rospy.sleep(0.2)
        self.assertEqual(len(self.matches), count, 'a cloud without points has no verdict')
        # It lives on.
        rospy.wait_for_service('ndt_localizer/align', 5.0)
        rospy.ServiceProxy('ndt_localizer/align', std_srvs.srv.Trigger)()


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'ndt_localizer_test', NdtLocalizerTest)
