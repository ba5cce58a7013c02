#!/usr/bin/env python3
"""What `navigation_line record` makes of poses of other links, of orientations, and of receivers' errors."""

import json
import math
import random

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
    def points(self, name='line.smoothed'):
        objects = [json.loads(line) for line in self.read(name).splitlines()]
        return [entry for entry in objects if 'x' in entry]

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

    def test_an_outlier_is_dropped_and_told(self):
        entries = list(drive('/pose', odometry))
        entries[150][1].pose.pose.position.y += 20.0
        text = self.record_line(entries)
        self.assertRegex(text, r'1 poses left out as outliers, the farthest by 20\.\d m at stamp 1700000007\.500')
        self.expect_way_of_base()


if __name__ == '__main__':
    rostest.rosrun('relative_map', 'navigation_line_record', NavigationLineRecord)
