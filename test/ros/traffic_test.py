#!/usr/bin/env python3
"""Simulated traffic keeps the laws of its models and of the road, and scenes of it can be predicted."""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

import roslib.packages
import rospkg
import rostest

PACKAGE = rospkg.RosPack().get_path('relative_map')
sys.path.insert(0, os.path.join(PACKAGE, 'src', 'apps', 'simulation'))
import traffic_model as model  # noqa: E402


def road(lanes=3, length=1500.0):
    return model.Road(model.straight_lines(lanes, length))


class TrafficModel(unittest.TestCase):
    def test_a_follower_settles_at_the_models_gap(self):
        v = 10.0  # of the leader, for ever
        gap, own = 60.0, 14.0
        for _ in range(2000):
            own = max(0.0, own + model.STEP * model.idm(own, 15.0, gap, own - v))
            gap += model.STEP * (v - own)
        wanted = (model.STANDSTILL_GAP + v * model.HEADWAY) / math.sqrt(1.0 - (v / 15.0)**4)
        self.assertAlmostEqual(own, v, delta=0.01)
        self.assertAlmostEqual(gap, wanted, delta=0.05)

    def test_nobody_collides_drives_backwards_or_brakes_harder_than_cars_can(self):
        for seed in range(1, 4):
            traffic = model.Traffic(road(), seed=seed)
            before = {}
            for _ in range(400):
                traffic.step()
                for car in traffic.cars:
                    self.assertGreaterEqual(car.s, before.get(car.name, -1e9) - 1e-9)
                    self.assertGreaterEqual(car.acceleration, -model.HARDEST_BRAKING)
                    before[car.name] = car.s
                cars = traffic.cars
                for i, a in enumerate(cars):
                    for b in cars[i + 1:]:
                        beside = abs(a.lateral(traffic.road) - b.lateral(traffic.road))
                        self.assertFalse(abs(a.s - b.s) < model.CAR[0] and beside < model.CAR[1],
                                         '%s and %s at %.1f s, seed %d' % (a.name, b.name, traffic.time, seed))

    def test_who_is_held_up_changes_lanes(self):
        traffic = model.Traffic(road(2), cars=0, pedestrians=0)
        slow, fast = model.Car('slow', 1, 80.0, 5.0, 5.0), model.Car('fast', 1, 30.0, 14.0, 14.0)
        traffic.cars = [slow, fast]
        for _ in range(200):
            traffic.step()
        self.assertEqual(fast.lane, 0)
        self.assertGreater(fast.s, slow.s)
        self.assertEqual(slow.lane, 1)

    def test_one_cuts_in_before_the_vehicle_and_pedestrians_get_across(self):
        traffic = model.Traffic(road(), cars=3, pedestrians=1)
        s, cut_in, walked = 20.0, False, False
        for _ in range(600):
            s += 1.15  # slower than the one beside
            traffic.step((s, 0.0, 11.5))
            cut_in = cut_in or any(car.name == 'cutter' and car.lane == 1 and car.changes() for car in traffic.cars)
            walked = walked or traffic.pedestrians[0].way >= traffic.cross
        self.assertTrue(cut_in)
        self.assertTrue(walked)

    def test_nobody_is_in_the_way_of_the_vehicle_which_does_not_brake(self):
        for seed in range(1, 4):
            for speed in (8.0, 15.0):
                traffic = model.Traffic(road(), speed=1.3 * speed, seed=seed)
                s = 20.0
                for _ in range(500):
                    s += model.STEP * speed
                    traffic.step((s, 0.0, speed))
                    for _, _, x, y, _, _, _, length, width in traffic.users():
                        ahead, beside = x, y + 3.5  # of the straight road's middle lane
                        self.assertFalse(abs(ahead - s) < 0.5 * (length + model.CAR[0]) and
                                         abs(beside) < 0.5 * (width + model.CAR[1]),
                                         'at %.1f s, seed %d, %.0f m/s' % (traffic.time, seed, speed))

    def test_a_road_is_told_by_s_and_l_on_a_curve(self):
        circle = [[((200.0 + d) * math.sin(0.01 * i), 200.0 - (200.0 + d) * math.cos(0.01 * i)) for i in range(100)]
                  for d in (-3.5, 0.0, 3.5)]
        curved = model.Road(circle)
        self.assertAlmostEqual(curved.offset(0, 100.0), 3.5, delta=0.05)
        self.assertAlmostEqual(curved.offset(2, 100.0), -3.5, delta=0.05)
        x, y, _ = curved.pose(77.0, 2.0)
        s, l = curved.project(x, y)
        self.assertAlmostEqual(s, 77.0, delta=0.1)
        self.assertAlmostEqual(l, 2.0, delta=0.02)

    def test_the_sensor_has_the_errors_that_it_is_told_to_have(self):
        sensor = model.Sensor(reach=50.0, noise=0.2, dropouts=0.1, swap_period=2.0)
        users = [('a', 'VEHICLE', 10.0, 0.0, 0.0, 0.0, 0.0, 4.6, 1.9), ('b', 'VEHICLE', 20.0, 4.0, 0.0, 0.0, 0.0, 4.6, 1.9),
                 ('far', 'VEHICLE', 60.0, 0.0, 0.0, 0.0, 0.0, 4.6, 1.9)]
        errors, count, ids = [], 0, set()
        for _ in range(2000):
            for number, _, x, y, _, _, _ in sensor.see(users, 0.0, 0.0):
                count += 1
                near_a = abs(x - 10.0) < 5.0
                errors.append(x - (10.0 if near_a else 20.0))
                ids.add((number, near_a))
        self.assertAlmostEqual(count / 4000.0, 0.9, delta=0.02)
        self.assertAlmostEqual(math.sqrt(sum(e * e for e in errors) / len(errors)), 0.2, delta=0.02)
        self.assertEqual(len(ids), 4)  # each has had both ids, and nobody saw the far one

    def test_a_scene_of_it_is_predicted(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, out = os.path.join(folder, 'scene'), os.path.join(folder, 'out.jsonl')
            tool = os.path.join(PACKAGE, 'src', 'apps', 'simulation', 'make_traffic')
            command = ['/usr/bin/python3', tool, scene, '--duration', '12']
            subprocess.run(command, check=True, timeout=60)
            again = subprocess.run(command, stderr=subprocess.PIPE, timeout=60, check=False)
            self.assertNotEqual(again.returncode, 0)
            self.assertIn(b'is there already', again.stderr)
            predict = roslib.packages.find_node('relative_map', 'predict_scene')[0]
            subprocess.run([predict, scene, out, '--noise', '0.1'], check=True, timeout=60)
            with open(out) as stream:
                entries = [json.loads(line) for line in stream]
            self.assertGreater(len(entries), 100)
            on_lanes = [entry for entry in entries if entry['type'] == 'VEHICLE' and entry['lane']]
            self.assertGreater(len(on_lanes), 0.8 * sum(entry['type'] == 'VEHICLE' for entry in entries))


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'traffic_model', TrafficModel)
