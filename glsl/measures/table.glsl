// A fuzzy measure by tables: values at equal steps, linear between them (aolab/modules/measures/base.py).
// Distances in radii.

const int measure_steps;

uniform float measure_openness[measure_steps + 1];  // at distances from 0 to 1
uniform float measure_inverse[measure_steps + 1];   // at shares from 0 to 1

float measureOpenness(float d) {
    float at = min(d, 1.0) * float(measure_steps);
    int i = min(int(at), measure_steps - 1);
    return mix(measure_openness[i], measure_openness[i + 1], at - float(i));
}

float measureDensity(float d) {
    int i = min(int(d * float(measure_steps)), measure_steps - 1);
    return d < 1.0 ? (measure_openness[i + 1] - measure_openness[i]) * float(measure_steps) : 0.0;
}

float measureInverse(float share) {
    float at = share * float(measure_steps);
    int i = min(int(at), measure_steps - 1);
    return mix(measure_inverse[i], measure_inverse[i + 1], at - float(i));
}
