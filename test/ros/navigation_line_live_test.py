#!/usr/bin/env python3
"""`navigation_line publish` for those that come later, and `record --live` from what is published."""

import json
import os
import signal
import subprocess
import threading

import rospy
import rostest
from nav_msgs.msg import Odometry
from relative_map.msg import NavigationInfo
from tf2_msgs.msg import TFMessage

import vehicle_messages
from navigation_line_support import ToolTest, odometry, smoothed, straight, way
from node_support import wait_for


class NavigationLineLive(ToolTest):
    def start(self, *words):
        process = subprocess.Popen(self.command(*words), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   universal_newlines=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.kill)
        return process

    def publish(self, *words):
        """What a subscriber that comes late receives."""
        process = self.start('publish', *words)
        while 'runs on for those that come later' not in process.stdout.readline():
            self.assertIsNone(process.poll())
        message = rospy.wait_for_message('navigation', NavigationInfo, timeout=20.0)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20.0), 0)
        return message

    def test_publishes_latched_with_priorities_by_order(self):
        self.write('a.smoothed', '{"header": {"frame_id": "world"}}\n' + smoothed(straight(100.0)))
        self.write('b.smoothed', smoothed(straight(100.0, y=3.5)))
        message = self.publish('a.smoothed', 'b.smoothed')
        self.assertEqual(message.header.frame_id, 'world')
        self.assertEqual([(line.path.name, line.path_priority) for line in message.navigation_path], [('a', 0), ('b', 1)])
        self.assertEqual(len(message.navigation_path[0].path.path_point), 201)
        message = self.publish('a.smoothed', 'b.smoothed', '--priority', '3,2', '--by-curvature')
        self.assertEqual([line.path_priority for line in message.navigation_path], [3, 2])
        self.assertLess(len(message.navigation_path[0].path.path_point), 40)

    def test_ends_when_interrupted_without_a_master(self):
        self.write('a.smoothed', smoothed(straight(100.0)))
        os.environ['ROS_MASTER_URI'], before = 'http://127.0.0.1:1', os.environ['ROS_MASTER_URI']
        self.addCleanup(os.environ.update, ROS_MASTER_URI=before)
        for words in (('publish', 'a.smoothed'), ('record', '--live', 'line.smoothed')):
            for sent in (signal.SIGINT, signal.SIGTERM):
                process = self.start(*words)
                while 'waiting for a master' not in process.stdout.readline():
                    self.assertIsNone(process.poll())
                process.send_signal(sent)
                self.assertNotEqual(process.wait(20.0), 0)
        self.assertEqual(os.listdir(self.folder), ['a.smoothed'])

    def test_records_live_until_interrupted(self):
        publisher = rospy.Publisher('localization', Odometry, queue_size=1000)
        process = self.start('record', '--live', 'line.smoothed')
        wait_for(lambda: publisher.get_num_connections() > 0, 'subscriber')
        stop = threading.Event()
        self.addCleanup(stop.set)
        start = rospy.Time.now()
        for step in range(400):
            publisher.publish(odometry(start + rospy.Duration(step / 20.0), *way(step)))
            rospy.sleep(0.005)
        rospy.sleep(1.0)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20.0), 0, process.stdout.read())
        points = [json.loads(line) for line in self.read('line.smoothed').splitlines()][1:]
        self.assertGreater(len(points), 300)

    def drive_imu(self, publisher):
        """Poses of a link 2 m ahead of base_link, along x."""
        start = rospy.Time.now()
        for step in range(300):
            message = odometry(start + rospy.Duration(step / 20.0), 100.0 + 0.5 * step, 50.0)
            message.child_frame_id = 'imu_link'
            message.pose.pose.orientation.w = 1.0
            publisher.publish(message)
            rospy.sleep(0.005)

    def test_carries_poses_by_the_transforms_that_are_published(self):
        transforms = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self.addCleanup(transforms.unregister)
        transforms.publish(TFMessage([vehicle_messages.static_transform('imu_link', 2.0, 0.5)]))
        publisher = rospy.Publisher('imu_odometry', Odometry, queue_size=1000)
        process = self.start('record', '--live', 'line.smoothed', '--topic', 'imu_odometry')
        wait_for(lambda: publisher.get_num_connections() > 0 and transforms.get_num_connections() > 0, 'subscribers')
        self.drive_imu(publisher)
        rospy.sleep(1.0)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20.0), 0, process.stdout.read())
        points = [json.loads(line) for line in self.read('line.smoothed').splitlines()][1:]
        self.assertAlmostEqual(points[0]['x'], 98.0, delta=1.5)
        self.assertAlmostEqual(points[-1]['x'], 98.0 + 0.5 * 299, delta=1.5)

    def test_a_missing_transform_is_said_while_it_records(self):
        publisher = rospy.Publisher('gps_odometry', Odometry, queue_size=1000)
        process = self.start('record', '--live', 'line.smoothed', '--topic', 'gps_odometry', '--base-frame', 'axle')
        wait_for(lambda: publisher.get_num_connections() > 0, 'subscriber')
        self.drive_imu(publisher)
        self.assertEqual(process.wait(20.0), 1)
        self.assertIn("there is no transform from that to 'axle'", process.stdout.read())
        self.assertEqual(self.contents(), {})

    def record_some(self, publisher, count=400):
        start = rospy.Time.now()
        for step in range(count):
            publisher.publish(odometry(start + rospy.Duration(step / 20.0), *way(step)))
            rospy.sleep(0.005)

    def start_recording(self, topic):
        publisher = rospy.Publisher(topic, Odometry, queue_size=1000)
        self.addCleanup(publisher.unregister)
        process = self.start('record', '--live', 'line.smoothed', '--topic', topic)
        wait_for(lambda: publisher.get_num_connections() > 0, 'subscriber')
        return publisher, process

    def test_every_signal_that_ends_it_keeps_the_drive(self):
        for number in (signal.SIGTERM, signal.SIGHUP):
            publisher, process = self.start_recording('drive_%d' % number)
            self.record_some(publisher)
            rospy.sleep(1.0)
            process.send_signal(number)
            self.assertEqual(process.wait(20.0), 0, process.stdout.read())
            self.assertGreater(len(self.points()), 300)
            self.assertEqual(os.listdir(self.folder), ['line.smoothed'])
            os.remove(self.path('line.smoothed'))

    def test_power_loss_keeps_all_but_the_last_second(self):
        publisher, process = self.start_recording('lost_drive')
        self.record_some(publisher)
        rospy.sleep(1.5)
        self.record_some(publisher, 1)  # a second later: what was before is on the disk
        rospy.sleep(0.5)
        process.kill()
        process.wait(20.0)
        journal = 'line.smoothed.recording.bag'
        self.assertEqual(os.listdir(self.folder), [journal])
        run = self.run_tool('record', '--live', 'line.smoothed', '--topic', 'lost_drive', master=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn(journal + ' is left of a recording that was cut off', run.stderr)
        subprocess.check_call(['rosbag', 'reindex', journal], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
        self.expect('record', journal, 'line.smoothed')
        self.assertGreater(len(self.points()), 300)

    def test_a_drive_that_cannot_become_a_line_is_kept_as_it_came(self):
        publisher, process = self.start_recording('parked')
        start = rospy.Time.now()
        for step in range(200):
            publisher.publish(odometry(start + rospy.Duration(step / 20.0), 1.0, 2.0))
            rospy.sleep(0.005)
        rospy.sleep(0.5)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(20.0), 1)
        self.assertIn('what was received is kept in line.smoothed.recording.bag', process.stdout.read())
        self.expect_fault('record', 'line.smoothed.recording.bag', 'line.smoothed', says=('has not moved forward',))

    def test_nothing_to_record_is_said(self):
        run = self.run_tool('record', '--live', 'line.smoothed', '--topic', 'nobody', '--duration', '1', master=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn('nothing that can be used was published on nobody', run.stderr)
        self.assertEqual(self.contents(), {})


if __name__ == '__main__':
    rospy.init_node('navigation_line_live_test')
    rostest.rosrun('relative_map', 'navigation_line_live', NavigationLineLive)
