#!/usr/bin/env python3
"""What other stacks publish of road users comes out as PerceptionObstacles; their messages are told by hand here."""

import math
import os
import random
import sys
import unittest
from types import SimpleNamespace as Message

import rospkg
import rospy
import rostest
from geometry_msgs.msg import Pose, PoseArray, Quaternion, Twist, Vector3
from relative_map.msg import PerceptionObstacle
from std_msgs.msg import Header

sys.path.insert(0, os.path.join(rospkg.RosPack().get_path('relative_map'), 'src', 'apps', 'prediction'))
from obstacle_conversion import Converter  # noqa: E402


def pose(x, y, yaw=0.0):
    result = Pose(orientation=Quaternion(z=math.sin(0.5 * yaw), w=math.cos(0.5 * yaw)))
    result.position.x, result.position.y = x, y
    return result


def header(t=1.0):
    return Header(stamp=rospy.Time.from_sec(t), frame_id='lidar')


class ObstacleConversion(unittest.TestCase):
    def test_derived_objects_keep_ids_velocities_and_boxes(self):
        box = Message(type=1, dimensions=[4.5, 1.8, 1.5])
        source = Message(id=17, pose=pose(10.0, -2.0, 0.5), shape=box, classification=6, classification_certainty=255,
                         twist=Twist(linear=Vector3(3.0, 4.0, 0.0)), accel=Twist(linear=Vector3(0.5, 0.0, 0.0)))
        result = Converter('derived_object_msgs/ObjectArray').convert(Message(header=header(), objects=[source]))
        self.assertEqual(result.header.frame_id, 'lidar')
        car = result.perception_obstacle[0]
        self.assertEqual((car.id, car.type), (17, PerceptionObstacle.VEHICLE))
        self.assertAlmostEqual(car.theta, 0.5)
        self.assertEqual((car.velocity.x, car.velocity.y, car.acceleration.x), (3.0, 4.0, 0.5))
        self.assertEqual((car.length, car.width, car.height), (4.5, 1.8, 1.5))

    def test_autowares_speed_is_along_the_box(self):
        source = Message(id=3, label='Person', score=0.9, pose=pose(1.0, 2.0, math.pi / 2.0),
                         dimensions=Vector3(0.6, 0.6, 1.8), velocity=Twist(linear=Vector3(1.3, 0.0, 0.0)))
        walker = Converter('autoware_msgs/DetectedObjectArray').convert(
            Message(header=header(), objects=[source])).perception_obstacle[0]
        self.assertEqual((walker.id, walker.type), (3, PerceptionObstacle.PEDESTRIAN))
        self.assertAlmostEqual(walker.velocity.x, 0.0)
        self.assertAlmostEqual(walker.velocity.y, 1.3)

    def test_detections_of_vision_have_labels_and_their_trackers_names(self):
        def detection(name, number):
            return Message(results=[Message(id=0, score=0.2), Message(id=number, score=0.7)], is_tracking=bool(name),
                           tracking_id=name, bbox=Message(center=pose(5.0 * number, 0.0), size=Vector3(4.0, 2.0, 1.5)))
        converter = Converter('vision_msgs/Detection3DArray', {'1': 'car', '2': 'cyclist'})
        first = converter.convert(Message(header=header(), detections=[detection('x', 1), detection('y', 2)]))
        again = converter.convert(Message(header=header(1.1), detections=[detection('y', 2)]))
        self.assertEqual([o.type for o in first.perception_obstacle],
                         [PerceptionObstacle.VEHICLE, PerceptionObstacle.BICYCLE])
        self.assertEqual(again.perception_obstacle[0].id, first.perception_obstacle[1].id)
        # Without a tracker they are numbered by place.
        bare = Converter('vision_msgs/Detection3DArray')
        ids = [o.id for o in bare.convert(
            Message(header=header(), detections=[detection('', 1), detection('', 2)])).perception_obstacle]
        moved = bare.convert(Message(header=header(1.1), detections=[detection('', 2), detection('', 1)]))
        self.assertEqual([o.id for o in moved.perception_obstacle], ids[::-1])

    def test_poses_get_ids_that_stay(self):
        generator = random.Random(1)
        converter = Converter('geometry_msgs/PoseArray')
        seen = {}
        for step in range(100):
            t = 0.1 * step
            places = [(12.0 * t, 0.0), (200.0 - 15.0 * t, 3.5), (50.0, -4.0 + 1.3 * t)]
            order = [0, 1, 2]
            generator.shuffle(order)
            missing = generator.randrange(3) if step % 7 == 3 else None
            poses = [pose(places[k][0] + generator.gauss(0.0, 0.1), places[k][1]) for k in order if k != missing]
            result = converter.convert(PoseArray(header=header(1.0 + t), poses=poses))
            for k, o in zip([k for k in order if k != missing], result.perception_obstacle):
                seen.setdefault(k, set()).add(o.id)
        self.assertEqual([len(ids) for ids in seen.values()], [1, 1, 1])
        self.assertEqual(len(set.union(*seen.values())), 3)
        self.assertEqual(result.perception_obstacle[0].type, PerceptionObstacle.UNKNOWN_MOVABLE)

    def test_an_unknown_type_is_refused_by_name(self):
        with self.assertRaisesRegex(ValueError, "'some_msgs/Things' is none of"):
            Converter('some_msgs/Things')


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'obstacle_conversion', ObstacleConversion)
