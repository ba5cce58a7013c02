#!/usr/bin/env python3
"""What map_monitor prints, and its exit code."""

import os
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
from relative_map.msg import Lane, LaneNavigationPath, MapMsg, MapStatus

from node_support import DEADLINE, program, wait_for


def empty_map(number, frame='base_link'):
    map = MapMsg(sequence_num=number, status=MapStatus(MapStatus.OFF_ROUTE, 'far away'))
    map.header.stamp = rospy.Time.now()
    map.header.frame_id = frame
    map.fusion.marker_age = -1.0
    return map


class Monitor(unittest.TestCase):
    def setUp(self):
        self.maps = rospy.Publisher('relative_map', MapMsg, queue_size=10)
        self.addCleanup(self.maps.unregister)
        self.output = tempfile.NamedTemporaryFile()
        self.process = subprocess.Popen([program('relative_map', 'map_monitor')], stdout=self.output)
        self.addCleanup(self.process.kill)
        wait_for(self.maps.get_num_connections, 'subscriber of the maps')

    def text(self):
        with open(self.output.name) as output:
            return output.read()

    def wait_for_text(self, text):
        wait_for(lambda: text in self.text(), text)

    def exit_code(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(DEADLINE)

    def test_says_that_there_is_no_map(self):
        self.wait_for_text('no map in the last second\n')
        self.assertEqual(self.exit_code(), 2)
        self.assertIn('0 maps, 0 of them empty, 0 contract violations', self.text())
        self.assertIn('no map ever came on /relative_map', self.text())

    def test_says_why_a_map_is_empty(self):
        self.maps.publish(empty_map(1))
        self.wait_for_text('0 lanes | OFF_ROUTE: far away\n')
        self.assertEqual(self.exit_code(), 0)
        self.assertIn('1 maps, 1 of them empty, 0 contract violations', self.text())

    def test_tells_a_lost_map_from_a_fault(self):
        for number in (1, 2, 4, 5, 9):
            self.maps.publish(empty_map(number))
        wait_for(lambda: '0 lanes' in self.text(), 'line')
        self.assertEqual(self.exit_code(), 0)
        self.assertIn('0 contract violations, 4 lost on the way', self.text())

    def test_finds_a_number_that_goes_back(self):
        for number in (7, 8, 8, 3):
            self.maps.publish(empty_map(number))
        self.wait_for_text('CONTRACT VIOLATION, header: sequence_num is 8 after 8\n')
        self.wait_for_text('CONTRACT VIOLATION, header: sequence_num is 3 after 8\n')
        self.assertEqual(self.exit_code(), 1)

    def test_ends_when_interrupted_without_a_master(self):
        environment = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:1')
        for sent in (signal.SIGINT, signal.SIGTERM):
            waiting = subprocess.Popen([program('relative_map', 'map_monitor')], stderr=subprocess.PIPE, env=environment,
                                       universal_newlines=True)
            self.addCleanup(waiting.kill)
            self.assertIn('waiting for a master', waiting.stderr.readline())
            waiting.send_signal(sent)
            self.assertNotEqual(waiting.wait(DEADLINE), 0)

    def test_finds_maps_in_another_frame(self):
        for number in range(5):
            self.maps.publish(empty_map(number, 'map'))
        self.wait_for_text("CONTRACT VIOLATION, header: frame_id is 'map'")
        self.assertEqual(self.exit_code(), 1)
        self.assertEqual(self.text().count('CONTRACT VIOLATION'), 3)  # and no more: there may be thousands
        self.assertIn('header: 5', self.text())

    def test_explains_itself_without_a_master(self):
        for name in ('map_monitor', 'vehicle_simulator'):
            run = subprocess.run([program('relative_map', name), '--help'], stdout=subprocess.PIPE, timeout=DEADLINE,
                                 env=dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:1'), universal_newlines=True)
            self.assertEqual(run.returncode, 0)
            self.assertIn('Usage: rosrun relative_map ' + name, run.stdout)

    def test_survives_a_map_of_scraps(self):
        map = empty_map(1)
        map.status.code = MapStatus.OK
        map.hdmap.lane = [Lane(id='a'), Lane()]
        map.navigation_path = [LaneNavigationPath(lane_id='a')]
        map.current_lane_id = 'a'
        self.maps.publish(map)
        self.wait_for_text('2 lanes | 0 points | NONE')
        self.assertEqual(self.exit_code(), 1)


if __name__ == '__main__':
    rospy.init_node('map_monitor_test')
    rostest.rosrun('relative_map', 'map_monitor', Monitor)
