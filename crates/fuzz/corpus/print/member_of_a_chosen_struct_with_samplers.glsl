//# vertex
#version 400 core
in vec2 position;
in int layer;
out vec2 at;
flat out int choice;

void main() {
    at = position;
    choice = layer;
    gl_Position = vec4(position, 0.0, 1.0);
}

//# fragment
#version 400 core
// Chosen samplers in chains, and as arguments.
in vec2 at;
flat in int choice;

struct Material {
    vec4 tint;
    sampler2D maps[2];
};

struct Row {
    sampler2D cells[2];
};

uniform Material materials[2];
uniform Row grid[2];
uniform sampler2D images[3];

out vec4 color;

// The whole array, of which an element is chosen.
vec4 element(sampler2D list[3], int index, vec2 p) {
    return texture(list[index], p) + textureGrad(list[index], p, vec2(0.1, 0.0), vec2(0.0, 0.1));
}

// A chosen sampler, passed on.
vec4 twice(sampler2D image, vec2 p) {
    return texture(image, p) * 2.0;
}

vec4 smoothed(sampler2D image, vec2 p, int steps) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < steps; i++) {
        sum += twice(image, p + float(i) * 0.01) + texelFetch(image, ivec2(i, 0), 0);
    }
    return sum / float(steps);
}

vec4 shaded(Material material, int map, vec2 p) {
    return material.tint * texture(material.maps[map], p);
}

// An array of a struct, chosen by its caller; two samplers, and a result by parameter.
void mixed(sampler2D row[2], sampler2D other, out vec4 sum) {
    sum = texture(row[1], at) + texture(row[choice], at) + twice(other, at);
}

void main() {
    color = element(images, choice, at);
    color += smoothed(images[choice], at, 3) + smoothed(images[1], at, 2);
    color += shaded(materials[choice], choice, at);
    color += texture(materials[choice].maps[choice - 1], at) * materials[choice].tint;
    color += texture(grid[choice].cells[choice - 1], at) + textureProj(grid[1].cells[choice], vec3(at, 1.0));
    vec4 sum;
    mixed(grid[choice].cells, images[choice + 1], sum);
    color += sum;
}

