"""Models whose every name is code, and the same models with harmless names."""
import base64
import json
import re
import struct
import zlib
from pathlib import Path

# CANARY stands for a file that any of this would create if it ran.
POVRAY = [
    '*/ #fopen F "CANARY" write #write (F, "x") #fclose F /*',
    '"; #fopen F "CANARY" write #write (F, "x") #fclose F #declare X = "',
    '\n#fopen F "CANARY" write #write (F, "x") #fclose F\n',
    '\r\n#error "carriage return"\r\n', '\x0b#error "vertical tab"', '\x0c#error "form feed"',
    '\u2028#error "line separator"', '\u0085#error "next line"', '#include "/etc/passwd"',
    '} union { } #declare Model_scale = 1e9; {', 'union', 'Camera', 'clock', '#end #end #end', '/*',
    '*/', '//', '\\', '\\"', '";', "'", '`', '', ' ', '1', '_', '-', '.', '..', '../../CANARY',
    '\nPre_Scene_Command="touch CANARY"\n', '+ICANARY.pov', '+OCANARY', '-D',
]
SHELL = [
    '$(touch CANARY)', '`touch CANARY`', "'; touch CANARY; '", '"; touch CANARY; "',
    '| touch CANARY', '&& touch CANARY', '; touch CANARY #', '> CANARY', '\ntouch CANARY\n',
    '${IFS}touch${IFS}CANARY', '--output=CANARY', '--report', '-oCANARY', '~root', '*', '?', '%s%n%p',
    '{}', '{0}', '{:>999999999}', '{out}', '%{CANARY}',
]
MARKUP = [
    '<script>document.title = "CANARY"</script>', '"><img src=x onerror=alert(1)>',
    "' onmouseover='alert(1)", '</title><h1>', '</script><script>alert(1)</script>', '</td></tr>',
    '<svg/onload=alert(1)>', '<!--', '-->', ']]><x/>', '&lt;b&gt;', '&#60;', '&amp', '<a href="//x">',
    'javascript:alert(1)', '<?php touch CANARY ?>', '<!DOCTYPE x [<!ENTITY y SYSTEM "/etc/passwd">]>',
    '&y;', '<style>*{display:none}</style>', '<base href="//x/">', '<meta http-equiv=refresh>',
    '| a | b |', '[x](javascript:alert(1))', '![x](//x/y.png)', '`code`', '\n# heading\n',
    '\n| --- | --- |\n', '@everyone', '::error::x', '\n::set-output name=x::y\n', '\\|',
    '"}], "verdict": "pass", "x": [{"y": "', '\\u0022',
]
TERMINAL = [
    '\x1b[2J\x1b[1;1H', '\x1b]0;CANARY\x07', '\x1b]52;c;Q0FOQVJZ\x07', '\x1bP+q\x1b\\', '\u009b31m',
    '\u0090q\u009c', '\u009d0;CANARY\u009c', '\u202egnp.tac', '\u2066x\u2069', '\u200f', '\u061c',
    '\r', '\b\b\b\b', '\x7f', '\x00', '\x00x', '\x0e', '\t\t', '\ufeff', '\ufffe', '\U000e0041',
    'a\nEverything is rendered and exported exactly.', 'A' * 5000, 'e\u0301' * 300, '\u4e2d\u6587',
]
ALL = POVRAY + SHELL + MARKUP + TERMINAL


def payloads(canary):
    return [name.replace("CANARY", str(canary)) for name in ALL] + [
        name for name in ALL if "CANARY" in name]


def png():
    """A picture of 2 x 2 pixels."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    rows = b"".join(b"\0" + bytes(row) for row in ([255, 0, 0, 0, 255, 0], [0, 0, 255, 9, 9, 9]))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def gltf(names):
    """Every kind of thing once for each of `names`, in a square of triangles."""
    points = [-0.5, 0, 0, 0.4, 0, 0, 0, 0.9, 0.1]
    data = struct.pack("<9f6f", *points, 0, 0, 1, 0, 0, 1)
    side = int(len(names) ** 0.5) + 1
    image = "data:image/png;base64," + base64.b64encode(png()).decode()
    root = {
        "asset": {"version": "2.0", "generator": names[0], "copyright": names[1]},
        "extensionsUsed": ["KHR_lights_punctual"] + [f"{name}x" for name in names[:40]],
        "scenes": [{"nodes": list(range(len(names) + 1)), "name": names[2], "extras": {names[3]: names}}],
        "extras": names,
        "buffers": [{"byteLength": len(data), "name": names[4], "uri":
                     "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 36, "name": names[5]},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "name": names[6], "min": [-0.5, 0, 0], "max": [0.4, 0.9, 0.1]},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
        # A camera that sees all of them.
        "nodes": [{"name": names[8], "camera": 0,
                   "translation": [side / 2, side / 2, side * 1.6]}],
        "cameras": [{"name": names[9], "type": "perspective",
                     "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [], "materials": [], "textures": [], "images": [],
        "samplers": [{"name": names[7]}],
        "extensions": {"KHR_lights_punctual": {"lights": []}, **{f"{n}x": {n: n} for n in names[:40]}},
    }
    for i, name in enumerate(names):
        node = {"name": name, "mesh": i, "translation": [i % side, i // side, 0],
                "extras": {name: name}, "extensions": {f"{name}x": name}}
        if i % 8 == 0:
            node["camera"] = len(root["cameras"])
            root["cameras"].append({"name": name, "type": "perspective",
                                    "perspective": {"yfov": 0.8, "znear": 0.1}})
        if i % 16 == 0:
            lights = root["extensions"]["KHR_lights_punctual"]["lights"]
            node["extensions"]["KHR_lights_punctual"] = {"light": len(lights)}
            lights.append({"name": name, "type": "point", "intensity": 5})
        root["nodes"].append(node)
        root["meshes"].append({"name": name, "primitives": [
            {"attributes": {"POSITION": 0, "TEXCOORD_0": 1, f"_{name}": 0, "TEXCOORD_1": 1},
             "material": i}]})
        material = {"name": name, "doubleSided": True, "extensions": {f"{name}x": {name: name}},
                    "pbrMetallicRoughness": {"roughnessFactor": 0.7, "metallicFactor": 0.1}}
        if i % 4 == 0:  # each with an image of its own, and every other by a name that is not there
            material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": len(root["textures"])}
            root["textures"].append({"name": name, "source": len(root["images"]), "sampler": 0})
            uri = image if i % 8 else f"{name}.png"
            root["images"].append({"name": name, "uri": uri})
        root["materials"].append(material)
    return json.dumps(root).encode()


def flat(name):
    """As a name in a format of lines."""
    line = "".join(" " if ord(c) < 32 else c for c in name).strip() or "empty"
    return line.replace("# ", "#")  # else a comment would begin


def word(line):
    """As the name of a file that is not there: in the model's folder and in one word."""
    return re.sub(r"^[-.]+", "", re.sub(r"[\s/\\\\]", "_", line))


def obj(names, library):
    """OBJ and MTL, whose names end with the line; some are no UTF-8."""
    model, materials = [f"mtllib {library}", f"# {flat(names[0])}"], []
    side = int(len(names) ** 0.5) + 1
    for i, name in enumerate(names):
        x, y, line = i % side, i // side, f"{flat(name)} {i}"
        model += [f"v {x - 0.5} {y} 0", f"v {x + 0.4} {y} 0", f"v {x} {y + 0.9} 0.1", f"vt {x % 2} 0.5",
                  f"o {line}", f"g {line}", f"usemtl {line}", f"f {3 * i + 1}/1 {3 * i + 2}/1 {3 * i + 3}/1",
                  f"mtllib {word(line)}.mtl" if i % 9 == 0 else "", f"x{i}{line.split()[0]} {line}"]
        materials += [f"newmtl {line}", "Kd 0.5 0.6 0.7", f"map_Kd {word(line)}.png" if i % 5 == 0 else "",
                      f"q{i}{line.split()[0]} {line}"]
    encode = lambda lines: ("\n".join(lines) + "\n").encode()
    return encode(model), encode(materials)


def sidecar(names):
    text = json.dumps  # TOML's basic strings take the same escapes
    lines = ["[camera]", "position = [0, 1, 8]", "look_at = [0, 1, 0]"]
    for i, name in enumerate(names):
        # TOML allows no escape of surrogates and 0x7f only as one.
        quoted = "".join(f"\\u{ord(c):04x}" if ord(c) < 32 or 126 < ord(c) < 0x10000 else
                         f"\\U{ord(c):08x}" if ord(c) > 0xffff else text(c)[1:-1] for c in name)
        lines += [f'[material."{quoted}x"]', "color = [0.4, 0.5, 0.6]", "[[sphere]]",
                  f'name = "{quoted}"', f"center = [{i % 12 - 6}, {i // 12 - 4}, 0]", "radius = 0.3",
                  f'material = "{quoted}x"']
    return "\n".join(lines).encode() + b"\n"


def write(folder, names):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.gltf").write_bytes(gltf(names))
    model, materials = obj(names, "model.mtl")
    (folder / "model.obj").write_bytes(model)
    (folder / "model.mtl").write_bytes(materials)
    (folder / "studio.toml").write_bytes(sidecar(names))


def file_names():
    """Names that a file can have, of models."""
    kept = [name for name in ALL if "/" not in name and "\0" not in name and 0 < len(name) < 100]
    return [name for name in kept if name not in (".", "..")] + [".", ".."]  # "...gltf"
