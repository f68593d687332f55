//! Types of other languages, and those that GLSL has in their place.
//!
//! *In:* a name. *Out:* the type of GLSL.

/// Types of HLSL and C.
#[rustfmt::skip]
static TYPES: &[(&str, &str)] = &[
    ("float2", "vec2"), ("float3", "vec3"), ("float4", "vec4"), ("int2", "ivec2"), ("int3", "ivec3"), ("int4", "ivec4"),
    ("uint2", "uvec2"), ("uint3", "uvec3"), ("uint4", "uvec4"), ("bool2", "bvec2"), ("bool3", "bvec3"),
    ("bool4", "bvec4"), ("float2x2", "mat2"), ("float3x3", "mat3"), ("float4x4", "mat4"), ("half3", "vec3"),
    ("half4", "vec4"), ("char", "int"), ("size_t", "uint"), ("Texture2D", "sampler2D"),
];

/// The type of GLSL for a type of HLSL or C.
pub(crate) fn type_name(name: &str) -> Option<&'static str> {
    TYPES.iter().find(|row| row.0 == name).map(|row| row.1)
}
