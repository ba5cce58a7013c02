#!/usr/bin/env python3
"""Bad input to `navigation_line`: one sentence, an exit code that is not 0, and no file harmed."""

import os
import re
import stat
import subprocess

import other_user
import rospy
import rostest
from std_msgs.msg import String

from navigation_line_support import (START, ToolTest, drive, fix, fixes, localization, odometry, smoothed, straight, way)


class NavigationLineFaults(ToolTest):
    def setUp(self):
        super().setUp()
        self.write('old.smoothed', 'precious\n')
        self.write('good.smoothed', smoothed(straight(50.0)))

    def record_fault(self, entries, *says, options=()):
        self.record('in.bag', entries)
        self.expect_fault('record', 'in.bag', 'old.smoothed', *options, says=('in.bag',) + says)

    def test_words_that_make_no_sense(self):
        for words, text in ((('smoth',), "no subcommand 'smoth'"), ((), 'a subcommand is needed'),
                            (('smooth', 'good.smoothed'), 'IN and OUT must be named'),
                            (('smooth', 'a', 'b', 'c'), "unexpected argument 'c'"),
                            (('smooth', 'good.smoothed', 'old.smoothed', '--bond', '1'), 'unknown option --bond'),
                            (('smooth', 'good.smoothed', 'old.smoothed', '--bound'), '--bound needs a value'),
                            (('smooth', 'good.smoothed', 'old.smoothed', '--bound', 'x'), "must be a number, not 'x'"),
                            (('smooth', 'good.smoothed', 'old.smoothed', '--bound', '-1'), '--bound is -1'),
                            (('convert', 'good.smoothed', 'old.dat'), 'its format is not known'),
                            (('convert', 'good.smoothed', 'old.dat', '--to', 'kml'), "'kml' is no format"),
                            (('convert', 'good.smoothed', 'a.gpx', '--utm', '61N'), "'61N' is no UTM zone"),
                            (('resample', 'good.smoothed', 'old.smoothed'), '--spacing or --by-curvature'),
                            (('offset', 'good.smoothed', 'old.smoothed'), '--distance is missing')):
            self.expect_fault(*words, says=(text,), code=2)

    def test_a_file_that_is_absent_empty_or_a_folder(self):
        os.mkdir(self.path('folder.smoothed'))
        self.write('empty.smoothed', '')
        for command in ('smooth', 'reverse', 'close', 'convert'):
            self.expect_fault(command, 'absent.smoothed', 'old.smoothed', says=('absent.smoothed: cannot be opened',))
            self.expect_fault(command, 'empty.smoothed', 'old.smoothed', says=('empty.smoothed: has no points',))
            self.expect_fault(command, 'folder.smoothed', 'old.smoothed', says=('is a folder',))
        for name in ('empty.csv', 'empty.gpx', 'empty.geojson', 'empty.json'):
            self.write(name, '')
            self.expect_fault('convert', name, 'old.smoothed', says=(name + ': has no points',))
        self.write('empty.bag', '')
        for command in ('convert', 'record'):
            self.expect_fault(command, 'empty.bag', 'old.smoothed', says=('empty.bag: not a readable bag: it is empty',))

    def test_a_truncated_file(self):
        text = self.read('good.smoothed')
        self.write('cut.smoothed', text[:len(text) - 10])
        self.expect_fault('smooth', 'cut.smoothed', 'old.smoothed', says=('cut.smoothed, line 101: not valid JSON',))
        self.record('in.bag', drive('/pose', odometry))
        size = os.path.getsize(self.path('in.bag'))
        for share in (0.001, 0.5, 0.99):
            with open(self.path('in.bag'), 'r+b') as file:
                file.truncate(int(size * share))
            self.expect_fault('record', 'in.bag', 'old.smoothed', says=('in.bag: not a readable bag: it was cut off',))

    def test_not_a_number(self):
        self.write('nan.smoothed', '{"x": 1.0, "y": 2.0}\n{"x": NaN, "y": 2.0}\n')
        self.expect_fault('smooth', 'nan.smoothed', 'old.smoothed', says=('nan.smoothed, line 2',))
        self.write('nan.csv', 'x,y\n1,2\n2,nan\n')
        self.expect_fault('convert', 'nan.csv', 'old.smoothed', says=('nan.csv, line 3', 'not finite'))
        entries = list(drive('/pose', odometry))
        entries[100][1].pose.pose.position.x = float('nan')
        self.record_fault(entries, 'pose 100', 'not finite')

    def test_mixed_separators(self):
        self.write('in.csv', 'x,y\n1,2\n3;4\n')
        self.expect_fault('convert', 'in.csv', 'old.smoothed', says=('in.csv, line 3', "';' stands between them"))

    def test_longitude_and_latitude_swapped(self):
        self.write('in.csv', 'lon,lat\n39.9,116.3\n39.9,116.301\n')
        self.expect_fault('convert', 'in.csv', 'old.smoothed', says=('are longitude and latitude swapped?',))
        self.record_fault(fixes(latitude=116.3, longitude=39.9), 'are longitude and latitude swapped?')
        self.record_fault(fixes(latitude=11.5, longitude=48.1), 'swapped', options=('--utm', '32N'))

    def test_a_change_of_zone(self):
        self.record_fault(fixes(longitude=11.999), 'UTM zone 33N', 'UTM zone 32N')
        entries = list(drive('/pose', odometry))
        for _, message, _ in entries[150:]:
            message.pose.pose.position.x -= 400000.0
        self.record_fault(entries, 'the position jumps by', 'zone')
        line = smoothed(straight(50.0, y=10.0, start=690000.0))
        self.write('a.smoothed', '{"header": {"projection": "utm", "zone": 50, "north": true}}\n' + line)
        self.write('b.smoothed', '{"header": {"projection": "utm", "zone": 51, "north": true}}\n' + line)
        self.expect_fault('join', 'a.smoothed', 'b.smoothed', 'old.smoothed', says=('UTM zone 50N', 'UTM zone 51N'))
        self.expect_fault('publish', 'a.smoothed', 'b.smoothed', says=('UTM zone 50N', 'UTM zone 51N'))
        self.expect_fault('convert', 'a.smoothed', 'old.gpx', '--utm', '51N', says=('says otherwise',))

    def test_a_bag_without_the_topic(self):
        self.record_fault([('/chatter', String('hello'), START)], 'has no topic of', '/chatter (std_msgs/String)')
        self.record_fault(drive('/pose', odometry), 'has no topic /nose; it has /pose', options=('--topic', '/nose'))
        two = list(drive('/a', odometry)) + list(drive('/b', localization))
        self.record_fault(two, '--topic', '/a (nav_msgs/Odometry), /b')
        self.record_fault([], 'it has nothing')
        self.expect_fault('convert', 'in.bag', 'old.smoothed', says=('has no topic of nav_msgs/Path',))

    def test_a_drive_that_makes_no_line(self):
        self.record_fault(((('/pose', odometry(START + rospy.Duration(i / 10.0), 1.0, 2.0), START) for i in range(50))),
                          'has not moved forward')
        self.record_fault(((('/fix', fix(START, 48.0, 11.0, status=-1), START) for _ in range(5))),
                          'none of its 5 messages has a fix')
        entries = list(drive('/pose', odometry))
        entries[100][1].header.frame_id = 'odom'
        self.record_fault(entries, "change from frame 'map' to 'odom'")

    def test_an_output_that_cannot_be_written(self):
        os.mkdir(self.path('folder.smoothed'))
        for target, why in (('folder.smoothed', 'Is a directory'), ('absent/line.smoothed', 'No such file'),
                            ('good.smoothed/line.smoothed', 'Not a directory'), ('/proc/line.smoothed', '')):
            self.expect_fault('reverse', 'good.smoothed', target, says=('cannot write ' + target, why))
        self.expect_fault('convert', 'good.smoothed', '/proc/line.bag', says=('cannot write /proc/line.bag',))

    def test_no_permission(self):
        options = other_user.options(self)
        self.record('in.bag', drive('/pose', odometry))
        os.chmod(self.path('old.smoothed'), 0o444)
        for command in (('record', 'in.bag'), ('smooth', 'good.smoothed'), ('convert', 'good.smoothed'),
                        ('offset', 'good.smoothed', '--distance', '3.5')):
            for target in ('old.smoothed', 'new.smoothed', 'new.bag'):
                if target == 'new.smoothed':
                    os.chmod(self.folder, 0o555)
                self.expect_fault(*command, target, says=('cannot write %s: Permission denied' % target,), **options)
            os.chmod(self.folder, 0o755)
        os.chmod(self.path('good.smoothed'), 0)
        for command in (('reverse', 'good.smoothed', 'old.csv'), ('publish', 'good.smoothed')):
            os.chmod(self.folder, 0o777)
            self.expect_fault(*command, says=('good.smoothed: cannot be opened: Permission denied',), **options)
        os.chmod(self.path('in.bag'), 0)
        self.expect_fault('record', 'in.bag', 'new.smoothed', says=('in.bag: not a readable bag: Permission denied',), **options)

    def test_a_full_disk(self):
        for form in ('smoothed', 'one-line', 'csv'):
            self.expect_fault('convert', 'good.smoothed', '/dev/full', '--to', form,
                              says=('cannot write /dev/full', 'No space left on device'))
        # A bag can't be written there, and must not take its place.
        self.expect_fault('convert', 'good.smoothed', '/dev/full', '--to', 'bag', says=('cannot write /dev/full', 'device'))
        self.assertTrue(stat.S_ISCHR(os.stat('/dev/full').st_mode))

    def test_a_full_disk_of_its_own(self):
        os.mkdir(self.path('disk'))
        mount = ['mount', '-t', 'tmpfs', '-o', 'size=64k', 'tmpfs', self.path('disk')]
        if subprocess.run(mount, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest('mounting a disk is not allowed here')
        self.addCleanup(subprocess.run, ['umount', self.path('disk')])
        self.write('disk/old.smoothed', 'precious\n')
        self.write('long.smoothed', smoothed(straight(2000.0)))
        for name in ('old.smoothed', 'new.csv', 'new.bag'):
            self.expect_fault('convert', 'long.smoothed', 'disk/' + name, says=('cannot write disk/' + name,))
            self.assertEqual(os.listdir(self.path('disk')), ['old.smoothed'])
        self.assertEqual(self.read('disk/old.smoothed'), 'precious\n')

    def test_a_bound_that_cannot_be_held(self):
        points = straight(100.0)
        self.write('step.smoothed', smoothed(points[:100] + [(x, y + 2.0) for x, y in points[100:]]))
        run = self.run_tool('smooth', 'step.smoothed', 'old.smoothed')
        self.expect_fault('smooth', 'step.smoothed', 'old.smoothed', says=('cannot be held at s = ',))
        advice = re.search(r'; (--bound [0-9.]+ --follow [0-9.]+) would do\n$', run.stderr)
        self.assertTrue(advice, run.stderr)
        self.expect('smooth', 'step.smoothed', 'new.smoothed', *advice.group(1).split())
        self.write('arc.smoothed', smoothed([way(step) for step in range(300)]))
        self.expect_fault('smooth', 'arc.smoothed', 'old.smoothed', '--max-curvature', '0.001',
                          says=('cannot be held at s = ', 'would have to bend by 0.01 1/m', 'nor is any bound'))

    def test_an_output_that_cannot_be_written_is_refused_before_the_work(self):
        self.write('bad.smoothed', 'no line\n')
        for command in (('record', 'bad.smoothed'), ('smooth', 'bad.smoothed'), ('close', 'bad.smoothed'),
                        ('convert', 'bad.smoothed'), ('join', 'bad.smoothed', 'bad.smoothed')):
            self.expect_fault(*command, 'absent/line.smoothed', says=('cannot write absent/line.smoothed',))
            self.expect_fault(*command, 'line.dat', says=('its format is not known',), code=2)

    def test_edits_that_cannot_be_done(self):
        self.expect_fault('close', 'good.smoothed', 'old.smoothed', says=('good.smoothed', 'the ends are 50.00 m apart'))
        self.expect_fault('cut', 'good.smoothed', 'old.smoothed', '--from', '60', says=('from s = 0 to 50.00 m',))
        self.expect_fault('convert', 'good.smoothed', 'old.gpx', says=('place on the earth is not known',))


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'navigation_line_faults', NavigationLineFaults)
