#!/usr/bin/env python3
"""Writes the seeds of the fuzz targets into corpus/, whose content is committed.

  tests/fuzz/make_corpus.py

Run it by hand after a change of what the importers can read. Wants oiiotool (openimageio-tools) for
the pictures of the target `compare`.
"""
import base64
import json
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
from seeds_text import MTL, OBJ, SETTINGS, SIDECARS  # noqa: E402

CORPUS = HERE / "corpus"
FLOAT, BYTE, SHORT, INT = 5126, 5121, 5123, 5125
FORMATS = {FLOAT: "f", BYTE: "B", SHORT: "H", INT: "I"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
SQUARE = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
TEXCOORDS = [0, 0, 1, 0, 1, 1, 0, 1]

# A band of six quads in libdraco's sequential and edge breaker encodings; the tests have it too.
DRACO = [
    "RFJBQ08CAgEAAAAMDgEAAQICAQMCAwQEAwUEBQYGBQcGBwgIBwkICQoKCQsKCwwMCw0BAwAJAwAHAwkCAAgCAgQB"
    "CQAAAQAAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAgD8AAAAAAAAAAAAAgD8AAIA/AAAAAAAAAEAAAAAAAAAAAAAA"
    "AEAAAIA/AAAAAAAAQEAAAAAAAAAAAAAAQEAAAIA/AAAAAAAAgEAAAAAAAAAAAAAAgEAAAIA/AAAAAAAAoEAAAAAA"
    "AAAAAAAAoEAAAIA/AAAAAAAAwEAAAAAAAAAAAAAAwEAAAIA/AAAAAAAAAAAAAAAAAAAAAAAAgD8AAIA8AAAAAAAA"
    "gDwAAIA/AAAAPQAAAAAAAAA9AACAPwAAQD0AAAAAAABAPQAAgD8AAIA9AAAAAAAAgD0AAIA/AACgPQAAAAAAAKA9"
    "AACAPwAAwD0AAAAAAADAPQAAgD8AAQEBAmfdLiUB3Q7/iyUBClIDI57QgO7DaoAAAAAA/wAAAA==",
    "RFJBQ08CAgEBAAAADgwCDAAABV/XdV0H/wER/wK7QP8Cu0AD/wAAAAAAAQAAAQAJAwAHAgEDCQIACAABAgIEAQkB"
    "AQEBAAwDuS0lCR8lCQT0J/dBmapVAUBVAAAAgYBAQAAAAAAA/w8AAAAAAAAAAAAAAAAAAAAAwEAMAADAPQAAAAAA"
    "AKA9AACAPwAAwD0AAIA/AACgPQAAAAAAAIA9AACAPwAAgD0AAAAAAABAPQAAgD8AAEA9AAAAAAAAAD0AAIA/AAAA"
    "PQAAAAAAAIA8AACAPwAAgDwAAAAAAAAAAAAAgD8AAAAAAAAAAAEBAQECZ006SQIHJQFLJQH/MyUBB8Tx9L6vr4AA"
    "AAAA/wAAAA=="]


class Gltf:
    """One buffer, whose content grows with every accessor."""

    def __init__(self, *extensions):
        self.root = {"asset": {"version": "2.0"}}
        self.bin = b""
        if extensions:
            self.root["extensionsUsed"] = list(extensions)

    def add(self, key, thing):
        self.root.setdefault(key, []).append(thing)
        return len(self.root[key]) - 1

    def view(self, data, **members):
        self.bin += bytes(-len(self.bin) % 4)
        start = len(self.bin)
        self.bin += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": start,
                                        "byteLength": len(data), **members})

    def accessor(self, kind, values, component=FLOAT, **members):
        data = struct.pack(f"<{len(values)}{FORMATS[component]}", *values)
        return self.add("accessors", {"bufferView": self.view(data), "componentType": component,
                                      "count": len(values) // WIDTHS[kind], "type": kind, **members})

    def square(self, **attributes):
        """A primitive of two facets."""
        return {"attributes": {"POSITION": self.accessor("VEC3", SQUARE),
                               "TEXCOORD_0": self.accessor("VEC2", TEXCOORDS), **attributes},
                "indices": self.accessor("SCALAR", [0, 1, 2, 0, 2, 3], SHORT)}

    def show(self, primitive, **node):
        mesh = self.add("meshes", {"primitives": [primitive]})
        return self.place({"mesh": mesh, **node})

    def place(self, node):
        index = self.add("nodes", node)
        self.root["scene"] = 0
        self.root.setdefault("scenes", [{"nodes": []}])[0]["nodes"].append(index)
        return index

    def texture(self, uri="a.png", **members):
        image = self.add("images", {"uri": uri})
        return {"index": self.add("textures", {"source": image, **members})}

    def text(self):
        root = dict(self.root)
        if self.bin and "buffers" not in root:
            data = base64.b64encode(self.bin).decode()
            root["buffers"] = [{"byteLength": len(self.bin),
                                "uri": "data:application/octet-stream;base64," + data}]
        return json.dumps(root, separators=(",", ":")).encode()

    def glb(self):
        root = dict(self.root)
        if self.bin and "buffers" not in root:
            root["buffers"] = [{"byteLength": len(self.bin)}]
        text = json.dumps(root, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if self.bin:
            data = self.bin + bytes(-len(self.bin) % 4)
            chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def plain():
    gltf = Gltf()
    gltf.show({"attributes": {"POSITION": gltf.accessor("VEC3", SQUARE[:9])}})
    return gltf


def vertex_data():
    gltf = Gltf()
    gltf.show(gltf.square(NORMAL=gltf.accessor("VEC3", [0, 0, 1] * 4),
                          TANGENT=gltf.accessor("VEC4", [1, 0, 0, 1] * 4),
                          TEXCOORD_1=gltf.accessor("VEC2", [0, 255, 255, 0] * 2, BYTE,
                                                   normalized=True),
                          COLOR_0=gltf.accessor("VEC4", [255, 128, 0, 200] * 4, BYTE,
                                                normalized=True)))
    return gltf


def modes():
    gltf = Gltf()
    for mode in range(7):
        gltf.show({**gltf.square(), "mode": mode}, translation=[mode, 0, 0])
    return gltf


def sparse():
    gltf = Gltf()
    primitive = gltf.square()
    accessor = gltf.root["accessors"][primitive["attributes"]["POSITION"]]
    accessor["sparse"] = {"count": 1,
                          "indices": {"bufferView": gltf.view(b"\2\0"), "componentType": SHORT},
                          "values": {"bufferView": gltf.view(struct.pack("<3f", 2, 2, 1))}}
    gltf.show(primitive)
    return gltf


def materials():
    gltf = Gltf("KHR_materials_emissive_strength", "KHR_materials_unlit", "KHR_texture_transform")
    transform = {"KHR_texture_transform": {"offset": [0.25, 0.5], "rotation": 0.5, "scale": [2, 3],
                                           "texCoord": 0}}
    gltf.add("samplers", {"magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648})
    maps = [gltf.texture(uri, sampler=0) for uri in ("a.png", "b.png", "c.png", "sub/a.png", "a.jpg")]
    gltf.add("materials", {
        "name": "all", "alphaMode": "MASK", "alphaCutoff": 0.4, "doubleSided": True,
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 0.75], "metallicFactor": 0.5,
                                 "roughnessFactor": 0.25, "baseColorTexture": maps[1],
                                 "metallicRoughnessTexture": {**maps[0], "extensions": transform}},
        "normalTexture": {**maps[4], "scale": 0.5}, "occlusionTexture": {**maps[2], "strength": 0.5},
        "emissiveTexture": maps[3], "emissiveFactor": [1, 1, 0.5],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}})
    gltf.add("materials", {"name": "glass", "alphaMode": "BLEND",
                           "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}})
    gltf.add("materials", {"name": "flat", "extensions": {"KHR_materials_unlit": {}}})
    for material in range(3):
        gltf.show({**gltf.square(), "material": material}, translation=[material, 0, 0])
    return gltf


def polish():
    names = ["specular", "ior", "transmission", "volume", "clearcoat", "sheen", "iridescence",
             "dispersion", "anisotropy", "diffuse_transmission"]
    gltf = Gltf(*(f"KHR_materials_{name}" for name in names),
                "KHR_materials_pbrSpecularGlossiness")
    image = gltf.texture("b.png")
    gltf.add("materials", {"extensions": {
        "KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": image,
                                   "specularColorFactor": [1, 2, 0], "specularColorTexture": image},
        "KHR_materials_ior": {"ior": 1.45},
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.25,
                                    "clearcoatTexture": image, "clearcoatNormalTexture": image},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 0, 0], "sheenRoughnessFactor": 0.5},
        "KHR_materials_iridescence": {"iridescenceFactor": 1},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5}}})
    gltf.add("materials", {"extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": image},
        "KHR_materials_volume": {"thicknessFactor": 0.5, "thicknessTexture": image,
                                 "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0]},
        "KHR_materials_dispersion": {"dispersion": 0.1},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5}}})
    gltf.add("materials", {"extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [1, 0, 0, 1], "diffuseTexture": image, "specularFactor": [0.5, 1, 0],
        "glossinessFactor": 0.75, "specularGlossinessTexture": image}}})
    for material in range(3):
        gltf.show({**gltf.square(), "material": material}, translation=[material, 0, 0])
    return gltf


def variants():
    gltf = Gltf("KHR_materials_variants")
    gltf.add("materials", {"name": "first"})
    gltf.add("materials", {"name": "second"})
    gltf.root["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "a"}, {"name": "b"}]}}
    mappings = [{"material": 1, "variants": [0]}, {"material": 0, "variants": [1]}]
    gltf.show({**gltf.square(), "material": 0,
               "extensions": {"KHR_materials_variants": {"mappings": mappings}}})
    return gltf


def lights_and_cameras():
    gltf = Gltf("KHR_lights_punctual", "KHR_node_visibility")
    gltf.root["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 20, "range": 5, "color": [1, 0.5, 0]},
        {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "directional", "name": "sun", "intensity": 3}]}}
    gltf.add("cameras", {"type": "perspective", "name": "near",
                         "perspective": {"yfov": 0.7, "znear": 0.1, "aspectRatio": 1.5}})
    gltf.add("cameras", {"type": "orthographic",
                         "orthographic": {"xmag": 2, "ymag": 2, "zfar": 10, "znear": 0.1}})
    gltf.show(gltf.square())
    for light in range(3):
        gltf.place({"translation": [light, 1, 3], "rotation": [0.38, 0, 0, 0.92],
                    "extensions": {"KHR_lights_punctual": {"light": light}}})
    gltf.place({"camera": 0, "translation": [0, 0, 5]})
    gltf.place({"camera": 1, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 6, 1]})
    gltf.place({"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": False}}})
    return gltf


def motion():
    """A skin, morph targets and an animation of everything."""
    gltf = Gltf()
    skin = gltf.add("skins", {"joints": [1, 2], "inverseBindMatrices": gltf.accessor(
        "MAT4", ([1, 0, 0, 0] * 3 + [0, 0, 0, 1]) * 2)})
    targets = [{"POSITION": gltf.accessor("VEC3", [0, 0, 1] * 4)},
               {"POSITION": gltf.accessor("VEC3", [1, 0, 0] * 4)}]
    gltf.show({**gltf.square(JOINTS_0=gltf.accessor("VEC4", [0, 1, 0, 0] * 4, BYTE),
                             WEIGHTS_0=gltf.accessor("VEC4", [0.5, 0.5, 0, 0] * 4)),
               "targets": targets}, skin=skin, weights=[0.5, 0.25])
    gltf.place({"name": "hip", "children": [2]})
    gltf.add("nodes", {"name": "knee", "translation": [0, 1, 0], "scale": [1, 2, 1]})
    times = gltf.accessor("SCALAR", [0, 0.5, 1])
    cubic = gltf.accessor("VEC3", [0, 0, 0, 1, 1, 1, 0, 0, 0] * 3)
    tracks = [(1, "translation", gltf.accessor("VEC3", [0, 0, 0, 0, 1, 0, 1, 1, 0]), "LINEAR"),
              (2, "rotation", gltf.accessor("VEC4", [0, 0, 0, 1, 0, 0.7, 0, 0.7, 0, 1, 0, 0]), "LINEAR"),
              (2, "scale", cubic, "CUBICSPLINE"),
              (0, "weights", gltf.accessor("SCALAR", [0, 0, 1, 0, 0, 1]), "STEP")]
    gltf.root["animations"] = [{
        "name": "walk",
        "samplers": [{"input": times, "output": output, "interpolation": how}
                     for _, _, output, how in tracks],
        "channels": [{"sampler": i, "target": {"node": node, "path": path}}
                     for i, (node, path, _, _) in enumerate(tracks)]}]
    return gltf


def instances():
    gltf = Gltf("EXT_mesh_gpu_instancing", "KHR_mesh_quantization")
    gltf.root["extensionsRequired"] = ["KHR_mesh_quantization"]
    attributes = {"TRANSLATION": gltf.accessor("VEC3", [0, 0, 0, 2, 0, 0, 0, 2, 0]),
                  "ROTATION": gltf.accessor("VEC4", [0, 0, 0, 1] * 3),
                  "SCALE": gltf.accessor("VEC3", [1, 1, 1, 2, 1, 1, 1, 0.5, 1])}
    corners = gltf.accessor("VEC3", [0, 0, 0, 200, 0, 0, 0, 200, 0], SHORT)
    gltf.show({"attributes": {"POSITION": corners}}, scale=[0.01] * 3,
              extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})
    return gltf


def meshopt():
    """Vertices and indices as meshopt's codecs write them when nothing can be predicted."""
    name = "EXT_meshopt_compression"
    gltf = Gltf(name)
    # Version 1, an index per triangle code; version 0 of the vertex codec, all groups of zeros.
    streams = [("TRIANGLES", 2, 3, bytes([0xe1, 0xf0, *([0] * 16)])),
               ("ATTRIBUTES", 12, 4, bytes([0xa0, *([0] * 12), *([0] * 32)])),
               ("INDICES", 2, 3, bytes([0xd1, 0, 4, 4, 0, 0, 0, 0]))]
    for mode, stride, count, data in streams:
        packed = gltf.view(data)
        source = gltf.root["bufferViews"][packed]
        gltf.add("bufferViews", {
            "buffer": 1, "byteLength": stride * count,
            "extensions": {name: {"buffer": 0, "byteOffset": source["byteOffset"],
                                  "byteLength": len(data), "byteStride": stride, "count": count,
                                  "mode": mode, "filter": "NONE"}}})
    gltf.add("accessors", {"bufferView": 3, "componentType": FLOAT, "count": 4, "type": "VEC3"})
    gltf.add("accessors", {"bufferView": 1, "componentType": SHORT, "count": 3, "type": "SCALAR"})
    gltf.show({"attributes": {"POSITION": 0}, "indices": 1})
    data = base64.b64encode(gltf.bin).decode()
    gltf.root["buffers"] = [{"byteLength": len(gltf.bin),
                             "uri": "data:application/octet-stream;base64," + data},
                            {"byteLength": 1000, "extensions": {name: {"fallback": True}}}]
    return gltf


def draco(text):
    name = "KHR_draco_mesh_compression"
    gltf = Gltf(name)
    view = gltf.view(base64.b64decode(text))
    kinds = [("VEC3", FLOAT, 14), ("VEC2", FLOAT, 14), ("VEC4", BYTE, 14), ("SCALAR", SHORT, 36)]
    made = [gltf.add("accessors", {"componentType": component, "count": count, "type": kind,
                                   "normalized": component == BYTE})
            for kind, component, count in kinds]
    ids = {"POSITION": 7, "TEXCOORD_0": 8, "COLOR_0": 9}
    gltf.show({"attributes": dict(zip(ids, made)), "indices": made[3],
               "extensions": {name: {"bufferView": view, "attributes": ids}}})
    return gltf


def embedded_image(png):
    gltf = Gltf()
    image = gltf.add("images", {"bufferView": gltf.view(png), "mimeType": "image/png"})
    texture = gltf.add("textures", {"source": image})
    gltf.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}})
    gltf.show({**gltf.square(), "material": 0})
    return gltf


def outside_file():
    gltf = Gltf()
    gltf.root["buffers"] = [{"byteLength": 48, "uri": "a.bin"}]
    gltf.add("bufferViews", {"buffer": 0, "byteLength": 48, "byteStride": 16})
    gltf.add("accessors", {"bufferView": 0, "componentType": FLOAT, "count": 3, "type": "VEC3"})
    gltf.show({"attributes": {"POSITION": 0}})
    return gltf


def pictures():
    """Small files in every format, by extension."""
    made = {}
    with tempfile.TemporaryDirectory() as folder:
        for extension in ("png jpg webp exr hdr tif gif bmp tga ico sgi pnm dpx rla iff "
                          "psd dds jp2").split():
            file = Path(folder) / f"a.{extension}"
            alpha = 4 if extension in ("png", "webp", "tga", "ico") else 3
            fill = ["0.1,0.2,0.9,1", "1,0.5,0,1", "0,0.7,0.3,0.5", "1,1,1,1"]
            corners = ":".join(["topleft=" + fill[0], "topright=" + fill[1],
                                "bottomleft=" + fill[2], "bottomright=" + fill[3]])
            run = subprocess.run(["oiiotool", "--create", "9x7", str(alpha),
                                  f"--fill:{corners}", "9x7", "-d", "uint8", "-o", file],
                                 capture_output=True, text=True)
            if run.returncode == 0 and file.exists():
                made[extension] = file.read_bytes()
            else:
                print(f"no {extension}: {run.stdout.strip()[:80]}", file=sys.stderr)
    return made


def pair(first, second, formats=0, bits=0):
    return bytes([formats, bits]) + struct.pack("<I", len(first))[:3] + first + second


def write(target, name, content):
    folder = CORPUS / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def main():
    shutil.rmtree(CORPUS, ignore_errors=True)
    images = pictures()
    models = {function.__name__: function() for function in (
        plain, vertex_data, modes, sparse, materials, polish, variants, lights_and_cameras, motion,
        instances, meshopt, outside_file)}
    models["embedded_image"] = embedded_image(images["png"])
    for name, text in zip(("draco_sequential", "draco_edge_breaker"), DRACO):
        models[name] = draco(text)
    for name, gltf in models.items():
        write("gltf", name + ".gltf", gltf.text())
        write("glb", name + ".glb", gltf.glb())
    for name, text in OBJ.items():
        write("obj", name + ".obj", text)
    for name, text in MTL.items():
        write("mtl", name + ".mtl", text)
    for name, text in SIDECARS.items():
        write("sidecar", name + ".toml", text)
    for name, text in SETTINGS.items():
        write("sidecar", name + ".set", "--set\n" + text)
    formats = {"tga": 1, "ico": 2, "sgi": 3, "dpx": 4, "rla": 6, "iff": 7}
    for bits, (extension, image) in enumerate(images.items()):
        code = formats.get(extension, 0)
        write("compare", extension, pair(images["png"], image, code << 4, bits * 5))
    total = sum(file.stat().st_size for file in CORPUS.rglob("*") if file.is_file())
    print(f"{total / 1000:.0f} kB in {CORPUS}")


if __name__ == "__main__":
    main()
