// Distance to the plane of the triangle: the geometry-aware filters use it to reject neighbours on another surface. The
// plane across a shading normal would reject neighbours on the same triangle.

#include "lib/space.glsl"

// The tolerance is 0.2 % of the viewing distance. Of the values from 0.1 to 2 %, 0.1 % and 0.2 % had the least error
// against rays on the six scenes (ssao, 480×270 and 960×540). At 720 rows and a 45° field of view, a pixel is 0.12 %
// wide. In an orthographic picture, the distance is that from which a camera of 45° shows as much.
const float PLANE_TOLERANCE = 0.002;

const float COT_22_5 = 2.414214;  // distance / half the height, at 45°

// dot(normal, position) of the point at depth `viewZ` on a ray with `dotRay` = dot(normal.xy, ray.xy): for two normals.
vec2 alongNormals(vec2 dotRay, vec2 normalZ, float viewZ) {
    return orthographic ? dotRay + normalZ * viewZ : (normalZ - dotRay) * viewZ;
}

// The smaller distance to two planes.
float nearerPlane(vec2 distances) {
    return min(abs(distances.x), abs(distances.y));
}

// The tolerance at depth `viewZ`, in scene units; `halfHeight`: that of an orthographic picture.
float planeTolerance(float viewZ, float halfHeight) {
    return PLANE_TOLERANCE * (orthographic ? COT_22_5 * halfHeight : -viewZ);
}
