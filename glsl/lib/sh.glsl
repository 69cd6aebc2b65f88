// Real spherical harmonics, bands 0 to 2 (the NumPy twin is aolab/spherical_harmonics.py).
//
// Convention: the basis listed by Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks", appendix A2: orthonormal, with the
// Condon-Shortley sign (y_1^-1 = -sqrt(3/4pi) y). Coefficient i = l (l + 1) + m holds band l, order m. Directions are unit
// vectors in whatever space the coefficients were projected in; those of an environment are in world space.

const float SH_BAND0 = 0.28209479177387814;    // sqrt(1 / 4pi)
const float SH_BAND1 = 0.48860251190291992;    // sqrt(3 / 4pi)
const float SH_BAND2 = 1.09254843059207907;    // sqrt(15 / 4pi)
const float SH_BAND2_M0 = 0.31539156525252001; // sqrt(5 / 16pi)

void shBasis9(vec3 direction, out float y[9]) {
    vec3 d = direction;
    y[0] = SH_BAND0;
    y[1] = -SH_BAND1 * d.y;
    y[2] = SH_BAND1 * d.z;
    y[3] = -SH_BAND1 * d.x;
    y[4] = SH_BAND2 * d.x * d.y;
    y[5] = -SH_BAND2 * d.y * d.z;
    y[6] = SH_BAND2_M0 * (3.0 * d.z * d.z - 1.0);
    y[7] = -SH_BAND2 * d.x * d.z;
    y[8] = 0.5 * SH_BAND2 * (d.x * d.x - d.y * d.y);
}

// Irradiance on a surface with unit normal `worldNormal`, from coefficients that are already convolved with the clamped
// cosine (Ramamoorthi & Hanrahan 2001; Environment.irradiance_sh). Three bands ring below 0 opposite a strong sun: clamped.
vec3 shIrradiance(vec3 coefficients[9], vec3 worldNormal) {
    float y[9];
    shBasis9(worldNormal, y);
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < 9; ++i) {
        irradiance += coefficients[i] * y[i];
    }
    return max(irradiance, 0.0);
}
