// The fuzzy measure `linear` (Umenhoffer et al. 2009, figure 1): d up to the radius.
// Distances in radii. NumPy twin: aolab/maths/fading.py.

float measureOpenness(float d) { return min(d, 1.0); }
float measureDensity(float d) { return d < 1.0 ? 1.0 : 0.0; }
float measureInverse(float share) { return share; }
