#!/usr/bin/env python3
"""The parameters of a node or nodelet: what it refuses to start with, and what may change while it runs."""

import rospy
import rostest
from dynamic_reconfigure.client import Client

import vehicle_messages
from node_support import NodeTest, MapProcess, wait_for

NAN = float('nan')


class Parameters(NodeTest):
    def expect_refusal(self, parameters, *texts, arguments=()):
        self.addCleanup(self._forget_parameters)
        process = MapProcess(rospy.get_param('~kind') == 'nodelet', parameters, list(arguments))
        self.addCleanup(process.stop)
        wait_for(lambda: process.exit_code() is not None, 'end of a process with bad parameters')
        self.assertNotEqual(process.exit_code(), 0)
        process.stop()
        for text in texts:
            self.assertIn(text, process.text())

    def test_all_faults_are_named_and_nothing_starts(self):
        self.expect_refusal({'rate': 'fast', 'ratte': 20.0, 'map_param': {'default_left_width': -1.0},
                             'navigation_lane': {'lane_marker_weight': 2.0, 'lane_source': 'CAMERA'}},
                            "rate is 'fast', but must be a number", 'ratte is not a parameter of this node',
                            'map_param/default_left_width is -1', 'navigation_lane/lane_marker_weight is 2',
                            "navigation_lane/lane_source is 'CAMERA'")
        topics = [topic for topic, _ in rospy.get_published_topics()]
        self.assertNotIn('/relative_map', topics)

    def test_navigation_mode_off_is_refused(self):
        self.expect_refusal({'use_navigation_mode': False}, 'use_navigation_mode is false')

    def test_a_bad_urdf_is_refused(self):
        rospy.set_param('/robot_description', '<robot name="car"><link name="wheel"/></robot>')
        self.addCleanup(rospy.delete_param, '/robot_description')
        self.expect_refusal({}, "robot_description has no link 'base_link'")
        # One car of several may share it.
        self.expect_refusal({}, "robot_description has no link 'base_link'", arguments=['__ns:=/car'])

    def reconfigure_client(self):
        client = Client('relative_map/reconfigure', timeout=10)
        self.addCleanup(client.close)
        return client

    def test_reconfigure_is_applied_whole(self):
        self.drive(parameters={'map_param': {'default_speed_limit': 20.0}, 'lane_fusion': {'method': 'fixed_weight'}})
        self.vehicle.marker_offset = 0.4
        client = self.reconfigure_client()
        before = client.get_configuration(timeout=10)
        self.assertEqual((before['default_speed_limit'], before['lane_marker_weight']), (20.0, 0.1))
        after = client.update_configuration({'default_speed_limit': 13.0, 'lane_marker_weight': 0.5})
        self.assertEqual((after['default_speed_limit'], after['lane_marker_weight']), (13.0, 0.5))
        map = self.maps.newest_where(lambda map: abs(map.fusion.lateral_offset - 0.2) < 1e-3, 'the new weight')
        self.assertEqual([lane.speed_limit for lane in map.hdmap.lane], [13.0] * 3)

    def test_reconfigure_refuses_a_request_with_a_bad_value_as_a_whole(self):
        self.drive()
        client = self.reconfigure_client()
        before = client.update_configuration({})
        for bad in ({'lane_marker_weight': 5.0}, {'lane_marker_weight': -1.0}, {'lane_marker_weight': NAN},
                    {'min_lane_half_width': 3.0}, {'max_lane_half_width': 1.0}, {'default_left_width': 50.0},
                    {'default_speed_limit': 0.0}, {'default_speed_limit': 500.0}, {'min_lane_marker_quality': 2.0},
                    {'max_len_from_navigation_line': 1e6}, {'max_distance_to_navigation_line': 1e6}):
            request = dict({'default_right_width': 1.9}, **bad)
            answer = client.update_configuration(request)
            self.assertIn(next(iter(bad)), answer['refusal'])
            for config in (answer, before):  # in `groups`, all of it comes once more
                config.update(refusal='', groups=None)
            self.assertEqual(answer, before, bad)
        self.assertEqual(client.update_configuration({})['refusal'], '')
        first = len(self.maps.data)
        wait_for(lambda: len(self.maps.data) > first + 2, 'maps')
        for lane in self.maps.message(-1).hdmap.lane:
            self.assertAlmostEqual(lane.speed_limit, 29.06)
        self.assertAlmostEqual(lane.right_sample[-1].width, 1.75, delta=1e-2)
        self.assertIn('reconfigure is refused', self.process.text())

    def test_what_was_reconfigured_does_not_outlive_the_process(self):
        self.drive()
        self.reconfigure_client().update_configuration({'default_speed_limit': 13.0})
        self.maps.newest_where(lambda map: map.hdmap.lane[0].speed_limit == 13.0, 'the new limit')
        self.assertEqual(rospy.get_param('relative_map/reconfigure/default_speed_limit'), 13.0)
        self.process.stop()
        self.start_process()
        self.vehicle.navigation.publish(vehicle_messages.three_lines())
        self.maps.newest_where(lambda map: map.hdmap.lane and abs(map.hdmap.lane[0].speed_limit - 29.06) < 1e-9,
                               'the limit of the parameters')


if __name__ == '__main__':
    rospy.init_node('node_parameter_test')
    rostest.rosrun('relative_map', 'parameters', Parameters)
