#!/usr/bin/env python3
"""What a slip of the hand must not destroy, and what no reader may wait for."""

import os
import subprocess

import roslib.packages
import rosbag
import rospy
import rostest
from std_msgs.msg import String

from navigation_line_support import START, ToolTest, drive, fixes, odometry, smoothed, straight


class NavigationLineSafety(ToolTest):
    def setUp(self):
        super().setUp()
        self.write('good.smoothed', smoothed(straight(50.0)))

    def run_other(self, tool, *words):
        program = roslib.packages.find_node('relative_map', tool)[0]
        return subprocess.run([program] + list(words), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=60)

    def expect_kept(self, run, *texts):
        self.assertNotEqual(run.returncode, 0, run.stdout)
        for text in texts:
            self.assertIn(text, run.stderr)

    def test_a_forgotten_output_replaces_no_recording(self):
        self.record('drive_1.bag', drive('/pose', odometry))
        self.record('drive_2.bag', drive('/pose', odometry))
        self.expect_fault('record', 'drive_1.bag', 'drive_2.bag',
                          says=('cannot write drive_2.bag: a bag is there that holds /pose (nav_msgs/Odometry)',))
        self.expect_fault('convert', 'good.smoothed', 'drive_2.bag', says=('holds /pose',))
        before = self.contents()
        self.expect_kept(self.run_other('replay', 'drive_1.bag', 'drive_2.bag'), 'cannot write drive_2.bag', 'holds /pose')
        self.expect_kept(self.run_other('hand_drive', 'good.smoothed', 'drive_2.bag', '--utm', '32N'), 'holds /pose')
        self.assertEqual(self.contents(), before)

    def test_a_bag_that_a_node_was_recorded_to_is_no_output(self):
        header = dict(callerid='/gps', topic='/fix', type='sensor_msgs/NavSatFix')
        with rosbag.Bag(self.path('fix.bag'), 'w') as bag:
            for topic, message, stamp in fixes(count=5):
                header.update(md5sum=message._md5sum, message_definition=message._full_text)
                bag.write(topic, message, stamp, connection_header=header)
        before = self.contents()
        self.expect_kept(self.run_other('hand_drive', 'good.smoothed', 'fix.bag', '--utm', '32N'), 'recorded from /gps')
        self.assertEqual(self.contents(), before)
        self.record('cut.bag', drive('/pose', odometry))
        os.truncate(self.path('cut.bag'), 20000)
        self.expect_fault('convert', 'good.smoothed', 'cut.bag', says=('was cut off, or is still recorded to',))

    def test_what_a_tool_made_it_makes_anew(self):
        for _ in range(2):
            self.expect('convert', 'good.smoothed', 'line.bag')
            self.expect('convert', 'line.bag', 'again.smoothed')
        self.record('line.bag', [('/chatter', String('hello'), START)])
        self.expect_fault('convert', 'good.smoothed', 'line.bag', says=('holds /chatter',))

    def test_an_input_is_no_output(self):
        os.symlink('good.smoothed', self.path('link.smoothed'))
        for output in ('good.smoothed', './good.smoothed', 'link.smoothed'):
            self.expect_fault('reverse', 'good.smoothed', output, says=('it is read from as good.smoothed',))
            self.expect_fault('smooth', 'good.smoothed', output, says=('it is read from',))
            self.expect_fault('join', 'good.smoothed', 'good.smoothed', output, says=('it is read from',))
        self.record('line.smoothed', drive('/pose', odometry))  # a bag by another name
        self.expect_fault('record', 'line.smoothed', 'line.smoothed', says=('it is read from',))

    def test_the_last_of_many_files_is_not_replaced_unless_it_is_said(self):
        for name, start in (('a', 0.0), ('b', 50.0), ('c', 100.0)):
            self.write(name + '.smoothed', smoothed(straight(50.0, start=start)))
        self.expect_fault('join', 'a.smoothed', 'b.smoothed', 'c.smoothed', says=('c.smoothed, exists', '--replace'), code=2)
        self.expect('join', 'a.smoothed', 'b.smoothed', 'c.smoothed', '--replace')

    def test_no_reader_waits_for_a_pipe_or_reads_a_device_without_end(self):
        os.mkfifo(self.path('pipe.smoothed'))
        os.mkfifo(self.path('pipe.bag'))
        for name in ('pipe.smoothed', '/dev/zero'):
            for command in (('convert', name, 'out.csv', '--from=smoothed'), ('convert', name, 'out.csv', '--from=gpx'),
                            ('publish', name)):
                if name == '/dev/zero' and command[0] == 'publish':
                    continue  # its format is not known
                self.expect_fault(*command, says=(name + ': is a pipe, a device',))
        for command in (('record', 'pipe.bag', 'out.smoothed'), ('convert', 'pipe.bag', 'out.smoothed')):
            self.expect_fault(*command, says=('pipe.bag: not a readable bag: it is a pipe',))
        self.expect_kept(self.run_other('replay', 'pipe.bag', 'out.bag'), 'it is a pipe')
        self.expect_kept(self.run_other('check_maps', 'pipe.bag'), 'it is a pipe')
        self.record('in.bag', drive('/pose', odometry))
        for option in ('--config', '--urdf'):
            self.expect_kept(self.run_other('replay', 'in.bag', 'out.bag', option + '=pipe.smoothed'), 'is a pipe')
        run = self.run_tool('check', 'pipe.smoothed', 'good.smoothed')
        self.assertIn('good.smoothed: fit', run.stdout)

    def test_check_goes_on_past_a_bad_file_and_names_it(self):
        self.write('alike.smoothed', smoothed([(1.0, 2.0)] * 50))
        self.write('one.smoothed', smoothed([(1.0, 2.0)]))
        self.write('broken.smoothed', '{"x": 1')
        run = self.run_tool('check', 'alike.smoothed', 'one.smoothed', 'broken.smoothed', 'absent.smoothed', 'good.smoothed')
        self.assertEqual(run.returncode, 1)
        for text in ('alike.smoothed: short at point 0', 'one.smoothed: short', 'broken.smoothed, line 1: not valid JSON',
                     'absent.smoothed: cannot be opened', 'good.smoothed: fit to be driven on'):
            self.assertIn(text, run.stdout)
        self.expect_fault('join', 'good.smoothed', 'alike.smoothed', 'new.smoothed', says=('alike.smoothed: ',))

    def test_headers_that_know_only_a_part_are_taken_together(self):
        header = '{"header": {%s}}\n'
        self.write('frame.smoothed', header % '"frame_id": "map"' + smoothed(straight(50.0)))
        for zone in (32, 33):
            self.write('utm_%d.smoothed' % zone, header % ('"projection": "utm", "zone": %d, "north": true' % zone) +
                       smoothed(straight(50.0, start=50.0 * (zone - 31))))
        says = ('UTM zone 32N', 'UTM zone 33N')
        self.expect_fault('join', 'frame.smoothed', 'utm_32.smoothed', 'utm_33.smoothed', 'out.smoothed', says=says)
        self.expect_fault('publish', 'frame.smoothed', 'utm_32.smoothed', 'utm_33.smoothed', says=says)
        run = self.run_tool('check', 'frame.smoothed', 'utm_32.smoothed', 'utm_33.smoothed')
        self.assertIn('utm_33.smoothed: zone: it does not fit to frame.smoothed', run.stdout)

    def test_notes_of_a_reader_are_told(self):
        self.write('in.csv', 'time,lat,lon\n1,48.1,11.5\n2,0,0\n3,48.1,11.501\n')
        run = self.run_tool('convert', 'in.csv', 'out.smoothed')
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn('in.csv: these columns are left out: time\n', run.stderr)
        self.assertIn('in.csv: 1 points at longitude 0, latitude 0 are left out', run.stderr)

    def test_options_may_have_their_value_behind_a_sign(self):
        self.expect('offset', 'good.smoothed', 'left.smoothed', '--distance=-3.5')
        self.expect('offset', '--distance', '-3.5', 'good.smoothed', 'right.smoothed')
        self.assertEqual(self.points('left.smoothed'), self.points('right.smoothed'))
        os.rename(self.path('good.smoothed'), self.path('-odd.smoothed'))
        self.expect('reverse', '--', '-odd.smoothed', 'back.smoothed')
        for words, text in ((('--distance=1', '--distance=2'), 'given more than once'), (('--dist=1',), 'unknown option --dist'),
                            (('--distance=',), '--distance')):
            self.expect_fault('offset', 'left.smoothed', 'out.smoothed', *words, says=(text,), code=2)
        self.expect_fault('convert', 'left.smoothed', 'out.csv', '--lonlat=yes', says=('--lonlat takes no value',), code=2)
        run = self.run_other('make_road', '--out=road', '--lanes=2', '--origin', '-5', '10', '-0.5')
        self.assertEqual(run.returncode, 0, run.stderr)
        run = self.run_other('make_road', '--out=road', '--origin', '1', '2')
        self.assertIn('--origin needs 3 numbers, and has 2', run.stderr)

    def test_first_day_leaves_what_it_did_not_make(self):
        package = roslib.packages.get_pkg_dir('relative_map')
        setup = os.path.join(os.environ['CMAKE_PREFIX_PATH'].split(':')[0], 'setup.bash')
        os.mkdir(self.path('day'))
        for name in ('drive.bag', 'mine.bag', 'notes.smoothed', 'other.log'):
            self.write('day/' + name, 'precious\n')
        call = [os.path.join(package, 'scripts/first_day'), '--out=' + self.path('day'), '--setup', setup]
        run = subprocess.run(call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=60)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn('drive.bag, which no first day made', run.stderr)
        for name in ('drive.bag', 'mine.bag', 'notes.smoothed', 'other.log'):
            self.assertEqual(self.read('day/' + name), 'precious\n')


if __name__ == '__main__':
    rospy.rostime.set_rostime_initialized(True)
    rostest.rosrun('relative_map', 'navigation_line_safety', NavigationLineSafety)
