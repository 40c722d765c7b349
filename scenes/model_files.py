"""File writers for make_models.py: PNG, Wavefront OBJ with MTL, and binary glTF 2.0."""

import json
import math
import os
import struct
import zlib

from modelling import Matrix, rotation, subtract, cross, unit


def png(width, height, texel):
    """8-bit sRGB; texel(x, y) gives (r, g, b), y down. Rows are stored as differences to the left."""
    rows = bytearray()
    for y in range(height):
        line = [texel(x, y) for x in range(width)]
        rows.append(1)
        for left, this in zip([(0, 0, 0)] + line, line):
            rows += bytes((b - a) & 255 for a, b in zip(left, this))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"sRGB", b"\0")
            + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


class Obj:
    """A Wavefront OBJ file and its MTL."""

    def __init__(self, path, comment):
        self.path, self.lines, self.materials = path, ["# " + comment], []
        self.lines.append("mtllib " + os.path.basename(path)[:-4] + ".mtl")
        self.indices = {"v": {}, "vt": {}, "vn": {}}

    def material(self, name, **entries):
        self.materials.append("newmtl " + name)
        for key, value in entries.items():
            text = " ".join(map(str, value)) if isinstance(value, tuple) else str(value)
            self.materials.append("%s %s" % (key, text))
        self.materials.append("")

    def index(self, kind, values):
        digits = "%.3f" if kind == "vn" else "%.4f"
        text = kind + "".join(" " + (digits % v).rstrip("0").rstrip(".") for v in values)
        text = (text + " ").replace(" -0 ", " 0 ").replace(" -0 ", " 0 ").rstrip()
        known = self.indices[kind]
        if text not in known:
            known[text] = len(known) + 1
            self.lines.append(text)
        return known[text]

    def group(self, name, material, mesh, texcoords=False):
        self.lines += ["o " + name, "usemtl " + material]
        for polygon in mesh.polygons:
            words = []
            for corner in polygon:
                texcoord = str(self.index("vt", corner.texcoord)) if texcoords else ""
                words.append("%d/%s/%d" % (self.index("v", corner.position), texcoord,
                                           self.index("vn", corner.normal)))
            if len(set(word.split("/")[0] for word in words)) > 2:
                self.lines.append("f " + " ".join(words))

    def write(self):
        with open(self.path, "w", newline="\n") as file:
            file.write("\n".join(self.lines) + "\n")
        with open(self.path[:-4] + ".mtl", "w", newline="\n") as file:
            file.write("\n".join(self.materials))


def quaternion(axis, degrees):
    s, c = math.sin(math.radians(degrees) / 2), math.cos(math.radians(degrees) / 2)
    return [s if axis == name else 0.0 for name in "xyz"] + [c]


class Gltf:
    """A binary glTF 2.0 file: nodes with parents, meshes of one primitive, embedded textures."""

    def __init__(self, path):
        self.path, self.binary, self.parents = path, bytearray(), {}
        self.document = {
            "asset": {"version": "2.0", "generator": "penumbra scenes/make_models.py"},
            "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
            "cameras": [], "accessors": [], "bufferViews": [], "buffers": [], "images": [],
            "textures": [], "samplers": [{"magFilter": 9729, "minFilter": 9729}]}

    def add(self, kind, item):
        self.document[kind].append(item)
        return len(self.document[kind]) - 1

    def view(self, data, target=None):
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.binary += data
        return self.add("bufferViews", view)

    def attribute(self, values, kind):
        data = b"".join(struct.pack("<%df" % len(v), *v) for v in values)
        accessor = {"bufferView": self.view(data, 34962), "componentType": 5126,
                    "count": len(values), "type": kind}
        exact = [struct.unpack("<%df" % len(v), struct.pack("<%df" % len(v), *v)) for v in values]
        accessor["min"] = [min(column) for column in zip(*exact)]
        accessor["max"] = [max(column) for column in zip(*exact)]
        return self.add("accessors", accessor)

    def material(self, name, color, metallic, roughness, emission=None, texture=None,
                 double_sided=False):
        pbr = {"baseColorFactor": list(color) + [1.0], "metallicFactor": metallic,
               "roughnessFactor": roughness}
        if texture:
            image = self.add("images", {"bufferView": self.view(texture), "mimeType": "image/png",
                                        "name": name})
            pbr["baseColorTexture"] = {"index": self.add("textures", {"source": image, "sampler": 0})}
        material = {"name": name, "pbrMetallicRoughness": pbr}
        if emission:
            material["emissiveFactor"] = list(emission)
        if double_sided:
            material["doubleSided"] = True
        self.add("materials", material)

    def mesh(self, name, material, mesh, texcoords=True, colors=False):
        vertices, indices = {}, []
        for polygon in mesh.polygons:
            corners = [vertices.setdefault((
                tuple(round(v, 6) for v in c.position), tuple(round(v, 4) for v in c.normal),
                tuple(round(v, 5) for v in c.texcoord) if texcoords else (),
                tuple(round(v, 4) for v in c.color) if colors else ()), len(vertices))
                for c in polygon]
            for i in range(1, len(corners) - 1):
                indices += [corners[0], corners[i], corners[i + 1]]
        attributes = {"POSITION": self.attribute([v[0] for v in vertices], "VEC3"),
                      "NORMAL": self.attribute([unit(v[1]) for v in vertices], "VEC3")}
        if texcoords:  # glTF's v points down
            attributes["TEXCOORD_0"] = self.attribute([(v[2][0], 1 - v[2][1]) for v in vertices], "VEC2")
        if colors:
            attributes["COLOR_0"] = self.attribute([v[3] for v in vertices], "VEC3")
        data = struct.pack("<%dH" % len(indices), *indices)
        accessor = self.add("accessors", {"bufferView": self.view(data, 34963), "componentType": 5123,
                                          "count": len(indices), "type": "SCALAR"})
        names = [m["name"] for m in self.document["materials"]]
        return self.add("meshes", {"name": name, "primitives": [{
            "attributes": attributes, "indices": accessor, "material": names.index(material)}]})

    def node(self, name, parent=None, turn=None, **properties):
        node = {"name": name, **{k: list(v) if isinstance(v, tuple) else v
                                 for k, v in properties.items()}}
        if turn:
            node["rotation"] = quaternion(*turn)
        index = self.add("nodes", node)
        self.parents[index] = (parent, turn)
        if parent is None:
            self.document["scenes"][0]["nodes"].append(index)
        else:
            self.document["nodes"][parent].setdefault("children", []).append(index)
        return index

    def world_matrix(self, index):
        """Of a node whose ancestors are not scaled."""
        parent, turn = self.parents[index]
        x, y, z = self.document["nodes"][index].get("translation", (0, 0, 0))
        local = Matrix([[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z]])
        if turn:
            local = local @ rotation(*turn)
        return local if parent is None else self.world_matrix(parent) @ local

    def camera(self, name, eye, target, yfov):
        back = unit(subtract(eye, target))
        right = unit(cross((0, 1, 0), back))
        up = cross(back, right)
        columns = [list(right) + [0], list(up) + [0], list(back) + [0], list(eye) + [1]]
        camera = self.add("cameras", {"type": "perspective", "name": name, "perspective": {
            "yfov": math.radians(yfov), "aspectRatio": 4 / 3, "znear": 0.01, "zfar": 10}})
        self.document["nodes"].append({"name": name, "camera": camera,
                                       "matrix": [v for column in columns for v in column]})
        self.document["scenes"][0]["nodes"].append(len(self.document["nodes"]) - 1)

    def write(self):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.document["buffers"].append({"byteLength": len(self.binary)})
        text = json.dumps(self.document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(self.path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)
