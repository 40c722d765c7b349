"""Makes the models of bench/scenes: a fluted torus knot in any number of facets, and many of them.

  python3 bench/models.py FOLDER

Needs nothing but Python 3. The same bytes come out every time.
"""

import array
import json
import math
import os
import pathlib
import random
import struct
import sys
import zlib


class Surface:
    """A smooth mesh in flat arrays."""

    def __init__(self):
        self.positions, self.normals = array.array("f"), array.array("f")
        self.texcoords, self.triangles = array.array("f"), array.array("I")


def knot_frame(t):
    """Centre, its derivative, the torus' normal and the third axis, and the derivatives of both."""
    c2, s2, c3, s3 = math.cos(2 * t), math.sin(2 * t), math.cos(3 * t), math.sin(3 * t)
    ring = 2 + c3
    center = (ring * c2, s3, ring * s2)
    speed = (-3 * s3 * c2 - 2 * ring * s2, 3 * c3, -3 * s3 * s2 + 2 * ring * c2)
    normal = (c3 * c2, s3, c3 * s2)
    length = math.hypot(*speed)
    x, y, z = (v / length for v in speed)
    across = (y * normal[2] - z * normal[1], z * normal[0] - x * normal[2],
              x * normal[1] - y * normal[0])
    return center, speed, normal, across


def knot(facets, texcoords=False):
    """A (2, 3) torus knot, 6.9 wide and 2.9 high, whose tube has three winding flutes."""
    around = round(math.sqrt(facets / 20))
    along = round(facets / (2 * around))
    surface = Surface()
    circle = [(math.cos(a), math.sin(a), math.cos(3 * a), math.sin(3 * a))
              for a in (2 * math.pi * j / around for j in range(around))]
    for i in range(along + 1 if texcoords else along):
        add_ring(surface, 2 * math.pi * i / along, circle)
        if texcoords:
            for j in range(around):
                surface.texcoords.extend((12 * i / along, abs(2 * j / around - 1)))
    rings = along + 1 if texcoords else along
    for i in range(along):
        row, next_row = i * around, (i + 1) % rings * around
        for j in range(around):
            k = (j + 1) % around
            surface.triangles.extend((row + j, next_row + j, next_row + k,
                                      row + j, next_row + k, row + k))
    return surface


def add_ring(surface, t, circle):
    step = 1e-4
    center, speed, n, b = knot_frame(t)
    after, before = knot_frame(t + step)[2:], knot_frame(t - step)[2:]
    dn, db = ([(p - q) / (2 * step) for p, q in zip(*pair)] for pair in zip(after, before))
    c_twist, s_twist = math.cos(9 * t), math.sin(9 * t)
    positions, normals = surface.positions, surface.normals
    for c, s, c3, s3 in circle:
        wave, slope = c3 * c_twist - s3 * s_twist, s3 * c_twist + c3 * s_twist
        r, r_around, r_along = 0.4 * (1 + 0.12 * wave), -0.144 * slope, -0.432 * slope
        ox, oy, oz = (c * n[k] + s * b[k] for k in range(3))  # outwards
        positions.extend((center[0] + r * ox, center[1] + r * oy, center[2] + r * oz))
        # The derivatives by the angle around the tube, u, and along the knot, v.
        ux, uy, uz = (r_around * o + r * (c * b[k] - s * n[k]) for k, o in enumerate((ox, oy, oz)))
        vx, vy, vz = (speed[k] + r * (c * dn[k] + s * db[k]) + r_along * o
                      for k, o in enumerate((ox, oy, oz)))
        x, y, z = uz * vy - uy * vz, ux * vz - uz * vx, uy * vx - ux * vy
        length = math.sqrt(x * x + y * y + z * z)
        normals.extend((-x / length, -y / length, -z / length))


# ---- files --------------------------------------------------------------------------------------

def write_obj(path, surface, material, texture=None):
    """An OBJ and its MTL; `texture` is the name of an image beside them."""
    lines = [f"mtllib {path.stem}.mtl", f"usemtl {material}"]
    triples = lambda kind, v: [f"{kind} {v[i]:.6g} {v[i + 1]:.6g} {v[i + 2]:.6g}"
                               for i in range(0, len(v), 3)]
    lines += triples("v", surface.positions) + triples("vn", surface.normals)
    t = surface.texcoords
    lines += [f"vt {t[i]:.6g} {t[i + 1]:.6g}" for i in range(0, len(t), 2)]
    corner = "{0}/{0}/{0}" if t else "{0}//{0}"
    corners = [corner.format(i + 1) for i in surface.triangles]
    lines += ["f " + " ".join(corners[i:i + 3]) for i in range(0, len(corners), 3)]
    path.write_text("\n".join(lines) + "\n")
    image = f"map_Kd {texture}\n" if texture else ""
    path.with_suffix(".mtl").write_text(f"newmtl {material}\n{image}")


def write_glb(path, surface, materials, nodes):
    """A mesh for each name in `materials`, all of one geometry; each node names its mesh."""
    parts = [surface.positions.tobytes(), surface.normals.tobytes(), surface.triangles.tobytes()]
    count = len(surface.positions) // 3
    axes = [surface.positions[k::3] for k in range(3)]
    views, offset = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "materials": [{"name": name, "pbrMetallicRoughness": {"metallicFactor": 0}}
                      for name in materials],
        "meshes": [{"name": name, "primitives": [{
            "attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": i}]}
            for i, name in enumerate(materials)],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
             "min": [min(a) for a in axes], "max": [max(a) for a in axes]},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5125, "count": len(surface.triangles),
             "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": offset}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + offset))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", offset, b"BIN\0"))
        for part in parts:
            file.write(part)


def write_png(path, side, texel):
    """A square of 8-bit sRGB; texel(x, y) gives (r, g, b)."""
    rows = b"".join(b"\0" + bytes(v for x in range(side) for v in texel(x, y)) for y in range(side))

    def chunk(kind, data):
        check = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + check

    header = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


def tiles_texel(x, y):
    """Glazed tiles with pale joints, which repeat every 512 texels."""
    u, v = x % 128, y % 128
    if min(u, v) < 5:
        return 196, 190, 178
    petals = math.cos(4 * math.atan2(v - 66, u - 66)) * math.hypot(v - 66, u - 66)
    shade = 12 * ((x // 128 * 3 + y // 128 * 5) % 4)
    return (214 - shade, 150 - shade, 92) if petals > 18 else (44 + shade, 92 + shade, 122 + shade)


def stripes_texel(x, y):
    wave = math.sin((x + 40 * math.sin(2 * math.pi * y / 512)) * 2 * math.pi / 64)
    t = 0.5 + 0.5 * max(-1.0, min(1.0, 3 * wave))
    return tuple(round(a + (b - a) * t) for a, b in zip((190, 64, 40), (244, 226, 190)))


def field(count):
    """Nodes of `count` small knots on the ground, turned at random, of four meshes."""
    rng, nodes, columns = random.Random(4), [], 40
    for i in range(count):
        angle, tilt = rng.uniform(0, 2 * math.pi), rng.uniform(-0.5, 0.5)
        size = rng.uniform(0.10, 0.16)
        x = (i % columns - columns / 2 + rng.uniform(0.2, 0.8)) * 1.05
        z = -(i // columns + rng.uniform(0.2, 0.8)) * 1.05
        turn = [math.sin(tilt / 2) * math.cos(angle), math.sin(angle / 2) * math.cos(tilt / 2),
                math.sin(tilt / 2) * math.sin(angle), math.cos(angle / 2) * math.cos(tilt / 2)]
        length = math.hypot(*turn)
        y = size * (3.45 * abs(math.sin(tilt)) + 1.47 * math.cos(tilt))
        nodes.append({"mesh": rng.randrange(4), "translation": [x, y, z],
                      "rotation": [v / length for v in turn], "scale": [size] * 3})
    return nodes


# ---- all of them --------------------------------------------------------------------------------

def one_knot(path, facets):
    write_glb(path, knot(facets), ["knot"], [{"mesh": 0}])


RECIPES = {
    "knot-5k.obj": lambda path: write_obj(path, knot(5000), "knot"),
    "knot-10k.glb": lambda path: one_knot(path, 10_000),
    "knot-100k.glb": lambda path: one_knot(path, 100_000),
    "knot-1m.glb": lambda path: one_knot(path, 1_000_000),
    "knot-4m.glb": lambda path: one_knot(path, 4_000_000),
    "tiles.png": lambda path: write_png(path, 1024, tiles_texel),
    "stripes.png": lambda path: write_png(path, 512, stripes_texel),
    "knot-painted.obj": lambda path: write_obj(path, knot(40_000, True), "painted", "stripes.png"),
    "field.glb": lambda path: write_glb(path, knot(5000), ["amber", "jade", "brick", "slate"],
                                        field(2000)),
}


def main():
    """Makes what is missing in the folder that the command line names, or older than this file."""
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, write in RECIPES.items():
        path = folder / name
        if path.exists() and path.stat().st_mtime >= os.stat(__file__).st_mtime:
            continue
        print(f"making {path}", file=sys.stderr)
        write(path)


if __name__ == "__main__":
    main()
