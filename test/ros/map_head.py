"""The first fields of a serialized map, which cost little to read; a whole map takes Python some 10 ms."""

import struct

import rospy
from relative_map.msg import MapMsg


class MapHead:
    def __init__(self, data):
        self.data = data
        _, seconds, nanoseconds, length = struct.unpack_from('<4I', data)
        self.stamp = rospy.Time(seconds, nanoseconds)
        self.frame_id = data[16:16 + length].decode()
        self.sequence_num, self.code, text_length = struct.unpack_from('<IBI', data, 16 + length)
        start = 16 + length + 9
        self.text = data[start:start + text_length].decode()

    def whole(self):
        return MapMsg().deserialize(self.data)
