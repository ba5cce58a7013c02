"""What the replay tests share: bags of a drive on a straight road, and runs of `replay` on them."""

import os
import shutil
import subprocess
import tempfile
import unittest

import roslib.packages
import rosbag
import rospy
from relative_map.msg import MapMsg
from tf2_msgs.msg import TFMessage

import vehicle_messages as messages
from map_head import MapHead

START = rospy.Time(1700000000, 37000000)  # on no round number
TICKS = 16  # at 10 Hz
CAMERA = messages.static_transform('camera_link', 1.8, 1.3)


def drive(marker_frame='base_link'):
    """All messages of a drive, as (topic, message, time)."""
    yield '/navigation', messages.three_lines(400), START
    for step in range(10 * (TICKS - 1) + 1):
        stamp = START + rospy.Duration(0, 10000000) * step
        yield '/localization', messages.localization(stamp, 20.0 + 0.1 * step), stamp
        if step % 2 == 0:
            yield '/chassis', messages.chassis(stamp), stamp
        if step % 7 == 0:
            yield '/perception/lane_markers', messages.lane_markers(stamp, 0.2, marker_frame), stamp


def write_bag(path, entries, **options):
    with rosbag.Bag(path, 'w', **options) as bag:
        for topic, message, stamp in entries:
            bag.write(topic, message, stamp)


def tick_times(count=TICKS, rate=10):
    return [START + rospy.Duration(0, 1000000000 // rate) * tick for tick in range(count)]


def replay_tool():
    return roslib.packages.find_node('relative_map', 'replay')[0]


class Run:
    """A finished run of replay, without a master to ask."""

    def __init__(self, words, folder, **options):
        options = dict({'env': dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:1')}, **options)
        finished = subprocess.run([replay_tool()] + words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  universal_newlines=True, timeout=60, **options)
        self.code, self.output, self.errors = finished.returncode, finished.stdout, finished.stderr


class ReplayTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    tool = staticmethod(replay_tool)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), 'w') as file:
            file.write(text)

    def record(self, name='in.bag', entries=None, **options):
        write_bag(self.path(name), drive() if entries is None else entries, **options)

    def replay(self, *words):
        """A run that must succeed."""
        run = Run(list(words) or ['in.bag', 'out.bag'], self.folder)
        self.assertEqual(run.code, 0, run.errors)
        return run

    def maps(self, name='out.bag'):
        """The heads of all messages of a bag, which must be maps, by their times."""
        with rosbag.Bag(self.path(name)) as bag:
            entries = list(bag.read_messages(raw=True))
        self.assertEqual({(entry.topic, entry.message[0]) for entry in entries}, {('/relative_map', MapMsg._type)})
        maps = {entry.timestamp: MapHead(entry.message[1]) for entry in entries}
        self.assertEqual(len(maps), len(entries))
        return maps

    def expect_contract(self, name='out.bag'):
        check = subprocess.run([roslib.packages.find_node('relative_map', 'check_maps')[0], self.path(name)],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(check.returncode, 0, check.stdout)


def transforms(*all_transforms):
    return '/tf_static', TFMessage(list(all_transforms)), START + rospy.Duration(1)
