// Which neighbours belong to the same surface: what every geometry-aware filter asks.

// A step off the tangent plane of more than 0.2 % of the viewing distance is another surface. Of 0.1 to 2 % it had, with
// 0.1 %, the least error against rays on the six scenes (ssao, 480×270 and 960×540); a pixel at 45° and 720 rows is 0.12 %.
const float PLANE_TOLERANCE = 0.002;

// How far the surface at depth `otherZ`, on a ray with `normalDotRay` = dot(centreNormal, ray), lies off the tangent plane
// of the centre, on which dot(centreNormal, position) = `planeOffset`; 1 is the tolerance at the depth `centreZ`.
// The plane, and not the depth itself, so that a floor seen at a grazing angle is not torn apart.
float planeDistance(float normalDotRay, float otherZ, float planeOffset, float centreZ) {
    return abs(-otherZ * normalDotRay - planeOffset) / (-centreZ * PLANE_TOLERANCE);
}
