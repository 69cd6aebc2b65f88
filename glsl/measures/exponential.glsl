// The fuzzy measure `exponential` (Umenhoffer et al. 2009, figure 1): 1 - exp(-σ d), also beyond the radius.
// Distances in radii. NumPy twin: aolab/maths/fading.py.

uniform float sigma;  // 1 / radii

float measureOpenness(float d) { return 1.0 - exp(-sigma * d); }
float measureDensity(float d) { return sigma * exp(-sigma * d); }
float measureInverse(float share) { return -log(max(1.0 - share, 1.0 / 256.0)) / sigma; }  // ends at 5.5 / σ
