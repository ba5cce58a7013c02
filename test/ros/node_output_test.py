#!/usr/bin/env python3
"""What a running node or nodelet publishes and serves."""

import time

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Path
from relative_map.msg import FusionState, LaneMarkers, MapStatus
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

import vehicle_messages
from node_support import NodeTest, Latest, MapLog, wait_for


class Outputs(NodeTest):
    def latest(self, topic, message_type):
        log = Latest(topic, message_type)
        self.addCleanup(log.subscriber.unregister)
        return log

    def test_a_map_tells_of_three_lanes(self):
        self.drive()
        map = self.maps.newest_where(lambda map: map.fusion.source == FusionState.FUSED, 'fused lanes')
        self.assertEqual((map.status.code, map.header.frame_id), (MapStatus.OK, 'base_link'))
        self.assertIn(map.header.stamp, self.vehicle.stamps)
        self.assertEqual(map.localization.header.stamp, map.header.stamp)
        paths = [path.navigation_path for path in map.navigation_path]
        self.assertEqual([path.path.name for path in paths], ['left', 'middle', 'right'])
        self.assertEqual([path.path_priority for path in paths], [2, 0, 1])
        self.assertEqual(map.current_lane_id, map.navigation_path[1].lane_id)
        ids = [lane.id for lane in map.hdmap.lane]
        self.assertEqual(map.hdmap.lane[1].left_neighbor_forward_lane_id, ids[:1])
        self.assertEqual(map.hdmap.lane[1].right_neighbor_forward_lane_id, ids[2:])
        self.assertEqual([road.section[0].lane_id for road in map.hdmap.road], [ids])
        for lane, y in zip(map.hdmap.lane, (3.5, 0.0, -3.5)):
            self.assertAlmostEqual(lane.central_curve.segment[0].start_position.y, y, delta=1e-3)
            self.assertAlmostEqual(lane.length, 252.0, delta=2.5)
            self.assertAlmostEqual(lane.speed_limit, 29.06)
            for sample in lane.left_sample + lane.right_sample:
                self.assertAlmostEqual(sample.width, 1.75, delta=1e-2)

    def test_maps_follow_each_other_without_a_gap_and_keep_the_contract(self):
        self.drive()
        wait_for(lambda: len(self.maps.data) > 20, '20 maps')
        numbers = [head.sequence_num for head in self.maps.heads()]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))))
        self.expect_contract()

    def expect_rate(self, rate):
        """In some stretch of a second or more the maps come at this rate, within a tenth, and never faster."""
        count = max(10, int(rate))

        def steady():
            stamps = [head.stamp.to_sec() for head in self.maps.heads(-count - 1)]
            return len(stamps) > count and abs((stamps[-1] - stamps[0]) * rate / count - 1.0) < 0.1

        start, first = time.monotonic(), len(self.maps.data)
        wait_for(steady, '%d maps at %.0f Hz' % (count, rate))
        self.assertLess(len(self.maps.data) - first, 1.1 * rate * (time.monotonic() - start) + 2)

    def test_ten_maps_a_second(self):
        self.drive()
        self.expect_rate(10.0)

    def test_a_hundred_maps_a_second(self):
        self.drive(parameters={'rate': 100}, vehicle_rate=200.0)
        self.expect_rate(100.0)

    def test_a_late_subscriber_gets_maps_of_now(self):
        self.drive()
        self.assertEqual(self.maps.connections[0]['latching'], '0')
        before = self.maps.heads(-1)[0].sequence_num
        late = MapLog()
        self.addCleanup(late.subscriber.unregister)
        wait_for(lambda: late.data, 'map for a late subscriber')
        self.assertGreaterEqual(late.heads()[0].sequence_num, before)

    def test_reset_forgets_the_inputs(self):
        self.drive()
        self.vehicle.sends_localization = self.vehicle.sends_markers = False
        self.maps.next_with(MapStatus.STALE_LOCALIZATION)
        response = rospy.ServiceProxy('relative_map/reset', Trigger)()
        self.assertTrue(response.success, response.message)
        self.assertEqual(self.maps.next_with(MapStatus.NO_LOCALIZATION).lane_marker, LaneMarkers())
        self.vehicle.sends_localization = True
        self.three_lanes()
        self.expect_contract()

    def test_diagnostics(self):
        log = self.latest('/diagnostics', DiagnosticArray)

        def status_with(level):
            statuses = log.message.status if log.message else []
            return next((s for s in statuses if s.name == 'relative_map: relative map' and s.level == level), None)

        self.start()
        self.vehicle.sends_markers = False
        self.vehicle.start()
        wait_for(lambda: status_with(DiagnosticStatus.WARN), 'warning before the first map')
        self.vehicle.navigation.publish(vehicle_messages.three_lines())
        status = wait_for(lambda: status_with(DiagnosticStatus.OK), 'diagnostics that are OK')
        values = {entry.key: entry.value for entry in status.values}
        self.assertEqual(values['source'], 'NAVIGATION_LINE')
        self.assertGreater(float(values['remaining distance [m]']), 1000.0)
        self.vehicle.sends_localization = False
        status = wait_for(lambda: status_with(DiagnosticStatus.ERROR), 'diagnostics in error')
        self.assertIn('STALE_LOCALIZATION', status.message)

    def test_views(self):
        markers = self.latest('relative_map/markers', MarkerArray)
        path = self.latest('relative_map/centerline', Path)
        self.drive()
        wait_for(lambda: markers.message and path.message and path.message.poses, 'markers and centerline')
        wait_for(lambda: 'lanes' in {marker.ns for marker in markers.message.markers}, 'drawn lanes')
        self.assertEqual(markers.message.markers[0].action, Marker.DELETEALL)
        self.assertEqual(path.message.header.frame_id, 'base_link')
        self.assertIn(path.message.header.stamp, self.vehicle.stamps)
        self.assertGreater(len(path.message.poses), 200)

    def test_topics_can_be_remapped(self):
        # With a slash: roscpp takes `relative_map:=` for the node's own name, and ignores it.
        topics = ('navigation', 'localization', 'chassis', 'perception/lane_markers', '/relative_map')
        self.drive(names=lambda name: '/car/' + name,
                   arguments=['%s:=/car/%s' % (topic, topic.lstrip('/')) for topic in topics])


if __name__ == '__main__':
    rospy.init_node('node_output_test')
    rostest.rosrun('relative_map', 'outputs', Outputs)
