// The camera's G-buffer, as every kind of occluders may read it. A kind is a file with the struct and the three functions
// of depth.glsl (aolab/modules/occluders/base.py).

#include "lib/space.glsl"
#include "lib/receiver.glsl"

uniform sampler2D viewZ;       // R32F; off the screen -infinity: nothing is known there, and nothing blocks
uniform sampler2D viewNormal;
uniform sampler2D sender;      // RGB radiance that leaves each surface
uniform vec2 texel_size;       // 1 / resolution
uniform vec4 pixel_from_ray;
uniform mat4 view_from_world;
uniform mat4 world_from_view;
uniform vec3 world_origin;     // to add to world positions: not 0 where a scene is far from the origin
