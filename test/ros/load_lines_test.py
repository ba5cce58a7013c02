#!/usr/bin/env python3
"""Lines that a node or nodelet reads from files by itself: its parameter, and its service."""

import os
import shutil
import tempfile
import time

import rospy
import rostest
from relative_map.srv import LoadNavigationLines

from node_support import NodeTest, MapProcess, wait_for


class LoadLines(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def line(self, name, y, header=''):
        path = os.path.join(self.folder, name + '.smoothed')
        with open(path, 'w') as file:
            file.write(header)
            for x in range(1500):
                file.write('{"x": %d, "y": %f}\n' % (x, y))
        return path

    def three_files(self):
        return [self.line('middle', 0.0), self.line('left', 3.5), self.line('right', -3.5)]

    def load(self, files, frame_id=''):
        rospy.wait_for_service('/relative_map/load_navigation_lines', 20.0)
        return rospy.ServiceProxy('/relative_map/load_navigation_lines', LoadNavigationLines)(files, frame_id)

    def expect_refusal(self, files, *texts, frame_id=''):
        answer = self.load(files, frame_id)
        self.assertFalse(answer.success)
        self.assertEqual(answer.lines, [])
        for text in ('nothing was loaded: ',) + texts:
            self.assertIn(text, answer.message)

    def test_the_parameter_loads_files_at_the_start(self):
        self.start(parameters={'navigation_lines': self.three_files()})
        self.vehicle.start()
        map = self.three_lanes()
        self.assertEqual(map.current_lane_id, 'middle')
        self.expect_contract()

    def test_the_service_answers_with_what_was_loaded(self):
        self.start()
        self.vehicle.start()
        answer = self.load(self.three_files())
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.message, "3 lines loaded in frame 'map'")
        self.assertEqual(answer.lines[1], 'left: priority 1, 1500 points, 1499.0 m')
        self.three_lanes()

    def test_the_service_says_why_not_and_keeps_what_there_was(self):
        self.drive()
        good = self.line('good', 0.0)
        utm = '{"header": {"projection": "utm", "zone": %d, "north": true}}\n'
        self.expect_refusal([], 'no files are named')
        self.expect_refusal([good, '/absent.smoothed'], '/absent.smoothed: cannot be opened')
        self.expect_refusal([self.line('odom', 0.0, '{"header": {"frame_id": "odom"}}\n')],
                            "the lines are in frame 'odom', but localization is in 'map'")
        self.expect_refusal([good], "in frame 'odom'", frame_id='odom')
        self.expect_refusal([self.line('a', 0.0, utm % 50), self.line('b', 0.0, utm % 51)],
                            'b.smoothed: does not fit', 'UTM zone 50N', 'UTM zone 51N')
        broken = self.line('broken', 0.0)
        with open(broken, 'a') as file:
            file.write('{"x": 1')
        self.expect_refusal([broken], 'broken.smoothed, line 1501: not valid JSON')
        short = os.path.join(self.folder, 'short.smoothed')
        with open(short, 'w') as file:
            file.write('{"x": 1, "y": 2}\n')
        self.expect_refusal([short], 'fewer than two distinct points')
        self.three_lanes()

    def test_a_pipe_a_device_and_a_relative_path_hold_nothing_up(self):
        self.drive()
        good = self.line('good', 0.0)
        pipe = os.path.join(self.folder, 'pipe.smoothed')
        os.mkfifo(pipe)
        start = time.monotonic()
        for place in (pipe, '/dev/zero', '/dev/tty'):
            self.expect_refusal([good, place], place)
        self.expect_refusal(['good.smoothed'], "'good.smoothed' must be an absolute path")
        with open(os.path.join(self.folder, 'huge.csv'), 'w') as file:
            file.truncate(1 << 40)
        self.expect_refusal([file.name], 'is larger than')
        self.assertLess(time.monotonic() - start, 10.0)  # for ever, and all of the memory, before
        self.assertTrue(self.load([good]).success)

    def test_what_was_left_out_of_a_file_is_told(self):
        path = os.path.join(self.folder, 'line.csv')
        with open(path, 'w') as file:
            file.write('time,x,y\n' + ''.join('0,%d,0\n' % x for x in range(1500)))
        self.start()
        answer = self.load([path])
        self.assertTrue(answer.success, answer.message)
        self.assertIn('line.csv: these columns are left out: time', answer.message)

    def test_the_service_keeps_to_its_folder(self):
        inside = os.path.join(self.folder, 'lines')
        os.mkdir(inside)
        outside = self.line('outside', 0.0)
        good = self.line('lines/good', 0.0)
        os.symlink(outside, os.path.join(inside, 'link.smoothed'))
        self.start(parameters={'navigation_lines_folder': inside})
        self.assertTrue(self.load([good]).success)
        for path in (outside, inside + '/../outside.smoothed', inside + '/link.smoothed', '/etc/passwd', '/absent'):
            self.expect_refusal([path], "'%s' does not lie in %s" % (path, inside))

    def test_a_bad_file_in_the_parameter_keeps_it_from_starting(self):
        self.addCleanup(self._forget_parameters)
        for value, text in ((['/absent.smoothed'], '/absent.smoothed: cannot be opened'), ([3], 'must be a list of files')):
            process = MapProcess(rospy.get_param('~kind') == 'nodelet', {'navigation_lines': value}, [])
            self.addCleanup(process.stop)
            wait_for(lambda: process.exit_code() is not None, 'end of a process with a bad file')
            self.assertNotEqual(process.exit_code(), 0)
            process.stop()
            self.assertIn(text, process.text())
            self._forget_parameters()


if __name__ == '__main__':
    rospy.init_node('load_lines_test')
    rostest.rosrun('relative_map', 'load_lines', LoadLines)
