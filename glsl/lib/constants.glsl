// The one constant that every shader needs.

const float PI = 3.14159265358979324;
