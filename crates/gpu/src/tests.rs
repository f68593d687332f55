//! Tests of the runner alone, on hand-written WGSL, independent of lowering. They need a Vulkan software adapter.

use super::{Error, Gpu, Rendered};
use glisten_emit::{Emitted, Target};
use glisten_front::hir::{
    GlobalId, Interpolation, MatrixLayout, SamplerDim, SamplerType, Sampling, Scalar, ScalarValue, Shader, Stage, Type,
    TypeId, Types,
};
use glisten_front::link::{
    Attribute, Interface, Output, Program, RootIndex, SamplerSlot, SlotBinding, UniformLeaf, UniformRoot, Varying,
};
use glisten_front::source::Span;
use glisten_front::syntax::ast::{Profile, Version};
use glisten_scene::picture::Transfer;
use glisten_scene::{
    AttributeData, AttributeValues, Compare, Cull, Draw, Filter, Format, Framebuffer, Scene, State, Texels, Texture,
    TextureLevel, Wrap,
};
use std::sync::Arc;

const SLOT: SlotBinding = SlotBinding { group: 0, binding: 0 };

const VERTEX: &str = "
struct Out { @builtin(position) place: vec4<f32>, @location(0) @interpolate(flat, first) color: vec4<f32> }
@vertex fn main(@location(0) place: vec4<f32>, @location(1) color: vec4<f32>) -> Out {
    return Out(place, color);
}";
const FRAGMENT: &str = "
@fragment fn main(@location(0) @interpolate(flat, first) color: vec4<f32>) -> @location(0) vec4<f32> {
    return color;
}";

fn gpu() -> Gpu {
    Gpu::new(Some("software")).expect("these tests need Mesa's Vulkan driver: apt-get install mesa-vulkan-drivers")
}

fn attribute(name: &str, location: u32) -> Attribute {
    Attribute {
        name: name.into(),
        ty: TypeId::VEC4,
        global: GlobalId::new(location as usize),
        location,
        columns: 1,
        active: true,
    }
}

fn interface() -> Interface {
    Interface {
        attributes: vec![attribute("place", 0), attribute("color", 1)],
        varyings: vec![Varying {
            name: "color".into(),
            ty: TypeId::VEC4,
            location: 0,
            component: 0,
            interpolation: Interpolation::Flat,
            sampling: Sampling::Center,
            active: true,
            from: None,
            to: None,
        }],
        outputs: vec![Output { name: "fc".into(), ty: TypeId::VEC4, global: GlobalId::new(0), location: 0, index: 0 }],
        ..Interface::default()
    }
}

fn data(size: u32, values: &[f32]) -> Option<AttributeData> {
    Some(AttributeData { size, divisor: 0, values: AttributeValues::Float(values.to_vec()) })
}

/// A triangle over the lower left half of the window, with red, green and blue corners.
fn scene(types: Types, interface: Interface) -> Scene {
    let version = Version { number: 150, profile: Profile::Core, span: Span::default() };
    let program = Program {
        name: "test".into(),
        types,
        stages: vec![Shader::new(Stage::Vertex, version), Shader::new(Stage::Fragment, version)],
        interface,
    };
    let draw = Draw {
        program: Arc::new(program),
        state: State::INITIAL,
        vertex_count: 3,
        indices: None,
        instances: 1,
        attributes: vec![
            data(2, &[-1.0, -1.0, 1.0, -1.0, -1.0, 1.0]),
            data(3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]),
        ],
        uniforms: vec![],
        textures: vec![],
        dynamic: vec![],
        fixed: None,
    };
    let framebuffer = Framebuffer {
        width: 8,
        height: 8,
        clear: [0.0, 0.0, 0.0, 0.5],
        format: Format::Rgba32Float,
        attachments: 1,
        encode: Transfer::Linear.into(),
    };
    Scene { name: "test".into(), framebuffer, draws: vec![draw] }
}

fn draw(scene: &Scene, vertex: &str, fragment: &str) -> Result<Rendered, Error> {
    let gpu = gpu();
    let prepared = gpu.prepare_with(scene, Target::Spirv, &|_, stage| {
        Ok(Emitted::Text(if stage == Stage::Vertex { vertex.into() } else { fragment.into() }))
    })?;
    gpu.draw(&prepared)
}

fn flat(scene: &Scene) -> Rendered {
    draw(scene, VERTEX, FRAGMENT).expect("the scene draws")
}

#[test]
fn lower_left_is_at_the_bottom_and_coverage_is_marked() {
    let picture = flat(&scene(Types::new(), interface())).picture;
    let bottom_left = 7 * 8;
    let top_right = 7;
    assert!(picture.covered[bottom_left] && !picture.covered[top_right]);
    assert_eq!(picture.attachments[0][top_right], [0.0, 0.0, 0.0, 0.5]);
    // The last vertex provokes; the missing fourth component of its color is 1.
    assert_eq!(picture.attachments[0][bottom_left], [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn first_vertex_provokes_if_asked() {
    let mut scene = scene(Types::new(), interface());
    scene.draws[0].state.provoking_last = false;
    assert_eq!(flat(&scene).picture.attachments[0][56], [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn counterclockwise_is_front() {
    let mut scene = scene(Types::new(), interface());
    scene.draws[0].state.cull = Cull::Front;
    assert!(!flat(&scene).picture.covered.contains(&true));
    scene.draws[0].state.cull = Cull::Back;
    assert!(flat(&scene).picture.covered[56]);
    scene.draws[0].state.front_ccw = false;
    assert!(!flat(&scene).picture.covered.contains(&true));
}

#[test]
fn depth_test_keeps_the_nearer() {
    let mut scene = scene(Types::new(), interface());
    let mut far = scene.draws[0].clone();
    far.attributes[0] = data(3, &[-1.0, -1.0, 0.8, 1.0, -1.0, 0.8, -1.0, 1.0, 0.8]);
    far.attributes[1] = data(1, &[0.25, 0.25, 0.25]);
    scene.draws.push(far);
    for draw in &mut scene.draws {
        draw.state.depth_test = true;
    }
    assert_eq!(flat(&scene).picture.attachments[0][56], [0.0, 0.0, 1.0, 1.0]);
    scene.draws[1].state.depth_func = Compare::Greater;
    assert_eq!(flat(&scene).picture.attachments[0][56], [0.25, 0.0, 0.0, 1.0]);
}

#[test]
fn uniforms_and_textures_reach_the_shader() {
    let mut types = Types::new();
    let kind = SamplerType { texel: Scalar::Float, dim: SamplerDim::D1, arrayed: false, shadow: false };
    let sampler = types.intern(Type::Sampler(kind));
    let shadow = SamplerType { dim: SamplerDim::D2, shadow: true, ..kind };
    let shadow_sampler = types.intern(Type::Sampler(shadow));
    let slot = |ty, binding| SamplerSlot {
        name: "s".into(),
        ty,
        array_size: None,
        globals: vec![],
        flat_offset: 0,
        texture: SlotBinding { group: 1, binding },
        sampler: SlotBinding { group: 1, binding: binding + 1 },
        texel_count: None,
        unit: None,
        active: true,
    };
    let interface = Interface {
        loose: Some((SLOT, 32)),
        roots: vec![UniformRoot {
            name: "u".into(),
            ty: TypeId::FLOAT,
            globals: vec![],
            block: None,
            offset: 16,
            default: None,
            active: true,
        }],
        uniforms: vec![UniformLeaf {
            name: "u".into(),
            ty: TypeId::FLOAT,
            array_size: None,
            root: RootIndex(0),
            block_element: 0,
            flat_offset: 0,
            slot: SLOT,
            offset: 16,
            array_stride: None,
            matrix_stride: None,
            matrix_layout: MatrixLayout::ColumnMajor,
            active: true,
        }],
        framebuffer_height: Some(20),
        samplers: vec![slot(sampler, 0), slot(shadow_sampler, 2)],
        ..interface()
    };
    let mut scene = scene(types, interface);
    scene.draws[0].uniforms = vec![vec![ScalarValue::Float(0.125)]];
    let texture = |kind, width, height, texels: Vec<f32>| {
        let texels = Texels::Float(texels.into_iter().map(|r| [r, 0.0, 0.0, 1.0]).collect());
        Some(Arc::new(Texture {
            kind,
            levels: vec![TextureLevel { width, height, depth: 1, texels }],
            filter: Filter::Nearest,
            wrap: Wrap::Repeat,
            compare: Compare::Lequal,
            sampling: glisten_scene::Sampling::default(),
        }))
    };
    scene.draws[0].textures =
        vec![texture(kind, 2, 1, vec![0.25, 0.75]), texture(shadow, 2, 2, vec![0.1, 0.2, 0.3, 0.9])];
    let fragment = "
struct Loose { @size(16) pad: vec4<f32>, u: f32, height: f32 }
@group(0) @binding(0) var<uniform> loose: Loose;
@group(1) @binding(0) var t: texture_2d<f32>;
@group(1) @binding(1) var s: sampler;
@group(1) @binding(2) var dt: texture_depth_2d;
@group(1) @binding(3) var ds: sampler_comparison;
@fragment fn main() -> @location(0) vec4<f32> {
    let right = textureSampleLevel(t, s, vec2<f32>(0.75, 0.5), 0.0).r;
    let passed = textureSampleCompareLevel(dt, ds, vec2<f32>(0.75, 0.75), 0.5);
    let failed = textureSampleCompareLevel(dt, ds, vec2<f32>(0.25, 0.25), 0.5);
    return vec4<f32>(loose.u, loose.height, right, passed - 2.0 * failed);
}";
    let picture = draw(&scene, VERTEX, fragment).expect("the scene draws").picture;
    assert_eq!(picture.attachments[0][56], [0.125, 8.0, 0.75, 1.0]);
}

#[test]
fn wgpus_complaints_are_errors() {
    let scene = scene(Types::new(), interface());
    let broken = draw(&scene, VERTEX, "@fragment fn main() -> @location(0) vec4<f32> { return 1; }");
    assert!(matches!(broken, Err(Error::Refused(_))), "{broken:?}");
}

#[test]
fn holes_between_bindings_are_refused() {
    let slot = SlotBinding { group: 0, binding: 1 };
    let scene = scene(Types::new(), Interface { loose: Some((slot, 16)), ..interface() });
    let error = draw(&scene, VERTEX, FRAGMENT).expect_err("a hole binds the wrong resource");
    assert!(error.to_string().contains("not dense"), "{error}");
}

#[test]
fn a_measured_stretch_is_positive_and_fragments_are_counted() {
    let gpu = gpu();
    let scene = scene(Types::new(), interface());
    let prepared = gpu
        .prepare_with(&scene, Target::Spirv, &|_, stage| {
            Ok(Emitted::Text(if stage == Stage::Vertex { VERTEX.into() } else { FRAGMENT.into() }))
        })
        .expect("the scene is good");
    assert!(gpu.measure(&prepared, 3).expect("it draws") > 0.0);
    if let Some(fragments) = gpu.fragments_shaded(&prepared).expect("it draws") {
        assert!((28..=64).contains(&fragments), "{fragments}");
    }
}
