"""The seeds of make_corpus.py that are texts: by name."""

CORNERS = ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n"
           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 1 0\n")

OBJ = {
    "triangle": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "indices": CORNERS + "f 1/1/1 2/2/1 3/3/1\nf -5//-1 -4//-1 -3//-1\nf 1/1 3/3 4/4 5/1\nf 1 2 5\n",
    "polygons": "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nv 1 2 0\nv 3 2 0\nv 2 3 1\n"
                "f 1 2 3 4 5\nf 1 2 4 3 5\nf 6 7 8 6\nf 1 1 2\nf 1 6 2 7 3 8\n",
    "words": "\ufeff# a comment\r\nmtllib model.mtl\r\no one\ng two three\ns 1\nusemtl a\nv 0 0 0 1\n"
             "v 1 0 \\\n0 0.5 0.25 1\nv 0 1 0 1 0 0\nvt 0.5\nvt 1 1 0\ns off\nf 1 2 3\nl 1 2\np 1\n"
             "vp 0.5\ncurv 0 1 1 2 3\ncall x.obj\nmg 1 2\nunknown 1\n",
    "materials": "mtllib model.mtl\n" + CORNERS +
                 "usemtl a\nf 1/1/1 2/2/1 3/3/1\nusemtl b\nf 1/1 3/3 4/4\nusemtl c\ns 1\nf 1/1 2/2 5/3\n"
                 "usemtl missing\nf 3 4 5\n"
                 "#mtl\nnewmtl a\nKd 1 0.5 0\nmap_Kd -s 2 2 2 -o 0.5 0 0 a.png\n"
                 "newmtl b\nd 0.5\nKs 1 1 1\nNs 40\nmap_d b.png\n"
                 "newmtl c\nKe 1 1 1\nnorm a.jpg\nPr 0.25\nPm 1\nmap_Pr c.png\n",
    "names": "mtllib a b.mtl \"model.mtl\" ../outside.mtl sub\\model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
             "o \x1b[31m#declare\"*/\nusemtl a b\nf 1 2 3\n#mtl\nnewmtl a b\nmap_Kd ../outside.png\n",
    "numbers": "v 1e38 -1e-38 0\nv 1e300 0 0\nv nan inf 0\nv 1,5 0x1 1.2.3\nf 1 2 99999999999\n",
    "large": "v 1e37 0 0\nv 0 1e37 0\nv 0 0 1e37\nv 1e-37 0 0\nv 0 1e-37 0\nf 1 2 3\nf 3 4 5\n",
}

MTL = {
    "plain": "newmtl a\nKa 0.1 0.1 0.1\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nNs 30\nillum 2\n",
    "glass": "newmtl a\nd 0.25\nTf 0.5 1 1\nNi 1.5\nillum 7\nnewmtl b\nTr 0.5\nnewmtl c\n"
             "illum 9\nKs 1 1 1\nNi 1.33\nd -halo 0.5\n",
    "physical": "newmtl a\nPr 0.3\nPm 0.8\nPs 0.1\nPc 0.5\nPcr 0.1\naniso 0.2\nanisor 0.3\nKe 1 2 3\n"
                "newmtl b\nmap_Pr c.png\nmap_Pm b.png\nmap_Ke a.png\nnorm a.jpg\nmap_RMA b.png\n",
    "maps": "newmtl a\nmap_Kd -s 2 2 1 -o 0.5 0.5 0 -t 0 0 0 -mm 0 1 -clamp on -blendu off a.png\n"
            "map_Ks b.png\nmap_Ns c.png\nmap_d -imfchan m b.png\nbump -bm 0.5 a.png\ndisp a.png\n"
            "decal a.png\nrefl -type sphere a.png\nnewmtl b\nmap_Kd sub\\a.png\nmap_d a.exr\n"
            "newmtl c\nmap_Kd \"a.png\"\nmap_opacity b.png\nnewmtl d\nmap_Kd -texres 2 missing.png\n",
    "names": "newmtl a\nmap_Kd ../outside.png\nnewmtl b\nmap_Kd link.png\nnewmtl c\nmap_Kd /dev/zero\n"
             "newmtl d\nmap_Kd C:\\a.png\n",
    "words": "\ufeffKd 1 1 1\nnewmtl a\r\nKd spectral a.rfl 1\nKd xyz 0.5 0.5 0.5\nKs 1\nNs -5\nNs 1e40\n"
             "Kd nan 1e39 -1\nillum 11\nunknown 1\nnewmtl a\nKd 1 0 0\nnewmtl\n",
}

SIDECARS = {
    "everything": """\
[render]
size = [64, 48]
samples = 2
max_depth = 4
background = "#203040"
exposure = "auto"
[lighting]
ambient = [0.5, 0.5, 0.25]
[camera]
position = [0, 1.2, 5]
look_at = [0, 0.8, 0]
up = [0, 1, 0]
fov = 40
[[light]]
type = "spot"
position = [3, 5, 4]
target = [0, 0, 0]
color = [1, 1, 1]
intensity = 2.0
inner = 15
outer = 25
attenuation = { distance = 10, power = 2 }
penumbra = { delta = 0.1, pattern = "sphere", count = 8 }
[[light]]
type = "directional"
direction = [0, -1, 0.5]
penumbra = { delta = 0.05, pattern = "axes" }
[[light]]
position = [1, 2, 3]
penumbra = { delta = 0.5, pattern = "grid", count = [2, 3], target = [0, 0, 0] }
[[sphere]]
center = [0, 1, 0]
radius = 0.5
material = "mirror"
[[plane]]
point = [0, -1, 0]
normal = [0, 1, 0]
material = "floor"
[material.mirror]
color = [0.9, 0.9, 0.9]
ambient = 0.0
diffuse = 0.2
specular = 0.5
shininess = 60
metallic = 0.5
reflection = [0.6, 0.5, 0.4]
[material.floor]
checker = { colors = [[1, 1, 1], [0, 0, 0]], size = 0.5 }
[material.clay]
noise = { colors = ["#ff8000", "#000000"], size = 0.25, octaves = 4 }
smooth = false
""",
    "models": """\
[[model]]
file = "plain.obj"
translate = [1, 0, 0]
rotate = [0, 90, 10]
scale = [1, 2, 0.5]
material = "glass"
name = "copy"
[[model]]
file = "plain.gltf"
matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1]
[material.glass]
color = [0.9, 1, 0.9]
opacity = 0.25
transmission = 0.5
ior = 1.5
fresnel = true
reflection = 1
absorption = { color = [0.5, 1, 0.5], distance = 2 }
[camera]
name = "eye"
orthographic = 4.0
""",
    "textures": """\
[material.clay]
texture = "a.png"
emission = [0.5, 0, 0]
[[plane]]
material = "wall"
[material.wall]
texture = { file = "b.png", size = 2 }
[[sphere]]
material = "ball"
[material.ball]
texture = "sub/a.png"
[render]
background = "a.exr"
""",
    "wrong": "[render]\nsize = [0, 40000]\nsmaples = 3\n[[sphere]]\nradius = -1\nmaterial = \"\\u001b[31m\"\n",
    "numbers": "[camera]\nposition = [1e300, 0, 0]\nfov = 179.9\n[[sphere]]\nradius = 1e-300\n"
               "center = [1e30, -1e30, 0]\n[[plane]]\nnormal = [1e-200, 0, 0]\n[render]\nexposure = -32\n",
}

SETTINGS = {
    "settings": "render.samples=3\nlighting.ambient=0.1\ncamera.fov=25\nlight.0.intensity=2\n"
                "material.clay.color=[1, 0, 0]\nlight.0.penumbra={delta=0.1}\nrender.background=\"#fff000\"\n",
    "wrong_settings": "render\nrender.size=\n=3\nlight.9.color=1\nmaterial.nobody.ior=2\na.b.c.d=1\n",
}
