// The fuzzy measure `classical` (Umenhoffer et al. 2009, figure 1): 0 within the radius, 1 from the radius on: all samples lie at the radius.
// Distances in radii. NumPy twin: aolab/maths/fading.py.

float measureOpenness(float d) { return d < 1.0 ? 0.0 : 1.0; }
float measureDensity(float d) { return 0.0; }  // but for the radius itself
float measureInverse(float share) { return 1.0; }
