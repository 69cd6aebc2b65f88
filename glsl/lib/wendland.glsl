// Wendland's kernel: 1 at t = 0, smooth, and 0 from t = h on (HAO, Reinbothe, Boubekeur and Alexa 2009, Eq. 3).

float wendland(float t, float h) {
    float share = min(t / h, 1.0), rest = 1.0 - share;
    return rest * rest * rest * rest * (4.0 * share + 1.0);
}
