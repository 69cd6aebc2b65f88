// No occlusion: every direction is open. The baseline for all other methods.
// Inputs:  none.
// Output:  visibility = 1.

out float visibility;

void main() {
    visibility = 1.0;
}
