// The fuzzy measure `sqrt` (Umenhoffer et al. 2009, figure 1): √d up to the radius (Méndez et al. 2005).
// Distances in radii. NumPy twin: aolab/maths/fading.py.

float measureOpenness(float d) { return sqrt(min(d, 1.0)); }
float measureDensity(float d) { return d < 1.0 ? 0.5 * inversesqrt(max(d, 1e-30)) : 0.0; }
float measureInverse(float share) { return share * share; }
