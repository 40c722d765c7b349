#!/bin/sh
# POV-Ray 3.7: whether the unseen back of a facet casts a shadow depends on how its front is painted.
#
# A mesh whose interior_texture is fully transparent shows one side of its facets, as formats with
# single-sided materials want it. With a plain opaque texture on the front the object blocks light
# from either side. With a texture_map on the front, even one that mixes a texture with itself, it
# blocks light from the front alone: POV-Ray takes only plain textures for opaque, and asks whatever
# is not opaque for the interior_texture, too, when a shadow ray comes from behind.
#
# One would expect the same shadow from the same surface. An exporter that turns a roughness image
# into a texture_map loses the shadows of all backs; a second object of the same mesh with no_image
# and no_reflection, beside no_shadow on the first, brings them back.
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

# The brightness of the ground beneath a facet that turns its back to the light, and of the same
# ground in the sun. The camera looks at the ground from below the facet.
brightness() {
    cat > "$1.pov" <<POV
#version 3.7;
global_settings { assumed_gamma 1 }
#declare Clay = texture { pigment { rgb 0.5 } finish { ambient 0 diffuse 1 } }
#declare Nothing = texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 } }
camera { orthographic location <0, 0.5, 0> look_at <0, 0, 0.001> right x * 0.2 up z * 0.2 }
light_source { <0, 100, 0>, 1 parallel point_at <0, 0, 0> }
plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }
mesh2 {
  vertex_vectors { 3, <-3, 1, -3>, <3, 1, -3>, <0, 1, 4> }
  face_indices { 1, <0, $2> }
  $3
}
POV
    HOME=$folder/home LD_LIBRARY_PATH=$lib root/usr/bin/povray "+I$1.pov" "+O$1.ppm" +FP8 +W8 +H8 -D \
        +GA > "$1.txt" 2>&1 || { cat "$1.txt" && exit 2; }
    python3 -c "import sys; print(open(sys.argv[1], 'rb').read()[-8 * 8 * 3:][96])" "$1.ppm"
}

HOME=$folder/home LD_LIBRARY_PATH=$lib root/usr/bin/povray --version 2>&1 | grep -m1 "POV-Ray 3" || true
plain='texture { Clay } interior_texture { Nothing }'
mixed='texture { gradient y texture_map { [0 Clay] [1 Clay] } } interior_texture { Nothing }'
for way in '1, 2' '2, 1'; do
    a=$(brightness plain "$way" "$plain")
    b=$(brightness mixed "$way" "$mixed")
    echo "corners 0, $way: the ground has $a under a plain texture, $b under a texture_map"
    results="${results:-}$a $b "
done
case $results in
    "0 0 0 255 " | "0 255 0 0 ") echo "as found: from one side light comes through the texture_map alone" ;;
    *) echo "CHANGED: $results" && exit 1 ;;
esac
