#!/usr/bin/env python3
"""Writes a large GLB file to measure loading with: `alcove render FILE --size 320x180 --out DIR`, whose
report.json has load_seconds and peak_process_bytes.

  large_scene.py FILE grid SIDE       hills of 2 * SIDE * SIDE triangles that share their vertices
  large_scene.py FILE soup TRIANGLES  triangles in a cube that share no vertex
  large_scene.py FILE instances SIDE COUNT   COUNT nodes with one mesh, the hills
  large_scene.py FILE placed SIDE COUNT      one node that places the hills COUNT times by
                                             EXT_mesh_gpu_instancing
"""
import json
import math
import random
import struct
import sys
from array import array


class Glb:
    def __init__(self):
        self.binary = bytearray()
        self.root = {"asset": {"version": "2.0"}, "scene": 0, "bufferViews": [], "accessors": []}

    def accessor(self, values, component, kind, count, **extra):
        offset = len(self.binary)
        self.binary += values.tobytes()
        self.root["bufferViews"].append(
            {"buffer": 0, "byteOffset": offset, "byteLength": len(self.binary) - offset})
        self.root["accessors"].append(
            {"bufferView": len(self.root["bufferViews"]) - 1, "componentType": component,
             "type": kind, "count": count, **extra})
        return len(self.root["accessors"]) - 1

    def write(self, file):
        self.root["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.root).encode()
        text += b" " * (-len(text) % 4)
        with open(file, "wb") as out:
            out.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(self.binary)))
            out.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
            out.write(struct.pack("<II", len(self.binary), 0x004E4942))
            out.write(self.binary)


FLOAT, UINT = 5126, 5125


def add_hills(glb, side):
    wave = [math.sin(40.0 * i / side) for i in range(side + 1)]
    positions, indices = array("f"), array("I")
    for z in range(side + 1):
        for x in range(side + 1):
            positions.extend((x / side, 0.02 * wave[x] * wave[z], z / side))
    for z in range(side):
        for i in range(z * (side + 1), z * (side + 1) + side):
            j = i + side + 1
            indices.extend((i, j, i + 1, i + 1, j, j + 1))
    primitive = {"attributes": {"POSITION": glb.accessor(
        positions, FLOAT, "VEC3", len(positions) // 3, min=[0, -0.02, 0], max=[1, 0.02, 1])},
        "indices": glb.accessor(indices, UINT, "SCALAR", len(indices))}
    glb.root["meshes"] = [{"primitives": [primitive]}]


def add_soup(glb, triangles):
    dice = random.Random(1)
    positions = array("f")
    for _ in range(triangles):
        x, y, z = dice.random(), dice.random(), dice.random()
        positions.extend((x, y, z, x + 0.01, y, z, x, y + 0.01 * z, z + 0.01 * y))
    primitive = {"attributes": {"POSITION": glb.accessor(
        positions, FLOAT, "VEC3", 3 * triangles, min=[0, 0, 0], max=[1.01, 1.01, 1.01])}}
    glb.root["meshes"] = [{"primitives": [primitive]}]


def main():
    file, kind, size = sys.argv[1], sys.argv[2], int(sys.argv[3])
    glb = Glb()
    nodes = [{"mesh": 0}]
    if kind == "soup":
        add_soup(glb, size)
    else:
        add_hills(glb, size)
    if kind == "instances":
        columns = math.ceil(math.sqrt(int(sys.argv[4])))
        nodes = [{"mesh": 0, "translation": [1.1 * (i % columns), 0, 1.1 * (i // columns)]}
                 for i in range(int(sys.argv[4]))]
    elif kind == "placed":
        count = int(sys.argv[4])
        columns = math.ceil(math.sqrt(count))
        places = array("f")
        for i in range(count):
            places.extend((1.1 * (i % columns), 0, 1.1 * (i // columns)))
        nodes[0]["extensions"] = {"EXT_mesh_gpu_instancing": {
            "attributes": {"TRANSLATION": glb.accessor(places, FLOAT, "VEC3", count)}}}
        glb.root["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    glb.root["nodes"] = nodes
    glb.root["scenes"] = [{"nodes": list(range(len(nodes)))}]
    glb.write(file)


if __name__ == "__main__":
    main()
