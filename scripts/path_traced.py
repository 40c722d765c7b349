"""What `scripts/gallery --cycles` does: penumbra's default pictures beside Blender's Cycles."""
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs/images/cycles"
PAGE = ROOT / "docs/look.md"
SIZE = (320, 240)
STRIP = (200, 150)  # of each of the three pictures of a row
FLOOR_ALBEDO = 0.6  # of the studio's floor, docs/sidecar.md

# Models of many kinds, without lights of their own, which both programs read alike.
MODELS = [
    "Box", "Fox", "robot", "balloon", "garage", "camp", "Avocado", "Suzanne", "NormalTangentTest",
    "MetalRoughSpheresNoTextures", "SheenChair", "ClearCoatTest", "GlassVaseFlowers",
    "TransmissionTest",
]

HEADER = """# Beside a path tracer

penumbra's default picture of a model beside the same model drawn by Blender's path tracer Cycles:
the same camera, environment, floor and background, the model read by Blender's own importer.
Written by `scripts/gallery --cycles FOLDER` with {blender}; {width} x {height}, {samples} samples.
In each row: penumbra, Cycles, and where FLIP sees a difference (dark: none).

FLIP is the mean over the picture (`all`) or over the pixels that the model covers (`model`), and
the worst tile of 16 x 16 pixels of the picture; 0 is the same picture. `before` is what penumbra
drew by default until 0.2 (`--studio black --samples 1`), against the same reference: most of its
difference in `all` is its black background, so that `model` is the figure to look at.

Arranged to be the same: below the horizon the environment is what the studio's floor sends back, and
the floor itself, which the camera sees and glass shows, gives no light and throws no shadow; what lies
behind the scene is one colour, and mirrors show the environment. Arranged as glTF says, where Blender
3.4 does otherwise: the diffuse term is Lambert's (Blender's Burley term is up to 1.4 times
as bright at grazing light), a coat is a layer of index 1.5 (Blender's has a quarter of that), glass without a volume is thin, sheen takes from the base what it gives, and rough metals
lose no light. Not the same: Cycles has light from one surface to another ({bounces} diffuse bounces) and
shows both sides of every surface; Blender's importer leaves out anisotropy, iridescence and the
vertex colours of meshes without a material.

| model | penumbra, Cycles, FLIP | all, before | all | model, before | model | tile, before | tile |
|---|---|--:|--:|--:|--:|--:|--:|
"""

FOOTER = """
The noise of the reference is a part of every figure.
"""


def run(*command, environment=None):
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    if done.returncode:
        raise RuntimeError(f"{words[0]} failed:\n{(done.stderr or done.stdout).strip()}")
    return done.stdout


def numbers(pattern, text):
    found = re.search(pattern, text, re.DOTALL)
    return [float(word) for word in found.group(1).split(",")] if found else None


def vector(name, text):
    return numbers(rf"\b{name}\s+<([^>]*)>", text)


def seen(penumbra, model, folder):
    """Camera, floor and background of the default picture, in the model's space."""
    scene = folder / "scene.pov"
    run(penumbra, "export", model, "--size", f"{SIZE[0]}x{SIZE[1]}", "--normal-maps", "drop",
        "--quiet", "--force", "-o", scene)
    text = scene.read_text()
    scale = numbers(r"Model_scale = ([^;]*);", text)[0]
    offset = numbers(r"Model_offset = <([^>]*)>", text)
    camera = re.search(r"\ncamera \{.*?\n\}", text, re.DOTALL).group(0)
    if "directional light" not in text or "environment studio" not in text:
        raise ValueError("it brings its own light: choose a model that gets the studio")
    orthographic = "orthographic" in camera
    size = scale if orthographic else 1
    floor = numbers(r"plane \{ <0, 1, 0>, ([^ ]*) texture \{ Material_studio_floor", text)
    return {
        "camera": {
            "position": [p / scale + o for p, o in zip(vector("location", camera), offset)],
            "right": [x / size for x in vector("right", camera)],
            "up": [x / size for x in vector("up", camera)],
            "direction": vector("direction", camera),
            "orthographic": orthographic,
        },
        "background": numbers(r"background \{ rgb <([^>]*)>", text),
        "floor": floor[0] / scale + offset[1] if floor else None,
    }


def studio_image(penumbra, folder):
    """The studio over its floor as penumbra exports it for POV-Ray, where a mirror shows it."""
    scene = folder / "mirror.toml"
    scene.write_text('[material.mirror]\nreflection = 1\n'
                     '[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "mirror"\n')
    run(penumbra, "export", scene, "--quiet", "--force", "-o", folder / "mirror.pov")
    return folder / "mirror_textures/studio_over_its_floor.exr"


def job_of(asset, options, folder, environment):
    model = options.folder / asset["file"]
    low, high = (json.loads(run(options.penumbra, "info", model, "--json", "--quiet"))["bounds"][k]
                 for k in ("min", "max"))
    radius = sum((b - a) ** 2 for a, b in zip(low, high)) ** 0.5 / 2
    script = (ROOT / "scripts/cycles_reference.py").read_bytes()
    return {"name": asset["name"], "script": hashlib.sha256(script).hexdigest(),
            "model": str(model.resolve()),
            "size": SIZE, "radius": radius,
            "environment": str(environment.resolve()), "albedo": FLOOR_ALBEDO,
            "samples": options.cycles_samples, "diffuse_bounces": options.cycles_bounces,
            "floor_gives_light": options.cycles_floor_light, "rewire": not options.cycles_burley,
            "output": str((folder / "cycles.exr").resolve()),
            **seen(options.penumbra, model, folder)}


def draw_ours(asset, options, folder):
    model = options.folder / asset["file"]
    size = ["--size", f"{SIZE[0]}x{SIZE[1]}", "--quiet"]
    run(options.penumbra, "render", model, *size, "-o", folder / "ours.exr")
    before = ["--studio", "black", "--samples", "1"]
    run(options.penumbra, "render", model, *size, *before, "-o", folder / "before.exr")
    # What the model covers: whatever differs from a background that nothing else looks like.
    run(options.penumbra, "render", model, *size, *before, "--background", "50,0,50", "-o",
        folder / "key.exr")
    run("oiiotool", folder / "key.exr", "--ch", "R", "--subc", "49.9", "--abs", "--subc", ".101",
        "--mulc", "1e6", "--clamp:min=0:max=1", "-d", "uint8", "-o", folder / "mask.png")


def draw_theirs(jobs, options):
    """Cycles' pictures; those that were asked for with the same words are kept."""
    wanted = []
    for job in jobs:
        kept = pathlib.Path(job["output"]).with_name("job.json")
        if not kept.exists() or kept.read_text() != json.dumps(job) or \
                not pathlib.Path(job["output"]).exists():
            wanted.append((job, kept))
    if not wanted:
        return
    with tempfile.TemporaryDirectory() as name:
        file = pathlib.Path(name) / "jobs.json"
        file.write_text(json.dumps([job for job, _ in wanted]))
        # Debian's Blender looks for Python in PATH and needs the system's, which has numpy.
        output = run(options.blender, "-b", "-noaudio", "--factory-startup",
                     "--python-exit-code", "1", "--python",
                     ROOT / "scripts/cycles_reference.py", "--", file,
                     environment={**os.environ, "PATH": "/usr/bin:/bin"})
    print("\n".join(line for line in output.splitlines() if line.startswith("cycles_reference")))
    for job, kept in wanted:
        kept.write_text(json.dumps(job))


def compared(penumbra, ours, theirs, folder, *more):
    """FLIP's mean and its worst tile; a picture that fails its limits is no error here."""
    done = subprocess.run([penumbra, "compare", ours, theirs, "--json", "--quiet", "--alpha",
                           "ignore", "--force", "--report", folder, *more],
                          capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr.strip())
    metrics = json.loads(done.stdout)["cases"][0]["metrics"]
    return metrics["flip"]["value"], metrics["flip_tile"]["value"]


def measure(penumbra, folder):
    figures = {}
    for name in ("before", "ours"):
        pair = folder / f"{name}.exr", folder / "cycles.exr"
        mean, tile = compared(penumbra, *pair, folder / f"report-{name}")
        model, _ = compared(penumbra, *pair, folder / f"report-{name}-model",
                            "--mask", folder / "mask.png")
        figures[name] = (mean, model, tile)
    return figures


def strip(folder, target):
    size = f"{STRIP[0]}x{STRIP[1]}"
    for name in ("ours", "cycles"):
        run("oiiotool", folder / f"{name}.exr", "--ch", "R,G,B", "--resize", size,
            "--colorconvert", "linear", "sRGB", "-d", "uint8", "-o", folder / f"{name}-small.png")
    run("oiiotool", folder / "report-ours/flip.png", "--ch", "R,G,B", "--resize", size,
        "-d", "uint8", "-o", folder / "flip-small.png")
    run("oiiotool", "--nosoftwareattrib", folder / "ours-small.png", folder / "cycles-small.png",
        folder / "flip-small.png", "--mosaic:pad=4", "3x1", "--eraseattrib", ".*", "-d", "uint8",
        "--compression", "jpeg:85", "-o", target)


def row(name, figures, picture):
    cells = " | ".join(f"{figures[which][i]:.3f}" for i in range(3) for which in ("before", "ours"))
    return f"| {name} | ![{name}]({picture}) | {cells} |\n"


def summary(all_figures):
    means = {w: [sum(f[w][i] for f in all_figures) / len(all_figures) for i in range(3)]
             for w in ("before", "ours")}
    return row("mean", means, "").replace("![mean]()", "")


def gallery(options, assets):
    """Draws and measures; writes the page if all models were asked for. Returns an exit code."""
    options.penumbra = str(pathlib.Path(options.penumbra).resolve())
    chosen = [a for name in MODELS for a in assets if a["name"] == name and options.only in name]
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    PICTURES.mkdir(parents=True, exist_ok=True)
    environment = studio_image(options.penumbra, work)
    jobs, rows, all_figures, failed = [], [], [], 0
    for asset in chosen:
        folder = work / asset["name"]
        folder.mkdir(exist_ok=True)
        try:
            draw_ours(asset, options, folder)
            jobs.append(job_of(asset, options, folder, environment))
        except (RuntimeError, ValueError) as error:
            print(f"{asset['name']}: {error}", file=sys.stderr)
            failed += 1
    draw_theirs(jobs, options)
    for job in jobs:
        folder = work / job["name"]
        figures = measure(options.penumbra, folder)
        picture = PICTURES / f"{job['name']}.jpg"
        strip(folder, picture)
        rows.append(row(job["name"], figures, picture.relative_to(PAGE.parent)))
        all_figures.append(figures)
        print(rows[-1], end="", flush=True)
    if not options.only and not failed:
        rows.append(summary(all_figures))
        version = run(options.blender, "--version").splitlines()[0]
        PAGE.write_text(HEADER.format(blender=version, width=SIZE[0], height=SIZE[1],
                                      samples=options.cycles_samples,
                                      bounces=options.cycles_bounces) +
                        "".join(rows) + FOOTER)
    return 1 if failed else 0
