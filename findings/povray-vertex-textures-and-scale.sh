#!/bin/sh
# POV-Ray 3.7: the same mesh in the same picture shows other colours when everything is a hundred
# times as large.
#
# Where the three corners of a mesh2 facet have textures of their own, POV-Ray mixes these by weights
# that are quotients of 2 x 2 determinants, in the mesh's own units. It takes the first pair of axes
# whose divisor, squared, is 1e-10 or more, to tell a flat projection from a good one. That limit is
# absolute: of a facet parallel to the z axis the projection along z is a line, its determinant is
# float32's rounding, and this rounding grows with the square of the scene's size. In a scene of a
# hundred units it passes for a good projection, and the facet gets weights at random.
#
# One would expect that scaling a scene, camera and lights with it, changes nothing but rounding.
# Exporters to POV-Ray meet it as soon as a model with vertex colours is in centimetres.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -q povray=1:3.7.0.10-2+b2 > apt.txt 2>&1 || {
    echo "povray 1:3.7.0.10-2+b2 (Debian 12) is not to be had here:" && cat apt.txt && exit 2
}
closure=$(apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks \
    --no-replaces --no-enhances povray | grep '^[a-z]' | grep -v '^libc6$\|^povray$')
for package in $closure; do apt-get download -q "$package" >> apt.txt 2>&1 || true; done
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$folder/root/usr/lib/$(uname -m)-linux-gnu
mkdir -p home

# A facet that leans about the z axis, red, green and blue at its corners, lit by itself, seen
# straight on. Everything is multiplied by S; the numbers are of no importance.
picture() {
    cat > "s$1.pov" <<POV
#version 3.7;
global_settings { assumed_gamma 1 }
#declare S = $1;
#declare Glow = finish { ambient 1 diffuse 0 };
camera { orthographic location <-5, 1, 0> * S look_at <0, 0, 0> right z * 2 * S up y * 2 * S }
mesh2 {
  vertex_vectors { 3, <-0.29684198, -0.2628065, 0.4313357> * S, <-0.29684198, -0.2628065, -0.3313357> * S,
                   <-0.45312260, 0.4477193, -0.1471143> * S }
  texture_list { 3, texture { pigment { rgb x } finish { Glow } } texture { pigment { rgb y } finish { Glow } }
                 texture { pigment { rgb z } finish { Glow } } }
  face_indices { 1, <0, 1, 2>, 0, 1, 2 }
}
POV
    HOME=$folder/home LD_LIBRARY_PATH=$lib root/usr/bin/povray "+Is$1.pov" "+Os$1.ppm" +FP8 +W64 +H64 \
        -D +GA > "s$1.txt" 2>&1 || { cat "s$1.txt" && exit 2; }
}

# Of the pixels of the facet the share whose colour is another one by more than 8 of 255.
compare() {
    python3 - "$1" "$2" <<'PYTHON'
import sys


def pixels(name):
    data = open(name, "rb").read()
    return data[-64 * 64 * 3:]


a, b = map(pixels, sys.argv[1:])
facet = [i for i in range(0, len(a), 3) if any(a[i:i + 3])]
other = sum(max(abs(a[i + c] - b[i + c]) for c in range(3)) > 8 for i in facet)
print(len(facet), "pixels of the facet,", other, "of another colour")
sys.exit(0 if len(facet) > 100 else 2)
PYTHON
}

HOME=$folder/home LD_LIBRARY_PATH=$lib root/usr/bin/povray --version 2>&1 | grep -m1 "POV-Ray 3" || true
for scale in 1 8 100 1000; do picture "$scale"; done
for scale in 8 100 1000; do
    printf 'size 1 and size %s: ' "$scale"
    compare s1.ppm "s$scale.ppm" | tee "c$scale.txt"
done
grep -q ', 0 of another' c8.txt || { echo "CHANGED: size 8 is not as size 1 any more"; exit 1; }
grep -q ', 0 of another' c1000.txt && { echo "CHANGED: size 1000 is as size 1"; exit 1; }
echo "as found: the colours of a facet depend on the size of its scene"
