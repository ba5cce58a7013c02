#!/usr/bin/env python3
"""What others see of a running relative_map: topics, stamps, rates, statuses, services and diagnostics."""

import math
import time
import unittest

import dynamic_reconfigure.client
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Path
from relative_map.msg import FusionState, MapMsg, MapStatus
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

import drive

PATIENCE = 15.0  # [s] for what comes at once on a machine that is not busy


class Maps:
    """All maps since the last `forget`."""

    def __init__(self):
        self.received = []
        self._subscriber = rospy.Subscriber('relative_map', MapMsg, lambda m: self.received.append(m), queue_size=100)

    def wait_for(self, condition, what):
        """The first map from now on that meets the condition."""
        self.received = []
        end = time.time() + PATIENCE
        seen = 0
        while time.time() < end:
            maps = self.received
            for message in maps[seen:]:
                if condition(message):
                    return message
            seen = len(maps)
            time.sleep(0.01)
        last = self.received[-1].status if self.received else 'no map at all'
        raise AssertionError('%s: not within %.0f s; the last status: %s' % (what, PATIENCE, last))

    def wait_for_status(self, code):
        return self.wait_for(lambda m: m.status.code == code, 'a map with the status %d' % code)


class InterfaceTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        rospy.init_node('interface_test')
        cls.maps = Maps()
        cls.drive = drive.Drive()
        rospy.wait_for_service('relative_map/reset', PATIENCE)
        cls.reset_service = rospy.ServiceProxy('relative_map/reset', Trigger)

    def setUp(self):
        self.drive.running = False
        self.assertTrue(self.reset_service().success)
        self.drive.set()
        self.drive.navigation.publish(drive.navigation())

    def start(self):
        self.drive.running = True
        return self.maps.wait_for_status(MapStatus.OK)

    def assert_empty(self, message):
        self.assertEqual(message.header.frame_id, 'base_link')
        self.assertFalse(message.hdmap.lane or message.hdmap.road or message.navigation_path)
        self.assertEqual(message.current_lane_id, '')
        self.assertNotEqual(message.status.code, MapStatus.OK)
        self.assertNotEqual(message.status.message, '')

    def test_without_localization_an_empty_map_says_so(self):
        before = rospy.Time.now()
        message = self.maps.wait_for_status(MapStatus.NO_LOCALIZATION)
        self.assert_empty(message)
        self.assertGreaterEqual(message.header.stamp, before)

    def test_lanes_are_where_the_lines_are(self):
        message = self.start()
        self.assertEqual(message.header.frame_id, 'base_link')
        self.assertEqual(len(message.hdmap.lane), 3)
        for lane, y in zip(message.hdmap.lane, (drive.SPACING, 0.0, -drive.SPACING)):
            points = [p for segment in lane.central_curve.segment for p in segment.line_segment.point]
            self.assertLess(max(abs(p.y - (y - 0.2)) for p in points), 1e-3)
            self.assertLessEqual(points[0].x, 0.0)
            self.assertGreater(points[-1].x, 240.0)
        ids = [lane.id for lane in message.hdmap.lane]
        self.assertEqual(len(set(ids)), 3)
        self.assertEqual(message.current_lane_id, ids[1])
        self.assertEqual(sorted(path.lane_id for path in message.navigation_path), sorted(ids))
        self.assertEqual([section.lane_id for section in message.hdmap.road[0].section], [ids])
        self.assertEqual(message.fusion.source, FusionState.NAVIGATION_LINE)

    def test_each_path_tells_its_priority_and_what_remains_of_its_line(self):
        message = self.start()
        paths = {path.lane_id: path for path in message.navigation_path}
        priorities = [paths[lane.id].navigation_path.path_priority for lane in message.hdmap.lane]
        self.assertEqual(priorities, [2, 0, 1])
        for path in message.navigation_path:
            self.assertAlmostEqual(path.remaining_distance, drive.LENGTH - 50.0, places=2)

    def test_sequence_numbers_rise_by_one_and_stamps_are_those_of_the_poses(self):
        self.start()
        self.maps.received = []
        time.sleep(2.0)
        maps = list(self.maps.received)
        self.assertGreater(len(maps), 10)
        for one, next_one in zip(maps, maps[1:]):
            self.assertEqual(next_one.sequence_num, one.sequence_num + 1)
            self.assertGreater(next_one.header.stamp, one.header.stamp)
        for message in maps:
            self.assertEqual(message.header.stamp, message.localization.header.stamp)

    def test_ten_maps_a_second(self):
        self.start()
        self.maps.received = []
        time.sleep(4.0)
        self.assertGreater(len(self.maps.received), 4.0 * 8.5)
        self.assertLess(len(self.maps.received), 4.0 * 11.5)

    def test_a_pose_of_another_link_is_carried_to_the_body_frame(self):
        self.drive.set(s=50.0 + drive.IMU_X, link='imu_link')
        message = self.start()
        self.assertEqual(message.header.frame_id, 'base_link')
        self.assertAlmostEqual(message.navigation_path[0].remaining_distance, drive.LENGTH - 50.0, places=2)

    def test_a_link_without_transform_gives_no_map(self):
        self.drive.set(link='no_such_link')
        self.drive.running = True
        message = self.maps.wait_for_status(MapStatus.NO_TRANSFORM)
        self.assert_empty(message)
        self.assertIn('no_such_link', message.status.message)

    def test_other_map_frames_are_not_mixed(self):
        self.drive.set(frame='other_map')
        self.drive.running = True
        self.assert_empty(self.maps.wait_for_status(MapStatus.FRAME_MISMATCH))

    def test_localization_that_stops_is_noticed_and_found_again(self):
        self.start()
        self.drive.running = False
        self.assert_empty(self.maps.wait_for_status(MapStatus.STALE_LOCALIZATION))
        self.start()

    def test_localization_that_is_not_a_number_is_refused(self):
        self.drive.set(position=(drive.NAN, 0.0))
        self.drive.running = True
        self.assert_empty(self.maps.wait_for_status(MapStatus.INVALID_LOCALIZATION))
        self.drive.set()
        self.maps.wait_for_status(MapStatus.OK)

    def test_off_the_route_and_back(self):
        self.drive.set(l=80.0)
        self.drive.running = True
        self.assert_empty(self.maps.wait_for_status(MapStatus.OFF_ROUTE))
        self.drive.set()
        self.maps.wait_for_status(MapStatus.OK)

    def test_new_lines_take_the_place_of_all_old_ones(self):
        self.start()
        message = drive.navigation()
        message.navigation_path = message.navigation_path[:1]
        self.drive.navigation.publish(message)
        self.maps.wait_for(lambda m: len(m.hdmap.lane) == 1, 'a map with the one new line')

    def test_markers_and_centerline_are_drawn_in_the_body_frame(self):
        self.start()
        markers = rospy.wait_for_message('relative_map/markers', MarkerArray, PATIENCE)
        self.assertEqual({m.header.frame_id for m in markers.markers if m.action == m.ADD}, {'base_link'})
        path = rospy.wait_for_message('relative_map/centerline', Path, PATIENCE)
        self.assertEqual(path.header.frame_id, 'base_link')
        self.assertLess(max(abs(pose.pose.position.y + 0.2) for pose in path.poses), 1e-3)

    def wait_for_diagnostics(self, level):
        end = time.time() + PATIENCE
        while time.time() < end:
            for status in rospy.wait_for_message('/diagnostics', DiagnosticArray, PATIENCE).status:
                if 'relative_map' in status.name and status.level == level:
                    return status
        raise AssertionError('no diagnostics of relative_map with the level %d' % level)

    def test_diagnostics_follow_the_map(self):
        self.start()
        self.assertIn('3 lanes', self.wait_for_diagnostics(DiagnosticStatus.OK).message)
        self.drive.running = False
        self.assertIn('STALE_LOCALIZATION', self.wait_for_diagnostics(DiagnosticStatus.ERROR).message)

    def test_reconfigure_is_applied_whole_or_not_at_all(self):
        client = dynamic_reconfigure.client.Client('relative_map/reconfigure', timeout=PATIENCE)
        old = client.get_configuration()
        try:
            client.update_configuration({'default_speed_limit': 13.5})
            self.start()
            self.maps.wait_for(lambda m: m.hdmap.lane and math.isclose(m.hdmap.lane[0].speed_limit, 13.5),
                               'the new speed limit')
            answer = client.update_configuration({'default_speed_limit': 20.0, 'lane_marker_weight': -1.0})
            self.assertEqual(answer['default_speed_limit'], 13.5)
            time.sleep(0.5)
            message = self.maps.wait_for_status(MapStatus.OK)
            self.assertEqual(message.hdmap.lane[0].speed_limit, 13.5)
        finally:
            client.update_configuration({'default_speed_limit': old['default_speed_limit']})


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'interface_test', InterfaceTest)
