#!/usr/bin/env python3
"""What `navigation_line` makes of good input: each subcommand, from a bag to a loop."""

import json
import math

import rosbag
import rospy
import rostest

from navigation_line_support import (START, ToolTest, X, Y, drive, fixes, localization, odometry, pose_stamped, smoothed,
                                     straight)


class NavigationLine(ToolTest):
    def points(self, name):
        objects = [json.loads(line) for line in self.read(name).splitlines()]
        return [entry for entry in objects if 'x' in entry]

    def header(self, name):
        return json.loads(self.read(name).splitlines()[0])['header']

    def test_every_subcommand_teaches(self):
        text = self.expect('--help')
        for name in 'record smooth convert resample close offset reverse cut join check publish'.split():
            self.assertIn('\n  ' + name, text)
            self.assertIn('Usage: navigation_line ' + name, self.expect(name, '--help'))

    def test_records_from_every_type(self):
        for make in (localization, odometry, pose_stamped):
            self.record('drive.bag', drive('/pose', make))
            self.expect('record', 'drive.bag', 'line.smoothed')
            points = self.points('line.smoothed')
            self.assertGreater(len(points), 250)
            self.assertEqual(self.header('line.smoothed'), {'frame_id': 'map'})
            for point in points:
                self.assertAlmostEqual(math.hypot(point['x'] - X, point['y'] - Y - 100.0), 100.0, delta=1e-6)

    def test_records_fixes_to_utm_and_to_a_local_frame(self):
        self.record('gps.bag', fixes())
        self.expect('record', 'gps.bag', 'utm.smoothed')
        self.assertEqual(self.header('utm.smoothed'), {'frame_id': 'map', 'projection': 'utm', 'zone': 32, 'north': True})
        self.expect('record', 'gps.bag', 'local.smoothed', '--local')
        self.assertEqual(self.header('local.smoothed')['projection'], 'local')
        first, last = self.points('local.smoothed')[0], self.points('local.smoothed')[-1]
        self.assertAlmostEqual(first['x'], 0.0, delta=1.0)
        self.assertAlmostEqual(last['x'], 149.0, delta=2.0)

    def test_smooths_and_says_what_came_out(self):
        self.record('drive.bag', drive('/pose', odometry))
        self.expect('record', 'drive.bag', 'raw.smoothed')
        text = self.expect('smooth', 'raw.smoothed', 'line.smoothed')
        for word in ('points', 'greatest deviation', 'greatest curvature ', 'greatest curvature rate'):
            self.assertIn(word, text)
        points = self.points('line.smoothed')
        self.assertEqual(self.header('line.smoothed'), {'frame_id': 'map'})
        for point in points[20:-20]:
            self.assertAlmostEqual(point['kappa'], 0.01, delta=1e-3)
        self.expect('check', 'line.smoothed')

    def test_converts_there_and_back(self):
        self.record('gps.bag', fixes())
        self.expect('record', 'gps.bag', 'line.smoothed')
        before = self.points('line.smoothed')
        for name in ('a.json', 'a.csv', 'a.gpx', 'a.geojson', 'a.bag'):
            self.expect('convert', 'line.smoothed', name)
            self.expect('convert', name, 'back.smoothed')
            self.assertEqual(self.header('back.smoothed'), self.header('line.smoothed'), name)
            after = self.points('back.smoothed')
            self.assertEqual(len(after), len(before))
            for a, b in zip(after, before):
                self.assertAlmostEqual(a['x'], b['x'], delta=1e-6)
                self.assertAlmostEqual(a['y'], b['y'], delta=1e-6)
        with rosbag.Bag(self.path('a.bag')) as bag:
            self.assertEqual(bag.get_type_and_topic_info().topics['/navigation_line'].msg_type, 'nav_msgs/Path')

    def test_csv_with_any_separator(self):
        self.write('in.csv', 'lon;lat\n11.5;48.1\n11.501;48.1\n')
        self.expect('convert', 'in.csv', 'out.csv', '--lonlat', '--separator', 'tab')
        self.assertIn('lon\tlat\talt', self.read('out.csv'))

    def test_edits(self):
        self.write('a.smoothed', smoothed(straight(100.0)))
        self.write('b.smoothed', smoothed(straight(50.0, start=101.0)))
        self.expect('offset', 'a.smoothed', 'left.smoothed', '--distance', '3.5')
        self.assertEqual({point['y'] for point in self.points('left.smoothed')}, {3.5})
        self.expect('offset', 'a.smoothed', 'right.smoothed', '--distance', '-3.5')
        self.assertEqual({point['y'] for point in self.points('right.smoothed')}, {-3.5})
        self.expect('reverse', 'a.smoothed', 'back.smoothed')
        self.assertEqual(self.points('back.smoothed')[0]['x'], 100.0)
        self.assertAlmostEqual(abs(self.points('back.smoothed')[0]['theta']), math.pi)
        self.expect('cut', 'a.smoothed', 'part.smoothed', '--from', '10', '--to', '20.2')
        self.assertAlmostEqual(self.points('part.smoothed')[-1]['s'], 10.2)
        self.expect('join', 'a.smoothed', 'b.smoothed', 'both.smoothed')
        self.assertAlmostEqual(self.points('both.smoothed')[-1]['s'], 151.0)
        self.expect('resample', 'a.smoothed', 'thin.smoothed', '--by-curvature')
        self.assertAlmostEqual(self.points('thin.smoothed')[1]['s'], 3.0)
        self.expect('resample', 'a.smoothed', 'a.smoothed', '--spacing', '1', '--replace')  # onto itself
        self.assertEqual(len(self.points('a.smoothed')), 101)

    def test_closes_a_lap(self):
        lap = [(50.0 * math.cos(0.01 * i), 50.0 * math.sin(0.01 * i)) for i in range(620)]
        self.write('lap.smoothed', smoothed(lap))
        self.expect('close', 'lap.smoothed', 'loop.smoothed')
        points = self.points('loop.smoothed')
        self.assertEqual((points[0]['x'], points[0]['y']), (points[-1]['x'], points[-1]['y']))
        self.assertIn('a loop', self.expect('smooth', 'loop.smoothed', 'smooth.smoothed'))

    def test_check_lists_faults_with_their_places(self):
        points = straight(100.0)
        self.write('good.smoothed', smoothed(points))
        self.assertIn('good.smoothed: fit to be driven on', self.expect('check', 'good.smoothed'))
        self.write('bad.smoothed', smoothed(points[:50] + points[70:] + points[-1:]))
        run = self.run_tool('check', 'good.smoothed', 'bad.smoothed')
        self.assertEqual(run.returncode, 1)
        self.assertIn('bad.smoothed: gap at point 50, s = 24.5 m', run.stdout)
        self.assertIn('bad.smoothed: duplicate at point 181', run.stdout)

    def test_check_begins_with_its_verdict_and_what_to_do(self):
        self.write('raw.smoothed', smoothed([(0.5 * i, 0.3 * (i % 2)) for i in range(200)]))
        first = self.run_tool('check', 'raw.smoothed').stdout.splitlines()[0]
        self.assertIn('raw.smoothed: not fit to be driven on', first)
        self.assertIn('smooth it', first)
        points = straight(100.0)
        self.write('gap.smoothed', smoothed(points[:50] + points[70:]))
        first = self.run_tool('check', 'gap.smoothed').stdout.splitlines()[0]
        self.assertIn('gap.smoothed: not fit to be driven on, 1 fault', first)
        self.assertNotIn('smooth it', first)

    def test_check_compares_files(self):
        line = smoothed(straight(100.0, y=10.0, start=690000.0))
        self.write('a.smoothed', '{"header": {"projection": "utm", "zone": 50, "north": true}}\n' + line)
        self.write('b.smoothed', '{"header": {"projection": "utm", "zone": 51, "north": true}}\n' + line)
        run = self.run_tool('check', 'a.smoothed', 'b.smoothed')
        self.assertEqual(run.returncode, 1)
        self.assertIn('b.smoothed: zone:', run.stdout)
        self.assertEqual(self.run_tool('check', 'a.smoothed', '--utm', '51N').returncode, 1)
        self.assertEqual(self.run_tool('check', 'a.smoothed', '--utm', '50N').returncode, 0)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'navigation_line', NavigationLine)
