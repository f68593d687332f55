struct Light { vec3 direction; vec3 color; };
uniform Light lights[LIGHTS];

vec3 lit_by_all(vec3 normal)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHTS; ++i)
        sum += max(dot(normal, lights[i].direction), 0.0) * lights[i].color;
    return sum;
}
