#version 3.7;

// shapes.toml, written by penumbra.
//   penumbra export shapes.toml -o shapes.pov
//
// Picture:  160 x 120 pixels, one ray each, 5 segments along a path
// Render:   povray shapes.ini     (in this folder)
//
// Not carried over exactly:
//   shapes.toml: sheen is ignored

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

background { rgb <0.1, 0.2, 0.3> }

camera {  // eye
  orthographic
  location  <0, 0, 10>
  right     <4, 0, 0>
  up        <0, 3, 0>
  direction <0, 0, -1>
}

// ---- materials ----

// f_noise_generator of functions.inc
#declare Perlin_noise = function { internal(78) }

#declare Material_clay =
texture {
  pigment { rgb <0.8, 0.4, 0.2> }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0.3 phong_size 40
    reflection 0
  }
}

#declare Material_mirror =
texture {
  pigment { rgb 0.8 }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0.3 phong_size 40 metallic 0.5
    reflection { rgb 0.6 metallic 0.5 }
  }
}

// lamp shade
#declare Material_lamp_shade =
texture {
  pigment { rgb <1, 0, 0.5> }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0.3 phong_size 40
    reflection 0
  }
}
texture {  // adds light: emits the more for being all but transparent
  pigment { rgbt <1, 1, 1, 0.99999905> }
  finish {
    ambient 0 emission rgb <524288, 262144, 0> diffuse 0
    phong 0 phong_size 40
    reflection 0
  }
}

#declare Material_glass =
texture {
  pigment { rgbt <0.8, 0.8, 0.8, 0.75> }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0.3 phong_size 40
    reflection 0
  }
}

#declare Material_floor =
texture {
  pigment { checker rgb 1, rgb 0 scale 0.5 translate <0, 1, 0> }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0.3 phong_size 40
    reflection 0
  }
}

#declare Material_cloud =
texture {
  pigment { function { (Perlin_noise(x, y, z, 3)
      + Perlin_noise(2*x, 2*y, 2*z, 3)/2
      + Perlin_noise(4*x, 4*y, 4*z, 3)/4)/1.75 }
    color_map { [0 rgb 0] [1 rgb 1] } scale 2 }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0.3 phong_size 40
    reflection 0
  }
}

// wood
#declare Material_wood_sphere =
texture {
  pigment { uv_mapping image_map { png "shapes_textures/oak.png" gamma srgb interpolate 2 } scale <-1, 1, 1> translate <1, 0, 0> }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0 phong_size 40
    reflection 0
  }
}
texture {
  pigment { rgbf <0.8, 0.8, 0.8, 1> }
  finish {
    ambient 0 emission 0 diffuse 0
    phong 0.3 phong_size 40
    reflection 0
  }
}

// wood
#declare Material_wood_plane =
texture {
  pigment { image_map { png "shapes_textures/oak.png" gamma srgb interpolate 2 }
    matrix <4, 0, 0,  0, 0, -4,  0, 4, 0,  0, 1, 0> }
  finish {
    ambient 0.1 emission 0 diffuse 0.7
    phong 0 phong_size 40
    reflection 0
  }
}
texture {
  pigment { rgbf <0.8, 0.8, 0.8, 1> }
  finish {
    ambient 0 emission 0 diffuse 0
    phong 0.3 phong_size 40
    reflection 0
  }
}

// ---- lights and objects ----

// In a light_group POV-Ray does not reuse the object that shadowed the last pixel,
// so that the picture does not depend on the order of its pixels.
light_group {
  // lamp: point light, 7 virtual sources (axes, delta 0.25)
  light_source { <3, 5, 4>, rgb 0.114285715 fade_distance 10 fade_power 2 }
  light_source { <3.25, 5, 4>, rgb 0.114285715 fade_distance 10 fade_power 2 }
  light_source { <2.75, 5, 4>, rgb 0.114285715 fade_distance 10 fade_power 2 }
  light_source { <3, 5.25, 4>, rgb 0.114285715 fade_distance 10 fade_power 2 }
  light_source { <3, 4.75, 4>, rgb 0.114285715 fade_distance 10 fade_power 2 }
  light_source { <3, 5, 4.25>, rgb 0.114285715 fade_distance 10 fade_power 2 }
  light_source { <3, 5, 3.75>, rgb 0.114285715 fade_distance 10 fade_power 2 }
  // sun: directional light
  light_source { <0, 1048576, 0>, rgb 1 parallel point_at <0, 0, 0> }
  // spot light
  light_source { <0, 8, 0>, rgb <1, 0.5, 0.25> spotlight radius 20 falloff 29.999999999999996 tightness 0 point_at <0, 7, 0> }

  // ball
  sphere { <0, 0, 0>, 1 texture { Material_clay } }
  // ball
  sphere { <2, 0, 0>, 1 texture { Material_mirror } }
  // ball
  sphere { <4, 0, 0>, 1 texture { Material_lamp_shade } }
  // ball
  sphere { <6, 0, 0>, 1 texture { Material_glass } interior { ior 1.5 } }
  // ball
  sphere { <8, 0, 0>, 1 texture { Material_floor } }
  // ball
  sphere { <10, 0, 0>, 1 texture { Material_cloud } }
  // ball
  sphere { <12, 0, 0>, 1 texture { Material_wood_sphere } }
  // ground
  plane { <0, 1, 0>, -1 texture { Material_floor } }
  // table
  plane { <0, 1, 0>, 1 texture { Material_wood_plane } }
}
