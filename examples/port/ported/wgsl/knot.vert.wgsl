struct Uniforms {
    view: mat4x4<f32>,
    projection: mat4x4<f32>,
    lamp: vec3<f32>,
    ambient: vec3<f32>,
    shininess: f32,
}

struct VertexOutput {
    @builtin(position) position: vec4<f32>,
    @location(0) eye_position: vec3<f32>,
    @location(1) eye_normal: vec3<f32>,
    @location(2) place: vec2<f32>,
}

@group(0) @binding(0) var<uniform> uniforms: Uniforms;

@vertex
fn main(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
) -> VertexOutput {
    let eye = uniforms.view * vec4(position, 1.0);
    let eye_position = eye.xyz;
    let eye_normal = mat3x3<f32>(uniforms.view[0].xyz, uniforms.view[1].xyz, uniforms.view[2].xyz) * normal;
    let place = uv;
    let gl_Position = uniforms.projection * eye;
    return VertexOutput(
        vec4(gl_Position.xy, (gl_Position.z + gl_Position.w) * 0.5, gl_Position.w),
        eye_position,
        eye_normal,
        place,
    );
}
