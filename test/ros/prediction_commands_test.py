#!/usr/bin/env python3
"""predict and check_prediction on bags: the same predictions each time, and faults that are told apart."""

import unittest

import rosbag
import rospy
import rostest
import roslib.packages
from relative_map.msg import PerceptionObstacle, PerceptionObstacles

import replay_support as support

TOPIC = '/prediction'


def traffic(seconds=4.0):
    """On three lanes: one ahead that is faster, one behind, one that crosses on foot, and one frame of nonsense."""
    yield from support.drive()
    frames = int(10 * seconds)
    for frame in range(frames):
        stamp = support.START + rospy.Duration(0, 100000000) * frame
        t = 0.1 * frame
        x = 20.0 + 10.0 * t
        message = PerceptionObstacles()
        message.header.stamp = stamp
        message.header.frame_id = 'base_link'
        for number, kind, (px, py) in ((1, PerceptionObstacle.VEHICLE, (45.0 + 11.0 * t, 0.2)),
                                       (2, PerceptionObstacle.VEHICLE, (5.0 + 9.0 * t, 3.4)),
                                       (3, PerceptionObstacle.PEDESTRIAN, (90.0, -8.0 + 1.3 * t))):
            road_user = PerceptionObstacle(id=number, type=kind)
            road_user.position.x, road_user.position.y = px - x, py
            message.perception_obstacle.append(road_user)
        if frame == 7:
            message.perception_obstacle[0].position.x = float('nan')
            message.perception_obstacle[1].velocity.x = 1000.0
            message.perception_obstacle[1].length = -1.0
        yield '/perception/obstacles', message, stamp


class PredictionCommands(support.ReplayTest):
    def run_tool(self, name, *words):
        tool = roslib.packages.find_node('relative_map', name)[0]
        support_tool, support.replay_tool = support.replay_tool, lambda: tool
        try:
            return support.Run(list(words), self.folder)
        finally:
            support.replay_tool = support_tool

    def predictions(self, name):
        with rosbag.Bag(self.path(name)) as bag:
            return [(t, message) for _, message, t in bag.read_messages(TOPIC)]

    def setUp(self):
        super().setUp()
        entries = sorted(traffic(), key=lambda entry: entry[2])
        support.write_bag(self.path('drive.bag'), entries)
        self.assertEqual(support.Run(['drive.bag', 'maps.bag'], self.folder).code, 0)
        with rosbag.Bag(self.path('maps.bag')) as bag:
            entries += list(bag.read_messages())
        support.write_bag(self.path('in.bag'), sorted(entries, key=lambda entry: entry[2]))

    def test_a_bag_is_predicted_the_same_way_each_time_and_holds_every_row(self):
        for name in ('a.bag', 'b.bag'):
            run = self.run_tool('predict', 'in.bag', name)
            self.assertEqual(run.code, 0, run.errors)
        first, second = self.predictions('a.bag'), self.predictions('b.bag')
        self.assertGreater(len(first), 10)
        self.assertEqual([(t, str(message)) for t, message in first], [(t, str(message)) for t, message in second])
        last = next(message for _, message in reversed(first) if message.prediction_obstacle)
        by_id = {obstacle.perception_obstacle.id: obstacle for obstacle in last.prediction_obstacle}
        self.assertEqual(sorted(by_id), [1, 2, 3])
        self.assertTrue(by_id[1].lane_id)
        self.assertNotEqual(by_id[1].lane_id, by_id[2].lane_id)
        self.assertTrue(all(obstacle.trajectory for obstacle in last.prediction_obstacle))
        check = self.run_tool('check_prediction', 'a.bag')
        self.assertEqual(check.code, 0, check.output)

    def test_a_broken_row_is_named(self):
        self.assertEqual(self.run_tool('predict', 'in.bag', 'a.bag').code, 0)
        with rosbag.Bag(self.path('broken.bag'), 'w') as bag:
            for t, message in self.predictions('a.bag'):
                for obstacle in message.prediction_obstacle:
                    obstacle.trajectory[0].probability += 0.5
                    obstacle.trajectory[0].trajectory_point[9].v = -1.0
                bag.write(TOPIC, message, t)
        check = self.run_tool('check_prediction', 'broken.bag')
        self.assertEqual(check.code, 1)
        self.assertIn('probabilities', check.output)
        self.assertIn('speed', check.output)

    def test_what_cannot_be_read_is_said(self):
        for words in (['drive.bag'], ['drive.bag', 'drive.bag'], ['none.bag', 'out.bag'], ['maps.bag', 'in.bag']):
            run = self.run_tool('predict', *words)
            self.assertNotEqual(run.code, 0, words)
            self.assertIn('predict: ', run.errors)
        self.assertEqual(self.run_tool('check_prediction', 'maps.bag').code, 2)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'prediction_commands', PredictionCommands)
