// Distance to the tangent plane: the geometry-aware filters use it to reject neighbours on another surface.

// The tolerance is 0.2 % of the viewing distance. Of the values from 0.1 to 2 %, 0.1 % and 0.2 % had the least error
// against rays on the six scenes (ssao, 480×270 and 960×540). At 720 rows and a 45° field of view, a pixel is 0.12 %
// wide.
const float PLANE_TOLERANCE = 0.002;

// The distance of a neighbour from the centre's tangent plane, in units of the tolerance at depth `centreZ`. The plane
// is dot(centreNormal, position) = `planeOffset`. The neighbour is at depth `otherZ`, on a ray with `normalDotRay` =
// dot(centreNormal, ray). On a floor at a grazing angle, this distance stays small where a difference of depths does
// not.
float planeDistance(float normalDotRay, float otherZ, float planeOffset, float centreZ) {
    return abs(-otherZ * normalDotRay - planeOffset) / (-centreZ * PLANE_TOLERANCE);
}
