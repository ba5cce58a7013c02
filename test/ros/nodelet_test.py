#!/usr/bin/env python3
"""What a nodelet does to the manager that it shares with others."""

import rospy
import rostest

import vehicle_messages
from node_support import NodeTest, wait_for


class Nodelet(NodeTest):
    def test_it_can_be_unloaded_and_loaded_again(self):
        self.drive()
        for _ in range(3):
            self.assertEqual(self.process.unload(), 0)
            self.assertTrue(self.process.manager_is_alive(), self.process.text())
            wait_for(lambda: not self.vehicle.connected(), 'end of the subscriptions')
            self.process.load()
            wait_for(self.vehicle.connected, 'subscriber of all inputs')
            self.maps.next_where(lambda head: head.code == 0, 'lanes')
        self.three_lanes()

    def test_bad_parameters_leave_the_manager_alive_and_can_be_mended(self):
        self.drive()
        self.process.unload()
        rospy.set_param('/relative_map/rate', 'fast')
        self.process.load()
        wait_for(lambda: self.process.exit_code() is not None, 'end of the load')
        self.assertNotEqual(self.process.exit_code(), 0)
        self.assertTrue(self.process.manager_is_alive(), self.process.text())
        self.assertIn("rate is 'fast', but must be a number", self.process.text())
        rospy.set_param('/relative_map/rate', 20.0)
        self.process.load()
        wait_for(self.vehicle.connected, 'subscriber of all inputs')
        self.vehicle.navigation.publish(vehicle_messages.three_lines())
        self.three_lanes()


if __name__ == '__main__':
    rospy.init_node('nodelet_test')
    rostest.rosrun('relative_map', 'nodelet', Nodelet)
