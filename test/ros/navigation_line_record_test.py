#!/usr/bin/env python3
"""What `navigation_line record` makes of poses of other links, of orientations, and of receivers' errors."""

import math
import os
import random

import rosbag
import roslib.packages
import rospy
import rostest
from geometry_msgs.msg import Quaternion
from tf2_msgs.msg import TFMessage

import vehicle_messages
from navigation_line_support import RATE, START, ToolTest, X, Y, drive, fix, fixes, localization, odometry

ARM = 2.0  # [m] that the measuring unit lies ahead of base_link


def yaw_at(step):
    """Of way(), at 10 m/s on a circle of 100 m."""
    return 10.0 * step / RATE / 100.0


def quaternion(yaw):
    return Quaternion(z=math.sin(0.5 * yaw), w=math.cos(0.5 * yaw))


def of_imu(make, turn=0.0, orientation=True, link='imu_link'):
    """Poses of a link ahead of base_link, which drives along way(); the orientation is turned."""
    for step, (topic, message, stamp) in enumerate(drive('/pose', make)):
        yaw = yaw_at(step)
        message.child_frame_id = link
        pose = message.pose if make is localization else message.pose.pose
        pose.position.x += ARM * math.cos(yaw)
        pose.position.y += ARM * math.sin(yaw)
        pose.orientation = quaternion(yaw + turn) if orientation else Quaternion()
        yield topic, message, stamp


def static_transforms(child='imu_link', parent='base_link'):
    transform = vehicle_messages.static_transform(child, ARM, 0.5, parent)
    return '/tf_static', TFMessage([transform]), START + rospy.Duration(9)


class NavigationLineRecord(ToolTest):
    def record_line(self, entries, *options):
        self.record('in.bag', entries)
        return self.expect('record', 'in.bag', 'line.smoothed', *options)

    def refuse(self, entries, *says, options=()):
        self.record('in.bag', entries)
        self.expect_fault('record', 'in.bag', 'line.smoothed', *options, says=('in.bag: ',) + says)

    def expect_way_of_base(self, radius=100.0):
        points = self.points()
        self.assertGreater(len(points), 250)
        for point in points:
            self.assertAlmostEqual(math.hypot(point['x'] - X, point['y'] - Y - 100.0), radius, delta=1e-3)

    def test_poses_of_another_link_are_carried_to_the_base_frame(self):
        for make in (odometry, localization):
            text = self.record_line(list(of_imu(make)) + [static_transforms()])
            self.expect_way_of_base()
            self.assertIn("carried from 'imu_link' to 'base_link'", text)
        self.record_line(list(of_imu(odometry)) + [static_transforms(parent='rear_axle')], '--base-frame', 'rear_axle')
        self.expect_way_of_base()
        self.record_line(of_imu(odometry), '--base-frame', 'imu_link')
        self.expect_way_of_base(math.hypot(100.0, ARM))

    def test_without_a_transform_they_are_refused(self):
        for make in (odometry, localization):
            self.refuse(of_imu(make), "its poses are of 'imu_link'", "no transform from that to 'base_link' in /tf_static",
                        '--base-frame')
        self.refuse(list(of_imu(odometry)) + [static_transforms('camera_link')], 'no transform')

    def test_without_an_orientation_they_cannot_be_carried(self):
        self.refuse(list(of_imu(odometry, orientation=False)) + [static_transforms()], 'none of its poses has an orientation')
        entries = list(of_imu(odometry))
        entries[150][1].pose.pose.orientation = Quaternion()
        self.assertIn('1 poses left out for want of an orientation', self.record_line(entries + [static_transforms()]))
        self.expect_way_of_base()

    def test_the_convention_of_the_orientation(self):
        rfu = list(of_imu(localization, turn=-0.5 * math.pi)) + [static_transforms()]
        self.record_line(rfu, '--orientation-convention', 'rfu')
        self.expect_way_of_base()
        self.refuse(rfu, 'lie across the motion', '--orientation-convention')
        self.refuse(list(of_imu(localization)) + [static_transforms()], 'lie across the motion',
                    options=('--orientation-convention', 'rfu'))
        self.expect_fault('record', 'in.bag', 'line.smoothed', '--orientation-convention', 'enu',
                          says=('must be flu or rfu',), code=2)

    def test_orientations_that_were_never_filled_do_no_harm(self):
        entries = list(drive('/pose', odometry, count=1200))
        for _, message, _ in entries:  # nearly a lap, all of it with the orientation of an eastward drive
            message.pose.pose.orientation.w = 1.0
        text = self.record_line(entries)
        self.assertGreater(len(self.points()), 1100)
        self.assertIn('0 reversing', text)
        self.assertIn('the orientations are not used', text)

    def test_fixes_are_of_the_receiver(self):
        entries = [('/fix', fix(START + rospy.Duration(i / 10.0), 48.1, 11.5 + 6.7e-6 * i), START) for i in range(200)]
        self.assertNotIn('receiver', self.record_line(entries))
        for _, message, _ in entries:
            message.header.frame_id = 'gps_link'
        self.assertIn("the line is where the receiver 'gps_link' was, and not 'base_link'", self.record_line(entries))

    def test_fixes_that_were_never_set_are_none(self):
        entries = list(fixes())
        for _, message, _ in entries[:20]:  # says that it is a fix, and is not
            message.latitude = message.longitude = 0.0
        text = self.record_line(entries)
        self.assertIn('20 without a fix', text)
        self.assertIn('UTM zone 32N', text)

    def parked(self, noise, seconds=60):
        draw = random.Random(5)
        for i in range(10 * seconds):
            stamp = START + rospy.Duration(i / 10.0)
            yield '/pose', odometry(stamp, X + draw.gauss(0.0, noise), Y + draw.gauss(0.0, noise)), stamp

    def test_parked_noise_is_no_motion(self):
        self.refuse(self.parked(0.5), 'the vehicle has not moved forward', 'noise', 'standard deviation of 0.')
        self.refuse(self.parked(1.0), 'the vehicle has not moved forward', 'noise')
        later = [(topic, message, stamp + rospy.Duration(60)) for topic, message, stamp in drive('/pose', odometry)]
        for _, message, stamp in later:
            message.header.stamp = stamp
        text = self.record_line(list(self.parked(0.5)) + later)
        self.assertRegex(text, r' (59\d|60\d) of them standing, 0 reversing \(0 points taken back\)')

    def test_a_clock_that_is_set_loses_nothing_and_is_told(self):
        for what, wrong, told in (('1980', lambda step: -1384035200 if 150 <= step < 190 else 0, 'set back by 13840352'),
                                  ('0.5 s', lambda step: -0.5 if step >= 150 else 0, 'set back by 0.5'),
                                  ('2 s', lambda step: -2 if step >= 150 else 0, 'set back by 2.0'),
                                  ('1 h', lambda step: -3600 if step >= 150 else 0, 'set back by 3600')):
            with self.subTest(what):
                entries = list(drive('/pose', odometry))
                for step, (_, message, stamp) in enumerate(entries):
                    message.header.stamp = stamp + rospy.Duration(wrong(step))
                text = self.record_line(entries)
                self.expect_way_of_base()
                self.assertIn(told, text)
                self.assertIn('(100 %)', text)

    def test_a_recorder_whose_clock_was_set_too(self):
        for back in (0.5, 2.0, 3600.0):
            entries = []
            for step, (topic, message, stamp) in enumerate(drive('/pose', odometry)):
                stamp -= rospy.Duration(back if step >= 150 else 0)
                message.header.stamp, message.header.seq = stamp, step
                entries.append((topic, message, stamp))
            text = self.record_line(entries)
            self.expect_way_of_base()
            self.assertIn('set back by %.1f' % back, text)
            if back > 3.0:
                continue  # no message lies among others: the order is that of a drive
            for _, message, _ in entries:
                message.header.seq = 0
            self.refuse(entries, 'two sources on one topic, or the clock of the recording was set back')

    def two_receivers(self, frames=('', ''), publishers=(None, None)):
        for step in range(400):
            for number in range(2):
                stamp = START + rospy.Duration(step / 10.0 + 0.02 * number)
                message = fix(stamp, 48.1 + 1e-5 * number, 11.5 + 6.7e-6 * step)
                message.header.frame_id = frames[number]
                header = {'callerid': publishers[number]} if publishers[number] else None
                yield '/fix', message, stamp, header

    def write_two_receivers(self, **options):
        connections = {}  # by publisher, as `rosbag record` has them: rosbag itself has one a topic
        with rosbag.Bag(self.path('in.bag'), 'w') as bag:
            for topic, message, stamp, header in self.two_receivers(**options):
                publisher = header['callerid'] if header else ''
                bag._topic_connections.pop(topic, None)
                if publisher in connections:
                    bag._topic_connections[topic] = connections[publisher]
                if header:
                    header.update(topic=topic, type=message._type, md5sum=message._md5sum,
                                  message_definition=message._full_text)
                bag.write(topic, message, stamp, connection_header=header)
                connections[publisher] = bag._topic_connections[topic]

    def test_two_receivers_on_one_topic_are_named(self):
        self.write_two_receivers()
        self.expect_fault('record', 'in.bag', 'line.smoothed', says=('there are two sources on one topic',))
        self.write_two_receivers(frames=('front', 'rear'))
        self.expect_fault('record', 'in.bag', 'line.smoothed', says=("frame 'front'", "frame 'rear'", '--source'))
        self.write_two_receivers(publishers=('/left', '/right'))
        self.expect_fault('record', 'in.bag', 'line.smoothed', says=("'/left'", "'/right'", '--source'))
        text = self.expect('record', 'in.bag', 'line.smoothed', '--source', '/left')
        self.assertIn('400 poses of other sources left out', text)
        self.assertGreater(len(self.points()), 190)  # each second one is half a metre on

    def test_noisy_fixes_are_told_and_a_canyon_is_refused(self):
        draw = random.Random(3)
        entries = list(fixes(count=600))
        for _, message, _ in entries:
            message.position_covariance[0] = message.position_covariance[4] = 0.64
            message.position_covariance_type = 2
        self.assertIn('a standard deviation of 0.80 m', self.record_line(entries))
        for _, message, _ in entries:
            message.latitude += draw.gauss(0.0, 21.0 / 111e3)
            message.longitude += draw.gauss(0.0, 21.0 / 74e3)
        self.refuse(entries, 'of the way', 'can become a line: the poses scatter by a standard deviation of 2')
        for _, message, _ in entries:
            message.position_covariance[0] = message.position_covariance[4] = 441.0
        self.refuse(entries, 'all of its 600 poses are stated to be worse than the limit')

    def test_a_bridged_gap_stays_a_fault_until_it_is_accepted(self):
        entries = [entry for step, entry in enumerate(fixes(count=600)) if not 150 <= step < 280]
        self.record_line(entries, '--local')
        self.assertIn('gap at point', self.run_tool('check', 'line.smoothed').stdout)
        self.expect('smooth', 'line.smoothed', 'lane.smoothed')
        self.expect('offset', 'lane.smoothed', 'left.smoothed', '--distance=3.5')
        self.expect('convert', 'left.smoothed', 'left.csv')
        for name in ('lane.smoothed', 'left.smoothed', 'left.csv'):
            run = self.run_tool('check', name)
            self.assertEqual(run.returncode, 1)
            self.assertRegex(run.stdout, name + r': bridged at point \d+, s = 7\d.\d m: nothing was recorded for 65')
            self.expect('check', name, '--max-gap', '80')
        self.expect('smooth', 'line.smoothed', 'accepted.smoothed', '--max-gap', '80')
        self.expect('check', 'accepted.smoothed')

    def test_a_real_bag_of_a_robot(self):
        data = os.environ.get('RELATIVE_MAP_REFERENCE_DATA',
                              os.path.join(roslib.packages.get_pkg_dir('relative_map'), '../shared/reference'))
        bag = os.path.join(data, 'localization/husky_bag/test1.bag')
        if not os.path.exists(bag):
            self.skipTest('the recorded bag is not here: ' + bag)
        text = self.expect('record', bag, 'line.smoothed', '--topic', '/fix', '--local')
        xs, ys = zip(*((point['x'], point['y']) for point in self.points()))
        self.assertAlmostEqual(max(xs) - min(xs), 58.0, delta=1.5)
        self.assertAlmostEqual(max(ys) - min(ys), 145.0, delta=1.5)
        self.assertRegex(text, r'of the way are kept \(9[0-9] %\)')
        self.assertIn('the receiver states a standard deviation of 0.80 m', text)

    def test_an_outlier_is_dropped_and_told(self):
        entries = list(drive('/pose', odometry))
        entries[150][1].pose.pose.position.y += 20.0
        text = self.record_line(entries)
        self.assertRegex(text, r'1 poses left out as outliers, the farthest by 20\.\d m at stamp 1700000007\.500')
        self.expect_way_of_base()


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'navigation_line_record', NavigationLineRecord)
