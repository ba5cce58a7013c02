#!/usr/bin/env python3
"""What plot_maps draws of a bag of maps, and what it says of bags that it can't draw."""

import math
import os
import subprocess

import numpy
import roslib.packages
import rosbag
import rospy
import rostest
from matplotlib import image
from relative_map import bags
from relative_map.msg import FusionState, MapMsg, MapStatus
from std_msgs.msg import String

import vehicle_messages
from replay_support import START, ReplayTest

PICTURES = ('bird_view.png', 'curves.png', 'frames.png')
# On white: lanes of priority 0 and 1, a curve, and where there was no map.
CURRENT_LANE, OTHER_LANE, LINE, SHADE = (102, 170, 209), (199, 234, 224), (0, 114, 178), (247, 226, 209)


class PlotMaps(ReplayTest):
    def plot(self, *words, **options):
        """The exit code, and all that was printed."""
        run = subprocess.run([roslib.packages.find_node('relative_map', 'plot_maps')[0]] + list(words), cwd=self.folder,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, **options)
        return run.returncode, run.stdout

    def expect_sentence(self, *texts, words=('maps.bag', '--out', 'pictures')):
        """One sentence, an exit code, and no picture."""
        code, text = self.plot(*words)
        self.assertEqual(code, 1, text)
        self.assertEqual(len(text.splitlines()), 1, text)
        for expected in ('plot_maps: ',) + texts:
            self.assertIn(expected, text)
        for picture in PICTURES:
            self.assertFalse(os.path.exists(self.path('pictures/' + picture)))

    def expect_pictures(self, *texts, words=(), pictures=PICTURES):
        code, text = self.plot('maps.bag', '--out', 'pictures', *words)
        self.assertEqual(code, 0, text)
        for expected in texts:
            self.assertIn(expected, text)
        self.assertEqual(sorted(os.listdir(self.path('pictures'))), sorted(pictures))
        return text

    def count(self, picture, color):
        """The number of pixels of a colour."""
        pixels = 255 * image.imread(self.path('pictures/' + picture))[:, :, :3]
        return int((abs(pixels - color).max(axis=2) < 2.5).sum())

    def write_maps(self, spoil=lambda index, map: None, name='maps.bag', topic='/relative_map'):
        """The maps of a drive, every one of which `spoil` has had in its hands."""
        self.record()
        self.replay('in.bag', 'good.bag')
        with rosbag.Bag(self.path('good.bag')) as good, rosbag.Bag(self.path(name), 'w') as bag:
            for index, (_, map, time) in enumerate(good.read_messages()):
                spoil(index, map)
                bag.write(topic, map, time)

    def test_a_drive(self):
        self.write_maps()
        self.expect_pictures('16 maps in 1.5 s, 0 of them empty')
        for picture in ('bird_view.png', 'frames.png'):
            self.assertGreater(self.count(picture, CURRENT_LANE), 2000, picture)
            self.assertGreater(self.count(picture, OTHER_LANE), 2000, picture)
        self.assertGreater(self.count('curves.png', LINE), 500)
        self.assertLess(self.count('curves.png', SHADE), 100)

    def test_lanes_of_a_curve_have_no_gaps(self):
        """Their boundaries go on where those of the stretch before end, outside and inside."""
        def at(radius, way):
            return radius * math.sin(way / 30.0), 30.0 - radius * math.cos(way / 30.0)

        lines = [vehicle_messages.navigation_path(name, priority, [at(radius, 0.5 * i) for i in range(300)])
                 for priority, (name, radius) in enumerate((('middle', 30.0), ('left', 26.5), ('right', 33.5)))]
        entries = [('/navigation', vehicle_messages.navigation(*lines), START)]
        for step in range(80):
            stamp = START + rospy.Duration(0, 100000000) * step
            localization = vehicle_messages.localization(stamp, *at(30.0, 10.0 + step))
            localization.pose.heading = (10.0 + step) / 30.0
            localization.pose.orientation.w = 0.0
            entries.append(('/localization', localization, stamp))
        self.record(entries=entries)
        self.replay('in.bag', 'maps.bag')
        with bags.open_bag(self.path('maps.bag')) as bag:
            drive = bags.read_drive(bag, 'maps.bag', '/relative_map', 'flu', lambda share: None)
        self.assertGreater(len(drive.stretches), 6)
        for before, after in zip(drive.stretches, drive.stretches[1:]):
            self.assertEqual(len(before), 3)
            for old, new in zip(before, after):
                for end, start in ((old.left, new.left), (old.right, new.right)):
                    forward = (start[1] - start[0]) / numpy.hypot(*(start[1] - start[0]))
                    overlap = float((end[-1] - start[0]) @ forward)
                    self.assertGreater(overlap, 0.1)
                    self.assertLess(overlap, 0.7)

    def test_other_topic_frames_and_format(self):
        self.write_maps(topic='/other/map')
        self.expect_sentence('there is no map on /relative_map', '/other/map (--topic)')
        self.expect_pictures(words=('--topic', '/other/map', '--frames', '1', '--format', 'svg'),
                             pictures=[picture[:-3] + 'svg' for picture in PICTURES])

    def test_empty_maps_are_told(self):
        def spoil(index, map):
            if 4 <= index < 9:
                map.hdmap.lane, map.navigation_path, map.current_lane_id = [], [], ''
                map.fusion = FusionState(marker_age=-1.0)
                map.status = MapStatus(code=MapStatus.OFF_ROUTE, message='no navigation line is in reach')

        self.write_maps(spoil)
        self.expect_pictures('16 maps in 1.5 s, 5 of them empty; OFF_ROUTE: 5')
        self.assertGreater(self.count('curves.png', SHADE), 10000)

    def test_maps_without_a_pose_or_a_lane(self):
        map = MapMsg()
        map.header.frame_id = 'base_link'
        map.status.code = MapStatus.NO_LOCALIZATION
        self.record('maps.bag', [('/relative_map', map, START + rospy.Duration(k)) for k in range(3)])
        self.expect_pictures("no bird's view", 'no single maps', 'NO_LOCALIZATION: 3', pictures=('curves.png',))

    def test_numbers_that_are_none(self):
        def spoil(index, map):
            if index in (2, 3):
                map.localization.pose.position.x = math.nan
            if index == 5:
                map.localization.pose.heading = math.inf
                map.localization.pose.orientation.w = 0.0
            if index == 7:
                map.hdmap.lane[1].central_curve.segment[0].line_segment.point[3].y = math.nan
                map.fusion.lateral_offset = math.nan
            if index == 8:
                map.hdmap.lane[1].left_boundary.curve.segment = []

        self.write_maps(spoil)
        self.expect_pictures('0 of them empty')

    def test_bags_that_are_none(self):
        self.expect_sentence('maps.bag: No such file')
        self.write('maps.bag', '')
        self.expect_sentence('maps.bag: not a readable bag')
        self.write('maps.bag', 'no bag')
        self.expect_sentence('maps.bag: not a readable bag')
        self.record('maps.bag', [])
        self.expect_sentence('there is no map on /relative_map')
        self.record('maps.bag', [('/relative_map', String('no map'), START)])
        self.expect_sentence('/relative_map has type std_msgs/String')

    def test_truncated_bags(self):
        self.write_maps()
        with open(self.path('maps.bag'), 'rb') as whole:
            data = whole.read()
        for share in (0.02, 0.5, 0.999):
            with open(self.path('maps.bag'), 'wb') as cut:
                cut.write(data[:int(share * len(data))])
            self.expect_sentence('maps.bag: ')

    def test_damaged_maps(self):
        self.write_maps()
        with open(self.path('maps.bag'), 'r+b') as bag:
            data = bag.read()
            bag.seek(data.index(b'base_link', len(data) // 2) - 4)
            bag.write(b'\xff\xff\xff\xff')  # the length of a text
        code, text = self.plot('maps.bag', '--out', 'pictures')
        self.assertEqual(code, 1, text)
        self.assertIn('plot_maps: maps.bag: it is damaged after', text.splitlines()[-1])  # the first word is genpy's

    def test_folders_that_cannot_be_written(self):
        self.write_maps()
        self.write('file', '')
        for folder in ('file', 'file/pictures', '/proc/pictures', '/dev/full'):
            self.expect_sentence("pictures can't be written there", words=('maps.bag', '--out', folder))

    def test_what_was_there_stays_if_the_disk_is_full(self):
        self.write_maps()
        os.mkdir(self.path('pictures'))
        self.write('pictures/curves.png', 'of another drive')
        # A limit on the size of files stands in for a full disk.
        code, text = self.plot('maps.bag', '--out', 'pictures', preexec_fn=limit_files)
        self.assertEqual(code, 1, text)
        self.assertIn('File too large', text.splitlines()[-1])
        self.assertEqual(os.listdir(self.path('pictures')), ['curves.png'])
        with open(self.path('pictures/curves.png')) as old:
            self.assertEqual(old.read(), 'of another drive')

    def test_arguments(self):
        for words, text in ((('maps.bag',), '--out'), (('--out', 'pictures'), 'BAG'),
                            (('maps.bag', '--out', 'pictures', '--frames', '0'), '--frames must lie in [1, 20]'),
                            (('maps.bag', '--out', 'pictures', '--all'), '--all')):
            code, output = self.plot(*words)
            self.assertEqual(code, 2, output)
            self.assertIn(text, output.splitlines()[-1])
        self.assertEqual(self.plot('--help')[0], 0)


def limit_files():
    import resource
    import signal
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'plot_maps', PlotMaps)
