#!/usr/bin/env python3
"""What check_maps finds in a bag of maps, and its exit codes."""

import subprocess

import roslib.packages
import rosbag
import rostest
from relative_map.msg import MapMsg
from std_msgs.msg import String

from replay_support import START, ReplayTest


class CheckMaps(ReplayTest):
    def check(self, *words):
        """The exit code, and all that was printed."""
        run = subprocess.run([roslib.packages.find_node('relative_map', 'check_maps')[0]] + list(words),
                             cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        return run.returncode, run.stdout

    def expect(self, expected_code, *texts, words=('out.bag',)):
        code, text = self.check(*words)
        self.assertEqual(code, expected_code, text)
        for expected in texts:
            self.assertIn(expected, text)

    def write_maps(self, spoil):
        """The maps of a drive, every one of which `spoil` has had in its hands."""
        self.record()
        self.replay('in.bag', 'good.bag')
        with rosbag.Bag(self.path('good.bag')) as good, rosbag.Bag(self.path('out.bag'), 'w') as bag:
            for index, (topic, map, time) in enumerate(good.read_messages()):
                spoil(index, map)
                bag.write(topic, map, time)

    def test_good_maps(self):
        self.write_maps(lambda index, map: None)
        self.expect(0, '16 maps, 0 of them empty, 0 rows broken')

    def test_broken_maps(self):
        def spoil(index, map):
            if index in (3, 5):
                map.hdmap.lane[1].left_sample[10].width += 0.5
            if index == 7:
                map.navigation_path.pop()

        self.write_maps(spoil)
        code, text = self.check('out.bag')
        self.assertEqual(code, 1)
        rows = {line.split()[0]: line for line in text.splitlines()}
        self.assertEqual(rows['samples'].split()[1:3], ['2', '1700000000.337000'])
        self.assertEqual(rows['navigation_path'].split()[1:3], ['1', '1700000000.737000'])
        self.assertEqual(rows['header'].split()[1:3], ['0', '-'])
        self.assertIn("lane '", rows['samples'])

    def test_frame_and_topic(self):
        self.write_maps(lambda index, map: None)
        self.expect(1, "frame_id is 'base_link', not 'rear_axle'", words=('out.bag', '--frame', 'rear_axle'))
        self.expect(2, 'there is no map on /other', words=('out.bag', '--topic', '/other'))

    def test_lost_maps_are_told_and_no_fault(self):
        self.write_maps(lambda index, map: None)
        with rosbag.Bag(self.path('out.bag')) as whole, rosbag.Bag(self.path('part.bag'), 'w') as part:
            for index, (topic, map, time) in enumerate(whole.read_messages()):
                if index not in (4, 5, 9):
                    part.write(topic, map, time)
        self.expect(0, '13 maps, 0 of them empty, 0 rows broken; 3 maps were lost before they were recorded',
                    words=('part.bag',))

    def test_the_topic_need_not_be_named(self):
        self.write_maps(lambda index, map: None)
        for recorded in ('relative_map', '/car1/relative_map', 'car1/relative_map'):
            with rosbag.Bag(self.path('out.bag')) as whole, rosbag.Bag(self.path('other.bag'), 'w') as other:
                for _, map, time in whole.read_messages():
                    other.write(recorded, map, time)
            self.expect(0, '16 maps', words=('other.bag',))
            self.expect(0, '16 maps', words=('other.bag', '--topic', '/' + recorded.lstrip('/')))
            self.expect(0, '16 maps', words=('other.bag', '--topic', recorded.lstrip('/')))
        with rosbag.Bag(self.path('out.bag')) as whole, rosbag.Bag(self.path('two.bag'), 'w') as two:
            for _, map, time in whole.read_messages():
                two.write('/car1/relative_map', map, time)
                two.write('/car2/relative_map', map, time)
        self.expect(2, '--topic', '/car1/relative_map', '/car2/relative_map', words=('two.bag',))

    def test_what_cannot_be_checked(self):
        self.expect(2, 'check_maps: out.bag: not a readable bag: No such file or directory')
        self.write('out.bag', 'no bag')
        self.expect(2, 'check_maps: out.bag: not a readable bag: it was cut off, or is no bag')
        self.record('out.bag', [('/relative_map', String('no map'), START)])
        self.expect(2, 'std_msgs/String')
        self.record('out.bag', [('/relative_map', MapMsg(), START)])
        self.expect(1, "frame_id is ''", 'there is no lane, but the status is OK')
        self.expect(2, 'a bag must be named', words=())
        self.expect(2, '--frame needs a value', words=('out.bag', '--frame'))
        self.expect(2, 'unknown option --all', words=('out.bag', '--all'))


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'check_maps', CheckMaps)
