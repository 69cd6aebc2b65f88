// Spherical harmonics: a sky as 16 numbers, turned by a rotation, and the irradiance that it gives to a surface.
// Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks"; Ramamoorthi and Hanrahan 2001; Herholz et al. 2012, Eq. 3.
//
// Inputs:  viewZ, viewNormal.
// Outputs: basis: y_0 to y_3 at the world normal;  cosine: coefficients 0 to 3 of the clamped cosine around it;
//          sky: coefficients 0 to 3 of the sky;    turned: those of the sky turned by 60° about +y;
//          light: x the irradiance from the turned sky, y that from a sky of 1, which is π.

#include "lib/space.glsl"
#include "lib/sh_quadrature.glsl"

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform mat4 world_from_view;

out vec4 basis;
out vec4 cosine;
out vec4 sky;
out vec4 turned;
out vec4 light;

// The radiance of the sky: a soft sun over a grey background.
float skyAt(vec3 direction) {
    float towardsSun = max(dot(direction, normalize(vec3(1.0, 0.6, 0.2))), 0.0);
    return 0.3 + 2.0 * towardsSun * towardsSun;
}

// The radiance of a sky that is 1 everywhere.
float oneAt(vec3 direction) {
    return 1.0;
}

// The coefficients c_i = ∫ L y_i dω of the sky, or of the sky of 1, by the quadrature's nodes.
mat4 projected(bool constant) {
    mat4 sum = mat4(0.0);
    for (int i = 0; i < SH_RINGS * SH_AZIMUTHS; ++i) {
        vec4 node = shNode(i);
        float radiance = constant ? oneAt(node.xyz) : skyAt(node.xyz);
        sum += node.w * radiance * shBasis(node.xyz);
    }
    return sum;
}

// The irradiance E(n) = ∫ L max(n·ω, 0) dω: the product integral of the sky and the clamped cosine around n.
float irradianceAt(mat4 skyCoefficients, vec3 worldNormal) {
    return shDot(skyCoefficients, shClampedCosine(worldNormal));
}

// The rotation by an angle about +y.
mat3 turnedAboutY(float angleRad) {
    float c = cos(angleRad), s = sin(angleRad);
    return mat3(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    basis = cosine = sky = turned = light = vec4(0.0);
    if (isBackground(texelFetch(viewZ, pixel, 0).r)) return;

    vec3 worldNormal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
    mat4 skyCoefficients = projected(false);
    mat4 turnedCoefficients = shRotate(skyCoefficients, turnedAboutY(radians(60.0)));
    basis = shBasis(worldNormal)[0];
    cosine = shClampedCosine(worldNormal)[0];
    sky = skyCoefficients[0];
    turned = turnedCoefficients[0];
    light = vec4(irradianceAt(turnedCoefficients, worldNormal), irradianceAt(projected(true), worldNormal), 0.0, 1.0);
}
