#!/usr/bin/env python3
"""Every launch file loads, with what it needs in place, and its arguments do what they say."""

import glob
import os
import re
import tempfile
import unittest

import catkin_pkg.package
import roslaunch.config
import roslib.packages
import rospkg
import rostest
import yaml

PACKAGE = rospkg.RosPack().get_path('relative_map')
NEEDED_ARGUMENTS = {'demo.launch': ['navigation_lines:=a.smoothed b.smoothed'],
                    'ndt_localizer.launch': ['map:=/a/map']}


def load(name, *arguments):
    path = os.path.join(PACKAGE, 'launch', name)
    return roslaunch.config.load_config_default([(path, list(arguments))], None)


def node(config, name):
    return next((node for node in config.nodes if node.name == name), None)


def command(node):
    return (node.package, node.type) + tuple(node.args.split())


class LaunchFiles(unittest.TestCase):
    def test_each_loads_and_finds_its_packages_and_programs(self):
        files = sorted(glob.glob(os.path.join(PACKAGE, 'launch', '*.launch')))
        self.assertGreaterEqual(len(files), 3)
        rospack = rospkg.RosPack()
        manifest = catkin_pkg.package.parse_package(PACKAGE)
        dependencies = [dependency.name for dependency in manifest.exec_depends] + ['relative_map']
        for name in map(os.path.basename, files):
            config = load(name, 'nodelet:=false') if name == 'relative_map.launch' else load(
                name, *NEEDED_ARGUMENTS.get(name, []))
            self.assertEqual(config.config_errors, [], name)
            self.assertGreater(len(config.nodes), 0, name)
            for node in config.nodes:
                # rviz is for people: neither vehicles nor the machines that run tests need to have it.
                if node.package != 'rviz':
                    self.assertIn(node.package, dependencies, name)
                if node.package != 'rviz' or 'rviz' in rospack.list():
                    self.assertTrue(roslib.packages.find_node(node.package, node.type), node.type)
        self.assertFalse({'rviz', 'python3-matplotlib'} & set(dependencies))

    def test_the_parameters_of_the_map_are_those_of_the_shipped_file(self):
        with open(os.path.join(PACKAGE, 'config', 'relative_map.yaml')) as file:
            shipped = yaml.safe_load(file)
        params = load('relative_map.launch').params
        for key, value in shipped.items():
            if isinstance(value, dict):
                for leaf, number in value.items():
                    self.assertEqual(params['/relative_map/%s/%s' % (key, leaf)].value, number)
            else:
                self.assertEqual(params['/relative_map/' + key].value, value)

    def test_the_map_is_a_nodelet_in_a_manager_of_its_own(self):
        config = load('relative_map.launch')
        self.assertEqual(command(node(config, 'relative_map')),
                         ('nodelet', 'nodelet', 'load', 'relative_map/RelativeMapNodelet', 'relative_map_manager'))
        self.assertEqual(command(node(config, 'relative_map_manager')), ('nodelet', 'nodelet', 'manager'))
        self.assertEqual(len(config.nodes), 2)

    def test_the_managers_name_follows_the_nodelets(self):
        config = load('relative_map.launch', 'name:=mapper')
        self.assertEqual(command(node(config, 'mapper')),
                         ('nodelet', 'nodelet', 'load', 'relative_map/RelativeMapNodelet', 'mapper_manager'))
        self.assertIsNotNone(node(config, 'mapper_manager'))

    def test_nothing_is_required_unless_asked_for(self):
        for nodelet in ('true', 'false'):
            for required in ('true', 'false'):
                config = load('relative_map.launch', 'nodelet:=' + nodelet, 'required:=' + required)
                self.assertEqual({node.required for node in config.nodes}, {required == 'true'})
        self.assertEqual({node.required for node in load('relative_map.launch').nodes}, {False})

    def test_parameters_of_an_earlier_start_are_cleared(self):
        for nodelet in ('true', 'false'):
            self.assertIn('/relative_map/', load('relative_map.launch', 'nodelet:=' + nodelet).clear_params)

    def test_lines_and_frames_are_arguments(self):
        params = load('relative_map.launch', 'navigation_lines:=/data/a b.smoothed, /data/c.csv', 'map_frame:=utm',
                      'base_frame:=car1/base_link').params
        self.assertEqual(params['/relative_map/navigation_lines'].value, ['/data/a b.smoothed', '/data/c.csv'])
        self.assertEqual(params['/relative_map/map_frame'].value, 'utm')
        self.assertEqual(params['/relative_map/base_frame'].value, 'car1/base_link')
        self.assertNotIn('/relative_map/navigation_lines', load('relative_map.launch').params)

    def test_standard_inputs_start_the_adapters_and_nothing_else_does(self):
        self.assertIsNone(node(load('relative_map.launch'), 'relative_map_adapters'))
        config = load('relative_map.launch', 'odometry:=/odom', 'twist:=/can', 'paths:=a, b', 'base_frame:=rear')
        self.assertEqual(command(node(config, 'relative_map_adapters')),
                         ('nodelet', 'nodelet', 'load', 'relative_map/AdaptersNodelet', 'relative_map_manager'))
        params = {key[len('/relative_map_adapters/'):]: param.value for key, param in config.params.items()
                  if key.startswith('/relative_map_adapters/')}
        self.assertEqual((params['odometry'], params['twist'], params['paths'], params['base_frame']),
                         ('/odom', '/can', ['a', 'b'], 'rear'))
        for argument in ('tf_localization:=true', 'paths:=a', 'left_marker_path:=a', 'lane_paths:=true'):
            config = load('relative_map.launch', argument, 'nodelet:=false', 'name:=mapper')
            self.assertEqual(command(node(config, 'mapper_adapters')), ('relative_map', 'relative_map_adapters'))

    def test_two_cars_share_a_manager_or_have_one_each(self):
        one = load('two_cars.launch')
        self.assertEqual(sorted(n.namespace + n.name for n in one.nodes if n.package == 'nodelet'),
                         ['/car1/relative_map', '/car2/relative_map', '/two_cars_manager'])
        each = load('two_cars.launch', 'one_manager:=false')
        self.assertEqual(sorted(n.namespace + n.name for n in each.nodes if n.package == 'nodelet'),
                         ['/car%d/relative_map%s' % (i, suffix) for i in (1, 2) for suffix in ('', '_manager')])
        self.assertEqual(each.params['/car2/relative_map/base_frame'].value, 'car2/base_link')

    def test_manager_names_a_running_one(self):
        config = load('relative_map.launch', 'manager:=/car/manager')
        self.assertEqual([command(node) for node in config.nodes],
                         [('nodelet', 'nodelet', 'load', 'relative_map/RelativeMapNodelet', '/car/manager')])

    def test_nodelet_false_is_a_node(self):
        config = load('relative_map.launch', 'nodelet:=false')
        self.assertEqual([(node.name, node.package, node.type) for node in config.nodes],
                         [('relative_map', 'relative_map', 'relative_map_node')])
        self.assertIn('/relative_map/map_param/default_left_width', config.params)

    def test_name_is_the_nodes_and_its_parameters(self):
        for nodelet in ('true', 'false'):
            config = load('relative_map.launch', 'name:=mapper', 'nodelet:=' + nodelet)
            self.assertIsNotNone(node(config, 'mapper'))
            self.assertIsNone(node(config, 'relative_map'))
            self.assertIn('/mapper/map_param/default_left_width', config.params)

    def test_rate_takes_the_place_of_the_files(self):
        for nodelet in ('true', 'false'):
            params = load('relative_map.launch', 'rate:=50', 'nodelet:=' + nodelet).params
            self.assertEqual(params['/relative_map/rate'].value, 50)

    def test_config_names_another_file(self):
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write('rate: 25.0\n')
            file.flush()
            params = load('relative_map.launch', 'config:=' + file.name).params
        self.assertEqual({key: param.value for key, param in params.items() if key.startswith('/relative_map/')},
                         {'/relative_map/rate': 25.0})

    def test_rviz_is_shown_only_when_asked_for(self):
        for name in ('relative_map.launch', 'demo.launch'):
            arguments = NEEDED_ARGUMENTS.get(name, [])
            self.assertIsNone(node(load(name, *arguments), 'rviz'), name)
            rviz = node(load(name, 'rviz:=true', *arguments), 'rviz')
            self.assertEqual((rviz.package, rviz.type), ('rviz', 'rviz'))
            view = rviz.args.split()[-1]
            self.assertTrue(os.path.exists(view), view)

    def test_the_demo_hands_its_arguments_on(self):
        config = load('demo.launch', 'nodelet:=false', 'rate:=20', 'max_speed:=7', *NEEDED_ARGUMENTS['demo.launch'])
        self.assertEqual(config.params['/relative_map/rate'].value, 20)
        self.assertEqual(config.params['/vehicle_simulator/max_speed'].value, 7)
        self.assertEqual(config.params['/vehicle_simulator/navigation_lines'].value, 'a.smoothed b.smoothed')
        self.assertEqual(node(config, 'relative_map').type, 'relative_map_node')
        self.assertNotIn('/vehicle_simulator/errors/drift', config.params)
        self.assertIn('<robot name="sample_car">', config.params['/robot_description'].value)

    def test_the_demo_drives_on_sensors_if_asked(self):
        config = load('demo.launch', 'sensors:=true', *NEEDED_ARGUMENTS['demo.launch'])
        nodes = {node.name: node for node in config.nodes}
        self.assertIn('sensor_simulator', nodes)
        self.assertIn('localizer', nodes)
        # Nothing but the localizer says where the vehicle is.
        self.assertIn(('localization', 'vehicle_simulator/localization'),
                      [(a.strip('/'), b.strip('/')) for a, b in nodes['vehicle_simulator'].remap_args])
        values = {name: parameter.value for name, parameter in config.params.items()}
        self.assertIs(values['/vehicle_simulator/publish_tf'], False)
        self.assertEqual(values['/localizer/projection'], values['/sensor_simulator/projection'])

    def test_the_simulated_sensors_sit_where_the_car_has_them(self):
        config = load('demo.launch', 'sensors:=true', *NEEDED_ARGUMENTS['demo.launch'])
        values = {name: parameter.value for name, parameter in config.params.items()}
        joints = re.findall(r'<joint name="(imu|gnss)_joint".*?xyz="([^"]+)"', values['/robot_description'], re.S)
        places = {name: [float(x) for x in place.split()] for name, place in joints}
        for link, group in (('imu', 'imu'), ('gnss', 'receiver')):
            self.assertEqual(places[link], [values['/sensor_simulator/%s/%s' % (group, axis)] for axis in 'xyz'])

    def test_the_demo_drives_with_errors_if_asked(self):
        config = load('demo.launch', 'errors:=true', *NEEDED_ARGUMENTS['demo.launch'])
        self.assertEqual(config.params['/vehicle_simulator/errors/localization_bias'].value, 0.3)
        self.assertEqual(config.params['/vehicle_simulator/noise/yaw_rate'].value, 0.003)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'launch_files', LaunchFiles)
