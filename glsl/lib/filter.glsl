// Which neighbours belong to the same surface: what every geometry-aware filter asks.

// Distance of `otherPos` to the tangent plane at `centrePos`, as a fraction of the viewing distance. The plane, and not
// the depth itself, so that a floor seen at a grazing angle is not torn apart.
float planeDistance(vec3 centrePos, vec3 centreNormal, vec3 otherPos) {
    return abs(dot(otherPos - centrePos, centreNormal)) / -centrePos.z;
}

// A step off the plane of more than 1 % of the viewing distance is another surface. At 45° and 720 rows a pixel is
// 0.12 % wide, so the step is about 9 pixels: curved surfaces stay whole, a gap does not.
const float PLANE_TOLERANCE = 0.01;
