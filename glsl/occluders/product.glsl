// Occluders: two kinds together. A point is blocked if one of them blocks it, so that the visibility of a direction is the
// product of theirs. The two kinds are included before this file, renamed (aolab/modules/occluders/product.py).

struct Occluder {
    vec3 viewPos;
    bool isFirst;
    firstOccluder first;
    secondOccluder second;
};

// Is the view-space point `samplePos` blocked for the receiver, and by what?
bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    occluder.isFirst = firstIsBlocked(receiver, samplePos, thickness, occluder.first);
    bool second = secondIsBlocked(receiver, samplePos, thickness, occluder.second);
    occluder.viewPos = occluder.isFirst ? occluder.first.viewPos : occluder.second.viewPos;
    return occluder.isFirst || second;
}

// The occluder's unit normal, view space.
vec3 occluderNormal(Occluder occluder) {
    return occluder.isFirst ? firstOccluderNormal(occluder.first) : secondOccluderNormal(occluder.second);
}

// The light that leaves the occluder.
vec3 occluderRadiance(Occluder occluder) {
    return occluder.isFirst ? firstOccluderRadiance(occluder.first) : secondOccluderRadiance(occluder.second);
}
