#!/usr/bin/env python3
"""Lane graph, route and poses in, route segments out; the services, and what is told when something is wrong."""

import json
import math
import os
import tempfile
import threading
import unittest

import diagnostic_msgs.msg
import geometry_msgs.msg
import nav_msgs.msg
import rospy
import rostest
import std_srvs.srv
from relative_map.msg import (CurveSegment, Lane, LaneChange, LaneGraph, LaneSampleAssociation, LocalizationEstimate, Route,
                              RoutePassage, RouteSegmentsArray, RouteStatus, RouteWaypoint)
from relative_map.srv import ChangeLane, ChangeLaneRequest, FindRoute, LoadLaneGraph


def lane(row, column):
    """Rows a (left) and b, 3.5 m apart, of lanes of 100 m along x."""
    result = Lane(id='%s%d' % ('ab'[row], column), speed_limit=10.0, type=Lane.CITY_DRIVING, turn=Lane.NO_TURN)
    segment = CurveSegment()
    segment.line_segment.point = [geometry_msgs.msg.Point(100.0 * column + 5.0 * i, -3.5 * row, 0.0) for i in range(21)]
    result.central_curve.segment = [segment]
    result.left_sample = result.right_sample = [LaneSampleAssociation(0.0, 1.75)]
    if column < 2:
        result.successor_id = ['%s%d' % ('ab'[row], column + 1)]
    if column > 0:
        result.predecessor_id = ['%s%d' % ('ab'[row], column - 1)]
    if row == 0:
        result.right_neighbor_forward_lane_id = ['b%d' % column]
    else:
        result.left_neighbor_forward_lane_id = ['a%d' % column]
    return result


def graph():
    result = LaneGraph()
    result.header.frame_id = 'map'
    result.lane = [lane(row, column) for row in range(2) for column in range(3)]
    return result


class RouteMapTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('route_map_test')
        cls.pose = None
        cls.told = []
        cls.changed = threading.Condition()
        cls.graphs = rospy.Publisher('lane_graph', LaneGraph, queue_size=1, latch=True)
        cls.routes = rospy.Publisher('route', Route, queue_size=1, latch=True)
        cls.localization = rospy.Publisher('localization', LocalizationEstimate, queue_size=10)
        cls.subscriber = rospy.Subscriber('route_segments', RouteSegmentsArray, cls.on_told)
        cls.timer = rospy.Timer(rospy.Duration(0.05), cls.send_pose)
        for service, kind in (('find_route', FindRoute), ('clear_route', std_srvs.srv.Trigger),
                              ('load_lane_graph', LoadLaneGraph), ('change_lane', ChangeLane)):
            rospy.wait_for_service('route_map/' + service, 20.0)
            setattr(cls, service, staticmethod(rospy.ServiceProxy('route_map/' + service, kind)))

    @classmethod
    def on_told(cls, message):
        with cls.changed:
            cls.told.append(message)
            cls.changed.notify_all()

    @classmethod
    def send_pose(cls, _):
        if cls.pose is None:
            return
        message = LocalizationEstimate()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = 'map'
        message.pose.position.x, message.pose.position.y, message.pose.heading = cls.pose
        message.pose.orientation.w = 1.0
        cls.localization.publish(message)

    def wait_for(self, right, what, seconds=15.0):
        end = rospy.get_time() + seconds
        with self.changed:
            del self.told[:]
            while rospy.get_time() < end:
                for message in self.told:
                    if right(message):
                        return message
                self.changed.wait(0.2)
            codes = sorted({(m.status.code, m.status.message) for m in self.told})
        self.fail('%s: never told; told was %s' % (what, codes))

    def follow(self, *waypoints):
        response = self.find_route(from_vehicle=False, follow=True, closed_lane=[],
                                   waypoint=[RouteWaypoint(lane_id=name, s=s) for name, s in waypoints])
        self.assertTrue(response.success, response.message)
        return response.route

    def setUp(self):
        type(self).pose = (20.0, -3.3, 0.0)
        self.graphs.publish(graph())
        rospy.sleep(0.5)

    def test_the_way_is_found_and_told(self):
        route = self.follow(('b0', 10.0), ('a2', 80.0))
        self.assertAlmostEqual(route.distance, 270.0, places=3)
        lines = []
        subscriber = rospy.Subscriber('route_map/reference_line', nav_msgs.msg.Path, lines.append)
        message = self.wait_for(lambda m: m.status.code == RouteStatus.OK and m.lane_id == 'b0', 'on the route')
        self.assertEqual(message.header.frame_id, 'map')
        self.assertEqual([s.is_on_segment for s in message.segments], [True, False])
        own, beside = message.segments
        self.assertEqual(own.next_action, RoutePassage.LEFT)
        self.assertEqual(beside.previous_action, RoutePassage.LEFT)
        self.assertTrue(own.has_change)
        self.assertGreater(own.change_end, 70.0)
        self.assertEqual([(s.lane_id, s.start_s, s.end_s) for s in own.segment][0], ('b0', 0.0, 100.0))
        self.assertAlmostEqual(message.l, 0.2, places=3)
        self.assertAlmostEqual(message.distance_to_destination, 260.0, places=2)
        self.assertGreater(len(own.path.path_point), 150)
        self.assertEqual(len(own.path.path_point), len(own.speed_limit))
        self.assertTrue(all(abs(p.y + 3.5) < 1e-3 and abs(p.kappa) < 1e-3 for p in own.path.path_point))
        self.wait_for(lambda _: lines, 'the line as nav_msgs/Path')
        self.assertEqual(lines[-1].header.frame_id, 'map')
        subscriber.unregister()

    def test_a_drive_to_the_destination(self):
        self.follow(('a0', 10.0), ('a2', 80.0))
        last = None
        for x in range(20, 281, 20):
            type(self).pose = (float(x), 0.0, 0.0)
            message = self.wait_for(lambda m: m.status.code == RouteStatus.OK and abs(m.distance_to_destination - 280.0 + x)
                                    < 0.01, 'at %d' % x)
            if last is not None:
                self.assertGreater(message.sequence_num, last.sequence_num)
            last = message
        self.assertTrue(last.segments[0].stop_for_destination)
        self.assertTrue(last.segments[0].has_route_end)
        self.assertAlmostEqual(last.segments[0].segment[-1].end_s, 80.0, places=3)

    def test_what_is_wrong_is_told(self):
        self.follow(('a0', 10.0), ('a2', 80.0))
        type(self).pose = (50.0, -40.0, 0.0)
        message = self.wait_for(lambda m: m.status.code == RouteStatus.OFF_ROUTE, 'off the route')
        self.assertEqual(message.segments, [])
        type(self).pose = (50.0, 0.0, math.pi)
        self.wait_for(lambda m: m.status.code == RouteStatus.WRONG_WAY, 'the wrong way')
        type(self).pose = (float('nan'), 0.0, 0.0)
        self.wait_for(lambda m: m.status.code == RouteStatus.NO_LOCALIZATION, 'a pose that is none')
        type(self).pose = None
        self.wait_for(lambda m: m.status.code == RouteStatus.STALE_LOCALIZATION, 'no pose any more')
        statuses = []
        subscriber = rospy.Subscriber('/diagnostics', diagnostic_msgs.msg.DiagnosticArray, statuses.append)
        self.wait_for(lambda _: any('route map' in s.name and s.level == diagnostic_msgs.msg.DiagnosticStatus.ERROR
                                    for a in statuses for s in a.status), 'the diagnostic')
        subscriber.unregister()
        type(self).pose = (50.0, 0.0, 0.0)
        self.wait_for(lambda m: m.status.code == RouteStatus.OK, 'again on the route')

    def test_a_bad_route_leaves_the_old_one(self):
        good = self.follow(('a0', 10.0), ('a2', 80.0))
        type(self).pose = (50.0, 0.0, 0.0)
        self.wait_for(lambda m: m.status.code == RouteStatus.OK, 'on the route')
        bad = Route(header=good.header, waypoint=good.waypoint, road=[])
        self.routes.publish(bad)
        rospy.sleep(0.5)
        self.wait_for(lambda m: m.status.code == RouteStatus.OK, 'still on the route')
        self.routes.publish(good)
        response = self.clear_route()
        self.assertTrue(response.success)

    def test_a_lane_change_that_is_asked_for(self):
        states, routes = [], []
        watched = (rospy.Subscriber('route_map/lane_change', LaneChange, states.append),
                   rospy.Subscriber('route_map/route', Route, routes.append))
        self.follow(('a0', 10.0), ('a2', 80.0))
        type(self).pose = (30.0, 0.0, 0.0)
        self.wait_for(lambda m: m.status.code == RouteStatus.OK and m.lane_id == 'a0', 'on the route')
        refused = self.change_lane(to=ChangeLaneRequest.LEFT, lane_id='', force=False)
        self.assertFalse(refused.success)
        self.assertIn("no lane to the left of lane 'a0'", refused.message)
        accepted = self.change_lane(to=ChangeLaneRequest.LANE, lane_id='b0', force=False)
        self.assertTrue(accepted.success, accepted.message)
        self.assertEqual(accepted.lane_id, 'b0')
        message = self.wait_for(lambda m: len(m.segments) == 2, 'two passages')
        self.assertEqual([s.priority for s in message.segments], [1, 0])
        self.assertEqual(message.segments[1].previous_action, RoutePassage.RIGHT)
        again = self.change_lane(to=ChangeLaneRequest.RIGHT, lane_id='', force=False)
        self.assertIn('is on', again.message)
        type(self).pose = (60.0, -3.4, 0.0)
        self.wait_for(lambda m: m.lane_id == 'b0' and states and states[-1].state == LaneChange.DONE, 'done')
        self.assertEqual((states[-1].from_lane, states[-1].to_lane), ('a0', 'b0'))
        self.assertEqual(states[-2].state, LaneChange.CHANGING)
        self.assertEqual(routes[-1].road[0].passage[0].segment[0].lane_id, 'a0')
        back = self.change_lane(to=ChangeLaneRequest.BACK, lane_id='', force=False)
        self.assertEqual((back.message, back.lane_id), ('', 'a0'))
        back = self.change_lane(to=ChangeLaneRequest.BACK, lane_id='', force=False)
        self.assertTrue(back.success, back.message)
        self.wait_for(lambda m: m.status.code == RouteStatus.OK and states[-1].state == LaneChange.ABANDONED, 'taken back')
        statuses = []
        watched += (rospy.Subscriber('/diagnostics', diagnostic_msgs.msg.DiagnosticArray, statuses.append),)
        self.wait_for(lambda _: any(v.key == 'lane change' and 'taken back' in v.value for a in statuses
                                    for s in a.status for v in s.values), 'the diagnostic')
        for subscriber in watched:
            subscriber.unregister()

    def test_no_way_is_a_sentence(self):
        response = self.find_route(from_vehicle=False, follow=True, closed_lane=[],
                                   waypoint=[RouteWaypoint(lane_id='a1', s=50.0), RouteWaypoint(lane_id='a0', s=50.0)])
        self.assertFalse(response.success)
        self.assertIn('no way leads', response.message)
        type(self).pose = (50.0, 0.0, 0.0)
        rospy.sleep(0.3)
        response = self.find_route(from_vehicle=True, follow=False, closed_lane=[],
                                   waypoint=[RouteWaypoint(pose=geometry_msgs.msg.Point(250.0, 0.4, 0.0),
                                                           heading=float('nan'))])
        self.assertTrue(response.success, response.message)
        self.assertAlmostEqual(response.route.waypoint[0].s, 50.0, places=2)
        self.assertEqual(response.route.waypoint[1].lane_id, 'a2')

    def test_a_graph_from_a_file(self):
        folder = tempfile.mkdtemp()
        path = os.path.join(folder, 'graph.json')
        with open(path, 'w') as stream:
            json.dump({'lanes': [{'id': 'only', 'centerline': [[0, 0], [100, 0]]}]}, stream)
        response = self.load_lane_graph(file=path, frame_id='map')
        self.assertTrue(response.success, response.message)
        with open(path, 'w') as stream:
            stream.write('{"lanes": [')
        response = self.load_lane_graph(file=path, frame_id='map')
        self.assertFalse(response.success)
        self.assertIn('not valid JSON', response.message)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'route_map_test', RouteMapTest)
