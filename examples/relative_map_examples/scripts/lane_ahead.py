#!/usr/bin/env python3
"""Prints, for each map, where the middle of the vehicle's lane is 20 m ahead: a start for a planner of your own."""
import numpy
import rospy
from relative_map import lanes
from relative_map.msg import MapMsg, MapStatus


def on_map(message):
    if message.status.code != MapStatus.OK:  # the map is empty: do not drive on by the last one
        rospy.logwarn("no map: %s", message.status.message)
        return
    all_lanes = lanes.lanes_of(message)
    mine = next(lane for lane in all_lanes if lane.current)
    ahead = mine.vehicle_s + 20.0  # along the lane: x rises and falls where it bends
    y, kappa = (numpy.interp(ahead, mine.path["s"], mine.path[name]) for name in ("y", "kappa"))
    rospy.loginfo("%d lanes; mine is at y = %+.2f m, curved by %.4f 1/m", len(all_lanes), y, kappa)


rospy.init_node("lane_ahead")
subscriber = rospy.Subscriber("relative_map", MapMsg, on_map, queue_size=1)
rospy.spin()
