#!/usr/bin/env python3
"""Maps that were recorded before a field was added come up to this version by the package's own rules, without a master."""

import math
import os
import re
import shutil
import tempfile
import unittest

import genpy.dynamic
import rosbag
import rosbag.migration
import rospkg
import rospy
import rostest
from relative_map.msg import MapMsg

FIELD = re.compile(r'float64 vehicle_s.*\n(\s+#.*\n)*')


class Migration(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.old, self.new = (os.path.join(self.folder, name) for name in ('old.bag', 'new.bag'))

    def record_old(self):
        definition = FIELD.sub('', MapMsg._full_text)
        self.assertNotEqual(definition, MapMsg._full_text)
        classes = genpy.dynamic.generate_dynamic('relative_map/MapMsg', definition)
        old_map = classes['relative_map/MapMsg'](sequence_num=7, current_lane_id='a')
        path = classes['relative_map/LaneNavigationPath'](lane_id='a', remaining_distance=42.0)
        angle = 0.3  # the vehicle is 5 m along a straight lane, and 1 m to its left
        for s in range(0, 50, 2):
            x, y = s - 5.0, -1.0
            path.navigation_path.path.path_point.append(classes['relative_map/PathPoint'](
                x=x * math.cos(angle) - y * math.sin(angle), y=x * math.sin(angle) + y * math.cos(angle), s=float(s)))
        old_map.navigation_path = [path]
        with rosbag.Bag(self.old, 'w') as bag:
            bag.write('/relative_map', old_map, rospy.Time(10))

    def test_maps_of_before_vehicle_s(self):
        self.record_old()
        rules = os.path.join(rospkg.RosPack().get_path('relative_map'), 'migration', 'maps.bmr')
        migrator = rosbag.migration.MessageMigrator([rules], plugins=False)
        self.assertEqual(rosbag.migration.fixbag2(migrator, self.old, self.new), [])
        with rosbag.Bag(self.new) as bag:
            (_, message, time), = bag.read_messages()
        self.assertEqual((message._type, message._md5sum), (MapMsg._type, MapMsg._md5sum))
        self.assertEqual((time, message.sequence_num, message.current_lane_id), (rospy.Time(10), 7, 'a'))
        path, = message.navigation_path
        self.assertEqual((path.lane_id, path.remaining_distance, len(path.navigation_path.path.path_point)),
                         ('a', 42.0, 25))
        self.assertAlmostEqual(path.vehicle_s, 5.0, 9)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'migration', Migration)
