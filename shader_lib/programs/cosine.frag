#version 150
// Figure 127: the cosine model, cos^n, as a thin line over the normal distribution with the same curvature at its top,
// exp(-n angle^2 / 2), as a broad one.

in vec2 place;
uniform float below = -0.06;
uniform float above = 1.1;
uniform vec4 exponents = vec4(4.0, 32.0, 512.0, 512.0);
uniform vec3 paper = vec3(1.0);
uniform vec3 cosine_color = vec3(0.0);
uniform vec3 normal_color = vec3(0.5);
out vec4 color;

// How much ink a line of a breadth in parts of the picture leaves at a distance in its units.
//   height  of the curve here    slope  of the curve
float ink(float height, float slope, float breadth)
{
    // From radians and heights to parts of the picture.
    float up = 1.0 / (above - below);
    float steep = slope * up * radians(180.0);
    float distance = abs(place.y - height) * up / sqrt(1.0 + steep * steep);
    // No curve leaves the heights from 0 to 1.
    distance = max(distance, max(place.y - 1.0, -place.y) * up);
    return 1.0 - smoothstep(0.4 * breadth, 0.6 * breadth, distance);
}

void main()
{
    // The logarithm of the cosine, which the powers share; the picture ends where the cosine is 0.
    float l = log(cos(place.x)); // glisten: allow(log-of-zero)
    vec3 seen = paper;
    for (int i = 0; i < 4; ++i) {
        float n = exponents[i];
        float bell = exp(-0.5 * n * place.x * place.x);
        seen = mix(seen, normal_color, ink(bell, -n * place.x * bell, 0.022));
    }
    for (int i = 0; i < 4; ++i) {
        float n = exponents[i];
        float slope = -n * sin(place.x) * exp((n - 1.0) * l);
        seen = mix(seen, cosine_color, ink(exp(n * l), slope, 0.008));
    }
    color = vec4(seen, 1.0);
}
