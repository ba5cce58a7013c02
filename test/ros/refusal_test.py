#!/usr/bin/env python3
"""A bad configuration keeps node and nodelet from starting, and all of its faults are told at once."""

import subprocess
import unittest

import rospy
import rostest
from nodelet.srv import NodeletList

FAULTS = {'rate': -1.0, 'no_such_key': 3, 'lane_fusion': {'method': 'guess'}}


class RefusalTest(unittest.TestCase):

    def refuse(self, name, command):
        """Runs the command, with faults in the parameters of its node; what it said."""
        rospy.set_param(name, FAULTS)
        done = subprocess.run(command + ['__name:=' + name], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=60, universal_newlines=True)
        self.assertNotEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def test_the_node_ends_and_names_all_faults(self):
        said = self.refuse('bad_node', ['rosrun', 'relative_map', 'relative_map_node'])
        for fault in ('rate', 'no_such_key', 'method'):
            self.assertIn(fault, said)

    def test_the_nodelet_is_not_loaded_and_its_manager_lives_on(self):
        self.refuse('bad_nodelet', ['rosrun', 'nodelet', 'nodelet', 'load', 'relative_map/RelativeMapNodelet', 'manager'])
        loaded = rospy.ServiceProxy('manager/list', NodeletList)()
        self.assertEqual(loaded.nodelets, [])

    def test_the_simulator_ends_without_lines(self):
        rospy.set_param('bad_simulator', {'navigation_lines': 'no_such_file.smoothed'})
        done = subprocess.run(['rosrun', 'relative_map', 'vehicle_simulator', '__name:=bad_simulator'],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, universal_newlines=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('no_such_file.smoothed', done.stdout)


if __name__ == '__main__':
    rospy.init_node('refusal_test')
    rostest.rosrun('relative_map', 'refusal_test', RefusalTest)
