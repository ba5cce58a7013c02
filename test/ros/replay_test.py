#!/usr/bin/env python3
"""What replay makes of a drive: the maps of the node, at fixed times, the same ones each time."""

import filecmp

import rosbag
import rospy
import rostest
from relative_map.msg import FusionState, MapStatus
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

import vehicle_messages as messages
from replay_support import CAMERA, START, TICKS, ReplayTest, Run, drive, tick_times, transforms

WIDE_TRUCK = """<robot name="truck"><link name="base_link"><collision><origin xyz="3 0 1"/>
<geometry><box size="8 3.6 2"/></geometry></collision></link></robot>"""


class Replay(ReplayTest):
    def test_maps_of_a_drive(self):
        self.record()
        run = self.replay()
        maps = self.maps()
        self.assertEqual(list(maps), tick_times())
        for time, head in maps.items():
            # A localization every 10 ms: the newest one is the tick's own.
            self.assertEqual((head.stamp, head.frame_id, head.code), (time, 'base_link', MapStatus.OK))
        for map in (maps[START].whole(), head.whole()):
            self.assertEqual(len(map.hdmap.lane), 3)
            self.assertEqual(map.fusion.source, FusionState.FUSED)
            self.assertEqual(map.fusion.method, 'estimator')
            self.assertAlmostEqual(map.fusion.lateral_offset, 0.2, delta=0.02)
        self.expect_contract()
        self.assertIn('16 maps, 0 of them empty', run.output)
        self.assertEqual(run.errors, '')

    def test_a_vehicle_in_a_namespace(self):
        self.record()
        self.replay('in.bag', 'plain.bag')
        for recorded in ('/car1', 'car1'):
            self.record('car.bag', [(recorded + topic, message, time) for topic, message, time in drive()])
            self.replay('car.bag', 'out.bag', '--namespace', 'car1')
            self.expect_same_maps('plain.bag', 'out.bag', '/car1/relative_map')
        self.replay('in.bag', 'root.bag', '--namespace', '/')
        self.expect_same_maps('plain.bag', 'root.bag', '/relative_map')

    def test_topics_are_remapped_as_for_the_node(self):
        names = {'/localization': '/ins/pose', '/chassis': '/can/chassis'}
        self.record('other.bag', [(names.get(topic, topic), message, time) for topic, message, time in drive()])
        self.record()
        self.replay('in.bag', 'plain.bag')
        self.replay('other.bag', 'out.bag', 'localization:=/ins/pose', '/chassis:=can/chassis', 'relative_map:=/maps')
        self.expect_same_maps('plain.bag', 'out.bag', '/maps')
        run = Run(['other.bag', 'new.bag', 'localisation:=/ins/pose'], self.folder)
        self.assertNotEqual(run.code, 0)
        self.assertIn('localisation:=/ins/pose remaps nothing', run.errors)

    def test_the_parts_of_a_split_recording_are_one_drive(self):
        entries = list(drive())
        self.record('in.bag', entries)
        parts = [entries[:300], entries[300:600], entries[600:]]  # the lines, which are latched, are in the first one
        for number, part in enumerate(parts):
            self.record('part_%d.bag' % number, part)
        self.replay('in.bag', 'plain.bag')
        self.replay('part_0.bag', 'part_1.bag', 'part_2.bag', 'out.bag')
        self.assertTrue(filecmp.cmp(self.path('plain.bag'), self.path('out.bag'), shallow=False))
        self.replay('part_2.bag', 'part_0.bag', 'part_1.bag', 'out.bag')
        self.assertTrue(filecmp.cmp(self.path('plain.bag'), self.path('out.bag'), shallow=False))

    def camera_drive(self, topic, transform_at):
        """A drive whose camera's place comes on `topic` each 0.1 s, from 2 s before the first message on."""
        for step in range(-20, TICKS + 10):
            stamp = START + rospy.Duration(0, 100000000) * step if step >= 0 else START - rospy.Duration(
                0, 100000000) * -step
            transform = transform_at(step)
            transform.header.stamp = stamp
            yield topic, TFMessage([transform]), stamp
        yield from drive(marker_frame='camera_link')

    def test_a_link_that_stands_still_on_tf_is_as_good_as_static(self):
        def stands(step):
            return messages.static_transform('camera_link', 1.8, 1.3)

        self.record('static.bag', self.camera_drive('/tf_static', stands))
        self.record('tf.bag', self.camera_drive('/tf', stands))
        self.replay('static.bag', 'plain.bag')
        self.replay('tf.bag', 'out.bag')
        self.assertEqual(list(self.maps('out.bag')), tick_times(), 'transforms alone make no maps')
        self.expect_same_maps('plain.bag', 'out.bag', '/relative_map')
        self.assertEqual(self.maps('out.bag')[tick_times()[-1]].whole().fusion.source, FusionState.FUSED)

    def test_a_link_that_moves_on_tf_is_none(self):
        self.record('in.bag', self.camera_drive('/tf', lambda step: messages.static_transform(
            'camera_link', 1.8 + 0.05 * step, 1.3)))
        self.replay()
        last = self.maps()[tick_times()[-1]].whole()
        self.assertEqual(last.fusion.source, FusionState.NAVIGATION_LINE)
        self.assertIn("no transform from 'camera_link'", last.status.message)

    def expect_same_maps(self, one, other, topic):
        """The same maps at the same times, those of `other` on `topic`."""
        with rosbag.Bag(self.path(one)) as a, rosbag.Bag(self.path(other)) as b:
            plain = [(time, raw[1]) for _, raw, time in a.read_messages(raw=True)]
            others = [(time, raw[1]) for name, raw, time in b.read_messages(raw=True) if name == topic]
        self.assertEqual(len(plain), TICKS)
        self.assertTrue(plain == others, topic)

    def test_two_runs_write_the_same_bytes(self):
        self.record()
        self.replay('in.bag', 'one.bag')
        self.replay('in.bag', 'two.bag')
        self.assertTrue(filecmp.cmp(self.path('one.bag'), self.path('two.bag'), shallow=False))

    def test_the_order_in_the_file_does_not_matter(self):
        entries = list(drive())
        middle = next(i for i, entry in enumerate(entries) if entry[2] > START + rospy.Duration(1))
        self.record('in.bag', entries)
        self.record('other.bag', entries[middle:] + entries[:middle], compression='bz2')
        self.replay('in.bag', 'one.bag')
        self.replay('other.bag', 'two.bag')
        self.assertTrue(filecmp.cmp(self.path('one.bag'), self.path('two.bag'), shallow=False))

    def test_ticks_start_with_the_first_message(self):
        late = START + rospy.Duration(1, 234)
        self.record(entries=[(topic, message, time) for topic, message, time in drive()
                             if topic == '/navigation' or time > late])
        self.replay()
        maps = self.maps()
        self.assertEqual(list(maps), tick_times())
        self.assertEqual([head.code for head in maps.values()], [MapStatus.NO_LOCALIZATION] * 11 + [MapStatus.OK] * 5)

    def test_markers_of_a_camera_need_its_transform(self):
        self.record(entries=drive('camera_link'))
        self.replay()
        for head in self.maps().values():
            self.assertEqual(head.code, MapStatus.OK)
            self.assertIn('camera_link', head.text)
        self.assertEqual(head.whole().fusion.source, FusionState.NAVIGATION_LINE)
        # A static transform holds from the beginning, whenever it was recorded.
        self.record(entries=list(drive('camera_link')) + [transforms(CAMERA)])
        self.replay()
        for head in self.maps().values():
            self.assertNotIn('camera_link', head.text)
        self.assertEqual(self.maps()[START].whole().fusion.source, FusionState.FUSED)

    def test_the_configuration_is_used(self):
        self.record()
        self.write('config.yaml', 'rate: 20\nmap_param: {default_speed_limit: 13.0}\n')
        self.replay('in.bag', 'out.bag', '--config', 'config.yaml')
        maps = self.maps()
        self.assertEqual(list(maps), tick_times(2 * TICKS - 1, 20))
        self.assertEqual([lane.speed_limit for lane in maps[START].whole().hdmap.lane], [13.0] * 3)

    def test_the_lines_of_the_configuration_are_used(self):
        for name, y in (('middle', 0.0), ('left', 3.5)):
            self.write(name + '.smoothed', ''.join('{"x": %d, "y": %.1f}\n' % (x, y) for x in range(400)))
        self.write('config.yaml', 'navigation_lines: [%s, %s]\n' % (self.path('middle.smoothed'), self.path('left.smoothed')))
        self.record(entries=[entry for entry in drive() if entry[0] != '/navigation'])
        self.replay('in.bag', 'out.bag', '--config', 'config.yaml')
        for head in self.maps().values():
            self.assertEqual(head.code, MapStatus.OK)
        self.assertEqual([lane.id.split('/')[0] for lane in head.whole().hdmap.lane], ['left', 'middle'])
        self.expect_contract()
        # The bag's own take their place, as on the node.
        self.record()
        self.replay('in.bag', 'out.bag', '--config', 'config.yaml')
        self.assertEqual(len(self.maps()[tick_times()[-1]].whole().hdmap.lane), 3)

    def test_the_urdf_is_used(self):
        self.record()
        self.write('truck.urdf', WIDE_TRUCK)
        self.replay('--urdf', 'truck.urdf', 'in.bag', 'out.bag')
        map = self.maps()[START].whole()  # 3.6 m of truck do not fit between lines that are 3.5 m apart
        self.assertEqual(map.status.code, MapStatus.OK)
        self.assertIn(len(map.hdmap.lane), (1, 2))

    def test_messages_of_another_type_are_named_once_and_passed_over(self):
        entries = [entry for entry in drive() if entry[0] != '/chassis']
        self.record(entries=entries + [('/chassis', String('fast'), START + rospy.Duration(1))] * 3)
        run = self.replay()
        self.assertEqual(run.errors.count('/chassis has type std_msgs/String'), 1)
        self.assertEqual({head.code for head in self.maps().values()}, {MapStatus.OK})

    def test_lines_of_no_use_are_named(self):
        entries = [entry for entry in drive() if entry[0] != '/navigation']
        short = messages.navigation(messages.navigation_path('short', 0, [(0.0, 0.0)]))
        self.record(entries=entries + [('/navigation', short, START)])
        self.assertIn('short', self.replay().errors)

    def test_an_existing_output_is_replaced(self):
        self.record()
        self.write('out.bag', 'old')
        self.replay()
        self.assertEqual(list(self.maps()), tick_times())

    def test_years_without_input_get_no_maps(self):
        gap = rospy.Duration(2000000000)  # 63 years: a clock that was set while the bag was recorded
        self.record(entries=list(drive()) + [('/chassis', messages.chassis(START + gap), START + gap)])
        run = self.replay()
        times = list(self.maps())
        self.assertEqual(times[:TICKS], tick_times())
        self.assertAlmostEqual((times[-1] - START).to_sec(), gap.to_sec(), delta=0.1)
        self.assertLess(len(times), TICKS + 10 * 60 + 3, 'maps of a minute, and of the message after it')
        self.assertGreater(len(times), TICKS + 10 * 60 - 6)  # a pose that was mapped is not mapped again
        self.assertRegex(run.errors, 'no input for 199999999[89] s')  # half a second more than the one

    def test_help(self):
        run = self.replay('--help')
        self.assertIn('usage: rosrun relative_map replay IN.bag... OUT.bag [--config FILE] [--urdf FILE]', run.output)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'replay', Replay)
