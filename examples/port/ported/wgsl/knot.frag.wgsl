diagnostic(off, derivative_uniformity);

struct Uniforms {
    view: mat4x4<f32>,
    projection: mat4x4<f32>,
    lamp: vec3<f32>,
    ambient: vec3<f32>,
    shininess: f32,
}

@group(0) @binding(0) var<uniform> uniforms: Uniforms;
@group(1) @binding(0) var pattern: texture_2d<f32>;
@group(1) @binding(1) var pattern_sampler: sampler;

@fragment
fn main(
    @location(0) eye_position: vec3<f32>,
    @location(1) eye_normal: vec3<f32>,
    @location(2) place: vec2<f32>,
) -> @location(0) vec4<f32> {
    let n = normalize(eye_normal);
    let l = normalize(uniforms.lamp - eye_position);
    let h = normalize(l - normalize(eye_position));
    let color = textureSample(pattern, pattern_sampler, place).xyz;
    let diffuse = max(dot(n, l), 0.0);
    let highlight = select(0.0, pow(max(dot(n, h), 0.0), uniforms.shininess), diffuse > 0.0);
    return vec4(color * (uniforms.ambient + diffuse) + 0.6 * highlight, 1.0);
}
