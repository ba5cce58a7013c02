#!/usr/bin/env python3
"""find_route, follow_route, follow_map and lane_graph: what they print, and what they exit with."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest

import roslib.packages
import rostest


def run(tool, *arguments):
    path = roslib.packages.find_node('relative_map', tool)[0]
    return subprocess.run([path] + [str(a) for a in arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True)


def lane(row, column, columns=3):
    name = 'ab'[row]
    return {'id': '%s%d' % (name, column), 'centerline': [[100 * column + 10 * i, -3.5 * row] for i in range(11)],
            'left_width': [[0, 1.75]], 'right_width': [[0, 1.75]], 'speed_limit': 10,
            'successors': ['%s%d' % (name, column + 1)] if column + 1 < columns else [],
            'left_neighbors': ['a%d' % column] if row else [], 'right_neighbors': [] if row else ['b%d' % column]}


class RouteCommandsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.graph = self.write('graph.json', {'lanes': [lane(row, column) for row in range(2) for column in range(3)]})

    def tearDown(self):
        shutil.rmtree(self.folder)

    def write(self, name, content):
        path = os.path.join(self.folder, name)
        with open(path, 'w') as stream:
            stream.write(content if isinstance(content, str) else json.dumps(content))
        return path

    def find(self, *arguments):
        result = run('find_route', '--graph', self.graph, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def follow(self, route, poses, *arguments):
        result = run('follow_route', '--graph', self.graph, '--route', self.write('route.json', route), '--poses',
                     self.write('poses.json', poses), *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [json.loads(line) for line in result.stdout.splitlines()]

    def test_a_route_is_found_and_followed(self):
        route = self.find('--from', 'b0', 10, '--to', 'a2', 80)
        self.assertAlmostEqual(route['distance'], 270.0)
        self.assertEqual([w['id'] for w in route['waypoints']], ['b0', 'a2'])
        told = self.follow(route, [{'x': 20, 'y': -3.3, 'heading': 0}, {'x': 20, 'y': 60, 'heading': 0},
                                   {'x': 40, 'y': -3.5, 'heading': 0.1, 'speed': 30}], '--speed', 10, '--line')
        self.assertEqual(len(told), 3)
        first = told[0]
        self.assertEqual((first['lane'], first['s'], first['route_index'], first['next_waypoint']), ('b0', 20.0, 0, 1))
        self.assertAlmostEqual(first['l'], 0.2, places=6)
        self.assertEqual([s['id'] for s in first['segments']], ['0_0', '0_1'])
        own = first['segments'][0]
        self.assertEqual(own['next_action'], 'LEFT')
        self.assertTrue(own['on_segment'])
        self.assertEqual(own['lanes'], [['b0', 0.0, 100.0], ['b1', 0.0, 100.0]])
        self.assertEqual(own['length'], 200.0)
        self.assertIn('refused', told[1])
        self.assertEqual(told[2]['segments'][0]['length'], 40.0 + 250.0)
        line = first['reference_line']
        self.assertEqual(len(line[0]), 5)
        self.assertTrue(all(abs(y + 3.5) < 1e-3 and abs(kappa) < 1e-3 for _, y, _, kappa, _ in line))

    def test_no_way_and_bad_files_are_sentences(self):
        result = run('find_route', '--graph', self.graph, '--from', 'a1', 50, '--to', 'a0', 50)
        self.assertEqual(result.returncode, 1)
        self.assertIn('no way leads', result.stderr)
        self.assertEqual(result.stdout, '')
        self.assertEqual(run('find_route', '--graph', self.graph, '--from', 'a1').returncode, 2)
        self.assertEqual(run('follow_route', '--graph', self.graph).returncode, 2)
        cut = self.write('cut.json', '{"lanes": [')
        result = run('find_route', '--graph', cut, '--from', 'a0', 0, '--to', 'a1', 0)
        self.assertEqual(result.returncode, 1)
        self.assertIn('not valid JSON', result.stderr)
        route = self.find('--from', 'a0', 10, '--to', 'a2', 80)
        route['roads'][1]['passages'][0]['segments'][0]['id'] = 'gone'
        told = self.follow(route, [{'x': 20, 'y': 0, 'heading': 0}])
        self.assertIn("'gone'", told[0]['refused'])
        told = self.follow(self.find('--from', 'a0', 10, '--to', 'a2', 80), [{'x': None, 'y': 0, 'heading': 0}])
        self.assertIn('not finite', told[0]['refused'])

    def test_a_relative_map(self):
        lanes = {'left': {'centerline': [[-10, 3.5], [100, 3.5]], 'priority': 0, 'left_neighbors': [],
                          'right_neighbors': ['right']},
                 'right': {'centerline': [[-10, 0], [100, 0]], 'priority': 1, 'left_neighbors': ['left'],
                           'right_neighbors': []}}
        for content in (lanes, {'map': lanes}):
            result = run('follow_map', '--map', self.write('map.json', content))
            self.assertEqual(result.returncode, 0, result.stderr)
            told = json.loads(result.stdout)
            self.assertEqual((told['current'], told['target']), ('right', 'left'))
            self.assertEqual(told['passages']['right'],
                             {'on_segment': True, 'next_action': 'LEFT', 'can_exit': False, 'previous_action': 'FORWARD',
                              'order': 0, 'driven_on': True})
            self.assertEqual(told['passages']['left']['previous_action'], 'LEFT')

    def test_lane_graphs_and_routes_are_drawn(self):
        route = self.write('route.json', self.find('--from', 'b0', 10, '--to', 'a2', 80))
        out = os.path.join(self.folder, 'graph.png')
        result = run('plot_lane_graph', self.graph, '--route', route, '--ids', '--out', out)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(out, 'rb') as stream:
            self.assertEqual(stream.read(8), b'\x89PNG\r\n\x1a\n')
        for graph, why in ((route, 'is no lane graph'), (os.path.join(self.folder, 'none'), 'is no file'),
                           (self.write('cut.json', '{"lanes": ['), 'not valid JSON')):
            result = run('plot_lane_graph', graph, '--out', out)
            self.assertEqual(result.returncode, 1)
            self.assertIn(why, result.stderr)
        self.assertEqual(run('plot_lane_graph', self.graph, '--route', self.graph, '--out', out).returncode, 1)
        self.assertEqual(run('plot_lane_graph', self.graph, '--out', 'graph.txt').returncode, 2)

    def test_recorded_lines_become_a_lane_graph(self):
        def line(name, points):
            return self.write(name + '.smoothed', '\n'.join(json.dumps({'x': x, 'y': y}) for x, y in points))
        on = line('on', [(x, 0.0) for x in range(0, 301, 2)])
        beside = line('beside', [(x, 3.5) for x in range(0, 301, 2)])
        off = line('off', [(x, 0.1 - max(0, x - 100) ** 2 / 100.0) for x in range(0, 161, 2)])
        out = os.path.join(self.folder, 'made.json')
        result = run('lane_graph', 'from_lines', on, beside, off, '--out', out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('5 lanes', result.stdout)
        self.assertEqual(run('lane_graph', 'check', out).returncode, 0)
        self.graph = out
        route = self.find('--from', 'beside_0', 10, '--to', 'off_1', 40)
        self.assertEqual([p['change_lane_type'] for p in route['roads'][0]['passages']][0], 'RIGHT')
        self.assertEqual(route['roads'][-1]['passages'][-1]['segments'][-1]['id'], 'off_1')
        self.assertEqual(run('lane_graph', 'from_lines', on, '--out', on).returncode, 2)
        self.assertEqual(run('lane_graph', 'from_lines', on).returncode, 2)
        result = run('lane_graph', 'from_lines', self.write('cut.smoothed', '{"x": 1'), '--out', out)
        self.assertEqual(result.returncode, 1)
        self.assertIn('cut.smoothed', result.stderr)

    def test_lane_graphs_are_checked_and_converted(self):
        result = run('lane_graph', 'check', self.graph)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn('6 lanes, 0.6 km, 0 faults', result.stdout)
        osm = self.write('map.osm', """<osm><node id='1' lat='49' lon='8.40'/><node id='2' lat='49' lon='8.41'/>
            <node id='3' lat='48.99997' lon='8.40'/><node id='4' lat='48.99997' lon='8.41'/>
            <way id='5'><nd ref='1'/><nd ref='2'/></way><way id='6'><nd ref='3'/><nd ref='4'/></way>
            <relation id='9'><member type='way' ref='5' role='left'/><member type='way' ref='6' role='right'/>
            <tag k='type' v='lanelet'/></relation></osm>""")
        out = os.path.join(self.folder, 'out.json')
        result = run('lane_graph', 'convert', osm, out, '--origin', '49,8.4')
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(out) as stream:
            graph = json.load(stream)
        self.assertEqual([lane['id'] for lane in graph['lanes']], ['9'])
        self.assertEqual(run('lane_graph', 'check', out).returncode, 0)
        bad = self.write('bad.json', {'lanes': [{'id': 'a', 'centerline': [[0, 0]]}]})
        result = run('lane_graph', 'check', bad)
        self.assertEqual(result.returncode, 1)
        self.assertIn("lane 'a' has fewer than two points", result.stdout)
        self.assertEqual(run('lane_graph', 'convert', bad, out).returncode, 1)
        with open(out) as stream:
            self.assertEqual(json.load(stream), graph)
        self.assertEqual(run('lane_graph', 'plot', bad).returncode, 2)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'route_commands_test', RouteCommandsTest)
