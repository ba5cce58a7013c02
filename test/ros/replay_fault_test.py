#!/usr/bin/env python3
"""What replay does with what it can't replay: it says so in one line, and leaves all files as they were."""

import os
import resource
import signal
import stat
import subprocess

import other_user
import rospy
import rostest
from std_msgs.msg import String

import vehicle_messages
from replay_support import START, ReplayTest, Run, drive


class ReplayFaults(ReplayTest):
    def files(self):
        contents = {}
        for name in os.listdir(self.folder):
            if os.path.isfile(self.path(name)):
                with open(self.path(name), 'rb') as file:
                    contents[name] = file.read()
        return contents

    def expect_fault(self, *texts, words=('in.bag', 'out.bag'), code=1, lines=1):
        """Fails with one line that has these texts, with an old out.bag and without one."""
        for old_output in (True, False):
            if old_output:
                self.write('out.bag', 'precious')
            elif os.path.exists(self.path('out.bag')):
                os.remove(self.path('out.bag'))
            before = self.files()
            run = Run(list(words), self.folder)
            self.assertEqual(run.code, code, run.errors)
            self.assertEqual(self.files(), before)
            self.assertEqual(run.output, '')
            self.assertEqual(run.errors.count('\n'), lines, run.errors)
            for text in ('replay: ',) + texts:
                self.assertIn(text, run.errors)

    def expect_usage_fault(self, text, *words):
        run = Run(list(words), self.folder)
        self.assertEqual(run.code, 2)
        self.assertEqual(run.errors.splitlines()[0], 'replay: ' + text)
        self.assertIn('usage: ', run.errors)

    def truncate(self, share):
        with open(self.path('in.bag'), 'r+b') as file:
            file.truncate(int(os.path.getsize(self.path('in.bag')) * share))

    def test_no_bag_at_the_place(self):
        self.expect_fault('in.bag')

    def test_a_folder(self):
        os.mkdir(self.path('in.bag'))
        self.expect_fault('in.bag')

    def test_an_empty_file(self):
        self.write('in.bag', '')
        self.expect_fault('in.bag', 'not a readable bag')

    def test_what_is_no_bag(self):
        self.write('in.bag', 'This is a text.\n' * 1000)
        self.expect_fault('in.bag', 'not a readable bag')

    def test_an_empty_bag(self):
        self.record(entries=[])
        self.expect_fault('in.bag', 'none of the topics')

    def test_a_bag_without_inputs(self):
        self.record(entries=[('/chatter', String('hello'), START)])
        self.expect_fault('in.bag', '/navigation, /localization, /chassis, /perception/lane_markers')

    def test_a_truncated_bag(self):
        for share in (0.0001, 0.1, 0.5, 0.9, 0.999):
            self.record()
            self.truncate(share)
            self.expect_fault('in.bag', 'not a readable bag')

    def test_a_bag_with_a_damaged_chunk(self):
        self.record(compression='bz2')
        with open(self.path('in.bag'), 'r+b') as file:
            file.seek(6000)  # 4 kB of header, then the chunk
            file.write(b'\xff' * 64)
        self.expect_fault('in.bag')

    def test_an_output_that_cannot_be_written(self):
        self.record()
        self.write('file', '')
        os.mkdir(self.path('folder'))
        for target in ('no_folder/maps.bag', 'file/maps.bag', 'folder'):
            self.expect_fault('cannot write ' + target, words=('in.bag', target))
        self.expect_fault('cannot write /dev/full', 'device', words=('in.bag', '/dev/full'))
        self.assertTrue(stat.S_ISCHR(os.stat('/dev/full').st_mode))

    def test_a_file_that_grows_too_large(self):
        self.record()
        self.write('out.bag', 'precious')
        before = self.files()
        run = Run(['in.bag', 'out.bag'], self.folder, restore_signals=False,  # SIGXFSZ stays ignored, as by Python
                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536)))
        self.assertEqual(run.code, 1)
        self.assertEqual(run.errors, "replay: in.bag: can't be replayed: cannot write out.bag: File too large\n")
        self.assertEqual(self.files(), before)

    def test_an_interrupt(self):
        entries = list(drive())
        for step in range(20000):  # half an hour of nothing but speeds: many empty maps
            stamp = START + rospy.Duration(0, 100000000) * (20 + step)
            entries.append(('/chassis', vehicle_messages.chassis(stamp), stamp))
        self.record(entries=entries)
        self.write('out.bag', 'precious')
        before = self.files()
        command = [self.tool(), 'in.bag', 'out.bag']
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while len(self.files()) == len(before):
            self.assertIsNone(process.poll(), 'it ended before it could be interrupted')
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertEqual(self.files(), before)

    def test_a_full_disk(self):
        self.record()
        os.mkdir(self.path('disk'))
        mount = ['mount', '-t', 'tmpfs', '-o', 'size=64k', 'tmpfs', self.path('disk')]
        if subprocess.run(mount, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest('mounting a disk is not allowed here')
        self.addCleanup(subprocess.run, ['umount', self.path('disk')])
        self.write('disk/old.bag', 'precious')
        for name in ('old.bag', 'new.bag'):
            self.expect_fault('cannot write disk/' + name, 'No space left on device', words=('in.bag', 'disk/' + name))
            self.assertEqual(os.listdir(self.path('disk')), ['old.bag'])
        with open(self.path('disk/old.bag')) as file:
            self.assertEqual(file.read(), 'precious')

    def test_no_permission(self):
        options = other_user.options(self)
        self.record()
        self.write('out.bag', 'precious')
        os.chmod(self.path('out.bag'), 0o444)
        before = self.files()
        for target in ('out.bag', 'new.bag'):
            if target == 'new.bag':
                os.chmod(self.folder, 0o555)
            run = Run(['in.bag', target], self.folder, **options)
            self.assertEqual((run.code, run.errors), (1, 'replay: cannot write %s: Permission denied\n' % target))
        os.chmod(self.folder, 0o777)
        self.assertEqual(self.files(), before)
        os.chmod(self.path('in.bag'), 0)
        run = Run(['in.bag', 'new.bag'], self.folder, **options)
        self.assertEqual((run.code, run.errors), (1, 'replay: in.bag: not a readable bag: Permission denied\n'))

    def test_an_output_that_is_the_input(self):
        self.record()
        os.symlink('in.bag', self.path('link.bag'))
        os.link(self.path('in.bag'), self.path('hard_link.bag'))
        before = self.files()
        for target in ('in.bag', './in.bag', self.path('in.bag'), 'link.bag', 'hard_link.bag'):
            self.expect_usage_fault('IN.bag and OUT.bag are the same file', 'in.bag', target)
        self.assertEqual(self.files(), before)

    def test_words_that_make_no_sense(self):
        self.record()
        before = self.files()
        self.expect_usage_fault('two bags are needed: IN.bag and OUT.bag')
        self.expect_usage_fault('two bags are needed: IN.bag and OUT.bag', 'in.bag')
        self.expect_usage_fault('unknown option --rate', 'in.bag', 'out.bag', '--rate', '20')
        self.expect_usage_fault('unknown option -c', 'in.bag', 'out.bag', '-c', 'config.yaml')
        self.expect_usage_fault('--config needs a value', 'in.bag', 'out.bag', '--config')
        self.expect_usage_fault('--urdf needs a value', 'in.bag', 'out.bag', '--urdf')
        self.assertEqual(self.files(), before)

    def test_a_configuration_that_cannot_be_read(self):
        self.record()
        words = ('in.bag', 'out.bag', '--config', 'config.yaml')
        self.expect_fault('config.yaml', words=words)
        self.write('config.yaml', 'rate: [10\n')
        self.expect_fault('config.yaml', words=words)
        self.write('config.yaml', '- rate\n')
        self.expect_fault('config.yaml', words=words)

    def test_a_bad_configuration_is_refused_with_all_its_faults(self):
        self.record()
        self.write('config.yaml', 'rate: 0\nratte: 20\nmap_param: {default_left_width: wide}\n')
        self.expect_fault("rate is 0", 'ratte is not a parameter', "map_param/default_left_width is 'wide'",
                          words=('in.bag', 'out.bag', '--config', 'config.yaml'), lines=4)

    def test_lines_of_the_configuration_that_cannot_be_loaded(self):
        self.record()
        words = ('in.bag', 'out.bag', '--config', 'config.yaml')
        self.write('config.yaml', 'navigation_lines: [absent.smoothed]\n')
        self.expect_fault('absent.smoothed: cannot be opened', words=words)
        self.write('config.yaml', 'navigation_lines: {a: b}\n')
        self.expect_fault('config.yaml: navigation_lines must be a list of files', words=words)
        self.write('config.yaml', 'navigation_lines: [short.smoothed]\n')
        self.write('short.smoothed', '{"x": 1.0, "y": 2.0}\n')
        self.expect_fault('short', words=words)

    def test_a_bad_urdf(self):
        self.record()
        words = ('in.bag', 'out.bag', '--urdf', 'car.urdf')
        self.expect_fault('car.urdf: cannot be opened', words=words)
        self.write('car.urdf', '')
        self.expect_fault('car.urdf: is empty', words=words)
        self.write('car.urdf', '<robot name="car"><link name="wheel"/></robot>')
        self.expect_fault("no link 'base_link'", words=words, lines=2)


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'replay_faults', ReplayFaults)
