"""Holds the programs of bench/ against penumbra's own account of a scene; nothing is timed.

  python3 bench/check.py PENUMBRA FLOOR SCENE VIRTUAL_SOURCES
"""

import json
import pathlib
import subprocess
import sys
import tempfile

penumbra, floor, scene, sources = sys.argv[1:]
small = ["--set", "render.size=[64,48]"]


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def same(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: {found} in place of {expected}")


info = json.loads(output(penumbra, "info", scene, "--json"))
traced = json.loads(output(floor, scene, *small))
same("facets of the floor", traced["facets"], info["facets"])
same("sources of the floor", traced["sources"], int(sources))
same("primary rays", traced["rays"]["primary"], 64 * 48)
most = (traced["rays"]["primary"] + traced["rays"]["mirror"]) * int(sources)
if not 0 < traced["rays"]["blocked"] < traced["rays"]["shadow"] <= most:
    sys.exit(f"shadow rays: {traced['rays']}")

with tempfile.TemporaryDirectory() as folder:
    file = pathlib.Path(folder) / "scene.dat"
    output(penumbra, "export", scene, "-o", str(file), *small)
    words = file.read_text().split()
meshes = [int(words[i + 1]) for i, word in enumerate(words) if word == "TRIMESH"]
same("facets for Tachyon", sum(meshes) + words.count("TRI"), info["facets"])
same("sources for Tachyon", words.count("LIGHT"), int(sources))
same("planes for Tachyon", words.count("PLANE"), info["planes"])
same("spheres for Tachyon", words.count("SPHERE"), info["spheres"])
