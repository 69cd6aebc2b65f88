// No occlusion: every direction is open.
// Output: visibility = 1.

out float visibility;

void main() {
    visibility = 1.0;
}
