#version 3.7;

// A scene, written by penumbra.
//
// Picture:  160 x 120 pixels, one ray each, 5 segments along a path
// Render:   povray meshes.ini     (in this folder)

// POV-Ray's tolerances are absolute, so the scene is scaled by a power of two:
//   position here = (position in the model - Model_offset) * Model_scale
#declare Model_scale = 1;
#declare Model_offset = <0, 0, 0>;

global_settings {
  assumed_gamma 1.0
  max_trace_level 5
  adc_bailout 0
  ambient_light rgb 1
}

background { rgb 0 }

camera {  // eye
  orthographic
  location  <0, 0, 10>
  right     <4, 0, 0>
  up        <0, 3, 0>
  direction <0, 0, -1>
}

// ---- materials ----

#declare Material_clay =
texture {
  pigment { rgb 0.8 }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0.3 phong_size 40
    reflection 0
  }
}

// painted
// pigments: the vertex colours in the geometry
#declare Finish_painted_tinted = finish {
  ambient 0.1 emission 0 diffuse 0.7
  phong 0.3 phong_size 40
  reflection 0
}

// wood
// pigments: the vertex colours in the geometry
#declare Layer_wood_tinted__1 =
texture {
  pigment { uv_mapping image_map { png "meshes_textures/oak.png" gamma srgb interpolate 2 } scale <2, 1, 1> }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0 phong_size 40
    reflection 0
  }
}
#declare Finish_wood_tinted__2 = finish {
  ambient 0 emission 0 diffuse 0
  phong 0.3 phong_size 40
  reflection 0
}

// ---- geometry ----

#include "meshes_geometry.inc"

// ---- lights and objects ----

// In a light_group POV-Ray does not reuse the object that shadowed the last pixel,
// so that the picture does not depend on the order of its pixels.
light_group {
  // lamp: point light
  light_source { <3, 5, 4>, rgb 0.8 }

  // mesh
  object { Mesh_panel texture { Material_clay } }
  // left panel
  object { Mesh_panel translate <-2, 0, 0> texture { Material_clay } }
  // slanted panel
  object { Mesh_panel
    matrix <0, 1, 0,
            -1, 0, 0,
            0, 0, 0.5,
            1, 2, 3>
    texture { Material_clay }
  }
  object { Mesh_panel_2 }
  object { Mesh_panel_3 }
}
