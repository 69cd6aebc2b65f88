// Which neighbours belong to the same surface: what every geometry-aware filter asks.

// A step off the tangent plane of more than 1 % of the viewing distance is another surface. At 45° and 720 rows a pixel
// is 0.12 % wide, so the step is about 9 pixels: curved surfaces stay whole, a gap does not.
const float PLANE_TOLERANCE = 0.01;

// How far the surface at depth `otherZ`, on a ray with `normalDotRay` = dot(centreNormal, ray), lies off the tangent plane
// of the centre, on which dot(centreNormal, position) = `planeOffset`; 1 is the tolerance at the depth `centreZ`.
// The plane, and not the depth itself, so that a floor seen at a grazing angle is not torn apart.
float planeDistance(float normalDotRay, float otherZ, float planeOffset, float centreZ) {
    return abs(-otherZ * normalDotRay - planeOffset) / (-centreZ * PLANE_TOLERANCE);
}
