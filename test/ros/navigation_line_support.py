"""What the tests of `navigation_line` share: bags of a drive, files, and runs of the tool on them."""

import json
import math
import os
import shutil
import subprocess
import tempfile
import unittest

import roslib.packages
import rosbag
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import NavSatFix

import vehicle_messages

START = rospy.Time(1700000000)
RATE = 20  # [Hz] of poses
X, Y = 690000.0, 3118000.0  # where the drive starts, as in a UTM zone


def way(step):
    """A quarter of a circle of 100 m radius at 10 m/s."""
    angle = 10.0 * step / RATE / 100.0
    return X + 100.0 * math.sin(angle), Y + 100.0 * (1.0 - math.cos(angle))


def odometry(stamp, x, y):
    message = Odometry()
    message.header.stamp, message.header.frame_id = stamp, 'map'
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    return message


def pose_stamped(stamp, x, y):
    message = PoseStamped()
    message.header.stamp, message.header.frame_id = stamp, 'map'
    message.pose.position.x, message.pose.position.y = x, y
    return message


def localization(stamp, x, y):
    return vehicle_messages.localization(stamp, x, y)


def fix(stamp, latitude, longitude, status=0):
    message = NavSatFix(latitude=latitude, longitude=longitude, altitude=100.0)
    message.header.stamp = stamp
    message.status.status = status
    return message


def drive(topic, make, count=300):
    """Poses as (topic, message, time)."""
    for step in range(count):
        stamp = START + rospy.Duration(step / RATE)
        yield topic, make(stamp, *way(step)), stamp


def fixes(latitude=48.1, longitude=11.5, count=300):
    """An eastward drive of 150 m, beginning at a place."""
    for step in range(count):
        stamp = START + rospy.Duration(step / RATE)
        yield '/fix', fix(stamp, latitude, longitude + 6.7e-6 * step), stamp


def smoothed(points):
    return ''.join('{"x": %.6f, "y": %.6f}\n' % point for point in points)


def straight(length, y=0.0, start=0.0):
    return [(start + 0.5 * i, y) for i in range(int(2 * length) + 1)]


class ToolTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), 'w') as file:
            file.write(text)
        return name

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def record(self, name, entries):
        with rosbag.Bag(self.path(name), 'w') as bag:
            for topic, message, stamp in entries:
                bag.write(topic, message, stamp)
        return name

    @staticmethod
    def tool():
        return roslib.packages.find_node('relative_map', 'navigation_line')[0]

    def command(self, *words):
        return [self.tool()] + list(words)

    def run_tool(self, *words, master=False, **options):
        environment = dict(os.environ) if master else dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:1')
        options = dict({'env': environment}, **options)
        return subprocess.run(self.command(*words), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=60, **options)

    def points(self, name='line.smoothed'):
        objects = [json.loads(line) for line in self.read(name).splitlines()]
        return [entry for entry in objects if 'x' in entry]

    def expect(self, *words):
        """A run that must succeed; what it prints."""
        run = self.run_tool(*words)
        self.assertEqual(run.returncode, 0, run.stderr + run.stdout)
        return run.stdout

    def contents(self):
        found = {}
        for name in os.listdir(self.folder):
            if os.path.isfile(self.path(name)):
                with open(self.path(name), 'rb') as file:
                    found[name] = file.read()
        return found

    def expect_fault(self, *words, says=(), code=1, **options):
        """A run that fails with one line that has all these texts, and leaves all files as they were."""
        before = self.contents()
        run = self.run_tool(*words, **options)
        self.assertEqual(run.returncode, code, run.stderr + run.stdout)
        self.assertEqual(run.stdout, '')
        self.assertEqual(run.stderr.count('\n'), 1, run.stderr)
        for text in ('navigation_line: ',) + tuple(says):
            self.assertIn(text, run.stderr)
        self.assertEqual(self.contents(), before)
