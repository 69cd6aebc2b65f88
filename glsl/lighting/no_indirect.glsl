// No bounce: the indirect light of methods without one.

vec3 indirectAt(Surface surface) {
    return vec3(0.0);
}
